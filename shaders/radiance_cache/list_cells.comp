// Lists the cells that hold light: those that have an empty voxel, and by OCCUPANCY 0: a solid one, with
// DILATE in a neighbour, too; or 2: all of them. In any case those that what the camera sees is lit by;
// with OCCUPANCY 1 only these, and with DILATE their neighbours.
#include "base/invocation.glsl"
#include "radiance_cache/cells.glsl"
#include "radiance_cache/volume.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer List { uint active_cells[]; };
layout(std430, binding = 1) buffer Counter { uint active_count; };
layout(std430, binding = 2) buffer Marks { uint marks[]; };  // the seeds
layout(binding = 0) uniform usamplerBuffer seeds;  // of all cells

bool occupied_by(uint seed) {
#if OCCUPANCY == 2
  return true;
#elif OCCUPANCY == 1
  return (seed & CELL_SEEN) != 0u;
#else
  return (seed & CELL_OCCUPIED) != 0u;
#endif
}

void main() {
  uint number = invocation();
  if (number >= uint(cache.count.y)) return;
  uint seed = texelFetch(seeds, int(number)).x;
  bool occupied = occupied_by(seed) || (seed & CELL_SEEN) != 0u;
#if DILATE
  Cell cell = cell_of(cache, number);
  CacheVolume volume = cache.volumes[cell.volume];
  for (int i = 0; i < 27; ++i) {
    ivec3 at = cell.at + ivec3(i % 3, i / 3 % 3, i / 9) - 1;
    at = clamp(at, ivec3(0), volume.cells.xyz - 1);
    occupied = occupied || occupied_by(texelFetch(seeds, cell_number(volume, at)).x);
  }
#endif
  if (!occupied || (seed & SEED_CODE) == 0u) return;
  active_cells[atomicAdd(active_count, 1u)] = number;
  marks[number] = seed | CELL_LISTED;
}
