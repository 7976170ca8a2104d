// Lists the cells that hold light. They have an empty voxel, and by OCCUPANCY (radiance_cache/names.h)
// GEOMETRY: a solid one, too; DEPTH: what the camera sees is lit by them; ALL: nothing more. With DILATE also
// their neighbours. In any case those that what the camera sees is lit by; with TIERS these alone, and on
// another list the rest of those by GEOMETRY and by DEPTH.
#include "base/invocation.glsl"
#include "radiance_cache/cells.glsl"
#include "radiance_cache/volume.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer List { uint active_cells[]; };
layout(std430, binding = 1) buffer Counters { uint active_count, other_count; };
layout(std430, binding = 2) buffer Marks { uint marks[]; };  // the seeds
layout(binding = 0) uniform usamplerBuffer seeds;  // of all cells

#if OCCUPANCY == TIERS
layout(std430, binding = 3) writeonly buffer Others { uint other_cells[]; };
#endif

// Marks by which cells, and their neighbours, come on the first list.
#if OCCUPANCY == GEOMETRY
const uint LISTED_BY = CELL_OCCUPIED;
#elif OCCUPANCY == DEPTH
const uint LISTED_BY = CELL_SEEN;
#else
const uint LISTED_BY = 0u;
#endif

void main() {
  uint number = invocation();
  if (number >= uint(cache.count.y)) return;
  uint seed = texelFetch(seeds, int(number)).x;
  uint marks_about = seed;
#if DILATE
  Cell cell = cell_of(cache, number);
  CacheVolume volume = cache.volumes[cell.volume];
  for (int i = 0; i < 27; ++i) {
    ivec3 at = cell.at + ivec3(i % 3, i / 3 % 3, i / 9) - 1;
    at = clamp(at, ivec3(0), volume.cells.xyz - 1);
    marks_about |= texelFetch(seeds, cell_number(volume, at)).x;
  }
#endif
  if ((seed & SEED_CODE) == 0u) return;
  if (OCCUPANCY == ALL || ((marks_about & LISTED_BY) | (seed & CELL_SEEN)) != 0u) {
    active_cells[atomicAdd(active_count, 1u)] = number;
    marks[number] = seed | CELL_LISTED;
  }
#if OCCUPANCY == TIERS
  else if ((marks_about & (CELL_OCCUPIED | CELL_SEEN)) != 0u) {
    other_cells[atomicAdd(other_count, 1u)] = number;
  }
#endif
}
