// Sends rays from the cells that hold light, and notes what they meet. One invocation a ray.
#include "base/invocation.glsl"
#include "radiance_cache/cells.glsl"
#include "radiance_cache/march.glsl"
#include "radiance_cache/rays.glsl"
#include "radiance_cache/reach.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer List { uint active_cells[]; };
layout(std430, binding = 1) writeonly buffer Met { uint met[]; };
layout(location = 0) uniform uvec3 counts;     // cells of the list, directions, seed
layout(location = 1) uniform ivec4 lattice[MOST_CASCADES];  // xyz: of each volume's first cell

layout(binding = 0) uniform usamplerBuffer seeds;
#if WALLS
layout(binding = 1) uniform usamplerBuffer reach;  // of voxels by number
#endif

// Rays begin anywhere in the cell that its seed sees (or, without WALLS, anywhere that is empty), if so
// many tries find such a place; else in the seed's own voxel. So light on the two sides of a wall is not
// mixed.
const int TRIES = 8;

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
  int side = volume.cells.w;
  ivec3 first = cell.at * side, seed = seed_voxel(texelFetch(seeds, int(active_cells[slot])).x & SEED_CODE);
  bool seen = false;
  vec3 start = vec3(first + seed), u;
  for (int i = 0; i <= TRIES && !seen; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      random = hash(random);
      u[axis] = unit_float(random);
    }
    vec3 within = i < TRIES ? u * float(side) : vec3(seed) + u;
    ivec3 voxel = first + min(ivec3(within), side - 1);
    start = vec3(first) + within;
#if WALLS
    int number = word_of(volume, voxel) * 32 + (voxel.x & 31);
    seen = (texelFetch(reach, number).x & reach_bit(ivec3(0))) != 0u;
#else
    seen = !voxel_is_solid(volume, voxel);
#endif
  }
  March m = march(volume.low.xyz + start * voxel_size(volume), direction, cell.volume,
                  unit_float(hash(random)));
  uint result = RAY_MISS;
  if (m.hit) {
    uint surfel = surfel_of(cache.volumes[m.volume], m.voxel);
    vec3 normal = unpack_unit(fetch_surfel(surfel).surface.x);
    result = 2u * surfel + (dot(normal, direction) > 0.0 ? 1u : 0u);
  }
  met[ray] = result;
}
