// Lists the cells that hold light: those with a solid voxel in them, or with DILATE in a neighbour.
#include "base/invocation.glsl"
#include "radiance_cache/cells.glsl"
#include "radiance_cache/volume.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer List { uint active_cells[]; };
layout(std430, binding = 1) buffer Counter { uint active_count; };

bool occupied(Cell cell) {
  CacheVolume volume = cache.volumes[cell.volume];
  int side = volume.cells.w;
  ivec3 low = cell.at * side, high = low + side;
#if DILATE
  low = max(low - side, ivec3(0));
  high = min(high + side, volume.cells.xyz * side);
#endif
  bool found = false;
  for (int z = low.z; z < high.z && !found; ++z)
    for (int y = low.y; y < high.y && !found; ++y)
      for (int x = low.x; x < high.x && !found; ++x) found = voxel_is_solid(volume, ivec3(x, y, z));
  return found;
}

void main() {
  uint number = invocation();
  if (number >= uint(cache.count.y)) return;
  if (occupied(cell_of(cache, number))) active_cells[atomicAdd(active_count, 1u)] = number;
}
