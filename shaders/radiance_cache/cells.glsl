// Cells of all volumes by number, and the list of those that hold light.
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
