// Sends rays from the cells that hold light, and notes what they meet. One invocation a ray.
#include "base/invocation.glsl"
#include "radiance_cache/cells.glsl"
#include "radiance_cache/march.glsl"
#include "radiance_cache/cell_places.glsl"
#include "radiance_cache/rays.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer List { uint active_cells[]; };
layout(std430, binding = 1) writeonly buffer Met { uint met[]; };
#if MARK_MET
layout(std430, binding = 2) buffer MetSides { uint met_sides[]; };  // of surfels: front, back; 1: met
#endif
layout(location = 0) uniform uvec3 counts;     // cells of the list, directions, seed
layout(location = 1) uniform ivec4 lattice[MOST_CASCADES];  // xyz: of each volume's first cell

layout(binding = 0) uniform usamplerBuffer seeds;

void main() {
  uint ray = spread_invocation(64u);
  if (ray >= counts.x * counts.y) return;
  uint slot = ray / counts.y, k = ray % counts.y;
  Cell cell = cell_of(cache, active_cells[slot]);
  CacheVolume volume = cache.volumes[cell.volume];
  ivec3 place = cell.at + lattice[cell.volume].xyz;
  float turn = cell_turn(place, counts.z);
  vec3 direction = cache_direction(k, counts.y, turn);

  uint random = hash(k + hash(floatBitsToUint(turn)));
  vec3 seed = seed_in_volume(volume, cell.at, texelFetch(seeds, int(active_cells[slot])).x);
  vec3 u = random_point(random);
  vec3 start = place_in_cell(volume, cell.at, seed, u, random);
  March m = march(volume.low.xyz + start * voxel_size(volume), direction, cell.volume,
                  unit_float(hash(random)), MARCH_ALL);
  uint result = RAY_MISS;
  if (m.hit) {
    uint surfel = surfel_of(cache.volumes[m.volume], m.voxel);
    vec3 normal = unpack_unit(fetch_surfel(surfel).surface.x);
    result = 2u * surfel + (dot(normal, direction) > 0.0 ? 1u : 0u);
#if MARK_MET
    met_sides[result] = 1u;
#endif
  }
  met[ray] = result;
}
