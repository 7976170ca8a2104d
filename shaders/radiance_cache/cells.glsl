// Cells of all volumes by number, and where each of them looks from.
//
// A cell has a seed: that empty voxel of it which is closest to its middle. A wall may run through a
// cell, and light on its two sides has nothing to do with each other: the cell belongs to the side on
// which its seed lies, its rays begin where the seed sees them, and look-ups leave it out for surfaces
// that have it behind them, or where its seed does not see what is before the surface (reach.glsl).
#include "radiance_cache/volume_shared.h"

struct Cell {
  int volume;
  ivec3 at;
};

// `cells` of volume first.z on are those of that volume, x running fastest.
Cell cell_of(CacheVolumes volumes, uint number) {
  Cell cell;
  cell.volume = 0;
  for (int v = 1; v < volumes.count.x; ++v)
    if (int(number) >= volumes.volumes[v].first.z) cell.volume = v;
  CacheVolume volume = volumes.volumes[cell.volume];
  int i = int(number) - volume.first.z;
  cell.at = ivec3(i % volume.cells.x, i / volume.cells.x % volume.cells.y,
                  i / (volume.cells.x * volume.cells.y));
  return cell;
}

int cell_number(CacheVolume volume, ivec3 at) {
  return volume.first.z + (at.z * volume.cells.y + at.y) * volume.cells.x + at.x;
}

// A seed as a whole number above 0, at most 512; 0 means that the cell has none. Where cells are
// listed, the rest of the word tells whether a solid voxel lies in the cell, whether the camera sees
// something that is lit by it, and whether it came on the list.
const uint SEED_CODE = 1023u, CELL_OCCUPIED = 1024u, CELL_SEEN = 2048u, CELL_LISTED = 4096u, CELL_CHANGED = 8192u;
uint seed_code(ivec3 voxel) { return 1u + uint(voxel.x + 8 * (voxel.y + 8 * voxel.z)); }

// The voxel within its cell.
ivec3 seed_voxel(uint code) { return ivec3((uvec3((code & SEED_CODE) - 1u) >> uvec3(0, 3, 6)) & 7u); }

// The middle of the seed's voxel, relative to the cell's lowest corner, in sides of the cell.
vec3 seed_place(uint code, int voxels) { return (vec3(seed_voxel(code)) + 0.5) / float(voxels); }
