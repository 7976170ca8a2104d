// The radiance that arrives at cells, from what their rays have met: surfaces that send light on, and
// the world past them (thesis, (5.4) and (5.5)). One invocation a cell.
#include "base/invocation.glsl"
#include "radiance_cache/cells.glsl"
#include "radiance_cache/encoding.glsl"
#include "radiance_cache/parts.glsl"
#include "radiance_cache/rays.glsl"


layout(local_size_x = 64) in;
layout(std140, binding = CACHE_BLOCK) uniform CacheBlock { CacheVolumes cached; };
layout(std430, binding = 0) readonly buffer List { uint active_cells[]; };
layout(std430, binding = 1) writeonly buffer Cells { vec4 cells[]; };  // look_up.glsl
layout(binding = 0) uniform usamplerBuffer met;         // as march.comp writes it
layout(binding = 1) uniform usamplerBuffer radiosity;   // of surfels: front, back; as pack_light()
layout(binding = 2) uniform sampler2D world_radiance;   // latitudes from +Z down, longitudes from +X
layout(binding = 3) uniform usamplerBuffer seeds;
#if REFLECTED
layout(binding = 6) uniform samplerBuffer reflected;    // as rsm_gather.comp writes it
#endif
layout(location = 0) uniform uvec3 counts;              // cells of the list, directions, seed
layout(location = 1) uniform ivec4 lattice[MOST_CASCADES];

void store(uint first, vec3 harmonics[9], float seed) {
  vec4 texels[CELL_TEXELS] = encode(harmonics, seed);
  for (int k = 0; k < CELL_TEXELS; ++k) cells[first + uint(k)] = texels[k];
}

void main() {
  uint slot = invocation();
  if (slot >= counts.x) return;
  uint number = active_cells[slot];
  Cell cell = cell_of(cached, number);
  float turn = cell_turn(cell.at + lattice[cell.volume].xyz, counts.z);
  vec3 world[9], bounced[9];
  for (int i = 0; i < 9; ++i) world[i] = bounced[i] = vec3(0.0);
  for (uint k = 0u; k < counts.y; ++k) {
    uint hit = texelFetch(met, int(slot * counts.y + k)).x;
    vec3 direction = cache_direction(k, counts.y, turn);
    float basis[9] = spherical_harmonics(direction);
    vec3 arriving = vec3(0.0);
#if BOUNCED
    if (hit != RAY_MISS) arriving = unpack_light(texelFetch(radiosity, int(hit)).x) / CACHE_PI;
#endif
#if CACHE_SPLIT
    for (int i = 0; i < 9; ++i) bounced[i] += arriving * basis[i];
    arriving = vec3(0.0);
#endif
#if WORLD
    vec2 at = vec2(atan(direction.y, direction.x) / (2.0 * CACHE_PI), acos(clamp(direction.z, -1.0, 1.0)) / CACHE_PI);
    if (hit == RAY_MISS) arriving = textureLod(world_radiance, at, 0.0).rgb;
#endif
    for (int i = 0; i < 9; ++i) world[i] += arriving * basis[i];
  }
  float share = 4.0 * CACHE_PI / float(counts.y);
  float seed = float(texelFetch(seeds, int(number)).x & SEED_CODE);
  for (int i = 0; i < 9; ++i) {
    world[i] *= share;
    bounced[i] *= share;
  }
#if REFLECTED
  for (int i = 0; i < 9; ++i) {
    vec3 first = texelFetch(reflected, int(slot) * 9 + i).rgb;
#if CACHE_SPLIT
    bounced[i] += first;
#else
    world[i] += first;
#endif
  }
#endif
  uint first = number * uint(CACHE_PARTS * CELL_TEXELS);
  store(first, world, seed);
#if CACHE_SPLIT
  store(first + uint(CELL_TEXELS), bounced, seed);
#endif
}
