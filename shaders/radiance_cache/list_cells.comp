// Lists the cells that hold light: those with a solid voxel in them, or with DILATE in a neighbour, and
// an empty one.
#include "base/invocation.glsl"
#include "radiance_cache/cells.glsl"
#include "radiance_cache/volume.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer List { uint active_cells[]; };
layout(std430, binding = 1) buffer Counter { uint active_count; };
layout(binding = 0) uniform usamplerBuffer seeds;  // of all cells

void main() {
  uint number = invocation();
  if (number >= uint(cache.count.y)) return;
  uint seed = texelFetch(seeds, int(number)).x;
  bool occupied = (seed & CELL_OCCUPIED) != 0u;
#if DILATE
  Cell cell = cell_of(cache, number);
  CacheVolume volume = cache.volumes[cell.volume];
  for (int i = 0; i < 27; ++i) {
    ivec3 at = cell.at + ivec3(i % 3, i / 3 % 3, i / 9) - 1;
    at = clamp(at, ivec3(0), volume.cells.xyz - 1);
    occupied = occupied || (texelFetch(seeds, cell_number(volume, at)).x & CELL_OCCUPIED) != 0u;
  }
#endif
  if (occupied && (seed & SEED_CODE) > 0u) active_cells[atomicAdd(active_count, 1u)] = number;
}
