// The radiance that arrives at cells, from what their rays have met: surfaces that send light on, and
// the world past them (thesis, (5.4) and (5.5)). One invocation a cell.
#include "base/invocation.glsl"
#include "radiance_cache/cells.glsl"
#include "radiance_cache/encoding.glsl"
#include "radiance_cache/rays.glsl"

#if CACHE_SPLIT
#define CACHE_PARTS 2
#else
#define CACHE_PARTS 1
#endif

layout(local_size_x = 64) in;
layout(std140, binding = CACHE_BLOCK) uniform CacheBlock { CacheVolumes cached; };
layout(std430, binding = 0) readonly buffer List { uint active_cells[]; };
layout(binding = 0) uniform usamplerBuffer met;         // as march.comp writes it
layout(binding = 1) uniform usamplerBuffer radiosity;   // of surfels: front, back; pack_light()
layout(binding = 2) uniform sampler2D world_radiance;   // latitudes from +Z down, longitudes from +X
layout(binding = 0, rgba32f) writeonly uniform image3D cells;
layout(location = 0) uniform uvec3 counts;              // cells of the list, directions, seed
layout(location = 1) uniform ivec4 lattice[MOST_CASCADES];

void store(Cell cell, int part, vec3 harmonics[9]) {
  vec4 texels[CELL_TEXELS] = encode(harmonics);
  ivec3 at = cell.at;
  at.x += part * imageSize(cells).x / CACHE_PARTS;
  at.z += cached.volumes[cell.volume].first.w;
  for (int k = 0; k < CELL_TEXELS; ++k) imageStore(cells, at + ivec3(0, 0, k * cached.count.w), texels[k]);
}

void main() {
  uint slot = invocation();
  if (slot >= counts.x) return;
  Cell cell = cell_of(cached, active_cells[slot]);
  float turn = cell_turn(cell.at + lattice[cell.volume].xyz, counts.z);
  vec3 world[9], bounced[9];
  for (int i = 0; i < 9; ++i) world[i] = bounced[i] = vec3(0.0);
  float looked = 0.0;
  for (uint k = 0u; k < counts.y; ++k) {
    uint hit = texelFetch(met, int(slot * counts.y + k)).x;
    vec3 direction = cache_direction(k, counts.y, turn);
    float basis[9] = spherical_harmonics(direction);
    looked += hit != RAY_LOST ? 1.0 : 0.0;
    vec3 arriving = vec3(0.0);
#if BOUNCED
    if (hit < RAY_LOST) arriving = unpack_light(texelFetch(radiosity, int(hit)).x) / CACHE_PI;
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
  float share = looked > 0.0 ? 4.0 * CACHE_PI / looked : 0.0;
  for (int i = 0; i < 9; ++i) {
    world[i] *= share;
    bounced[i] *= share;
  }
  store(cell, 0, world);
#if CACHE_SPLIT
  store(cell, 1, bounced);
#endif
}
