// The radiance field of the first bounce at cells, from samples of one face of a lamp's reflective
// shadow map (thesis, (5.1) to (5.3)). One invocation a cell, which adds to what is there.
#include "base/invocation.glsl"
#include "base/spherical_harmonics.glsl"
#include "radiance_cache/cell_places.glsl"
#include "radiance_cache/march.glsl"
#include "radiance_cache/rays.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer List { uint active_cells[]; };
layout(std430, binding = 1) buffer Reflected { vec4 reflected[]; };  // nine coefficients each
layout(binding = 0) uniform usamplerBuffer seeds;
layout(binding = 1) uniform usamplerBuffer map_places;  // as rsm_surfaces.comp writes them
layout(binding = 2) uniform usamplerBuffer map_flux;
layout(binding = 3) uniform samplerBuffer halton;       // points of the unit square
layout(location = 0) uniform uvec3 counts;  // cells of the list, seed, texels along the map's sides
layout(location = 1) uniform ivec4 lattice[MOST_CASCADES];
layout(location = 4) uniform uvec3 samples;  // of the face; the first one here, and the one after the last
layout(location = 5) uniform float spread;   // s of (5.3)
// x: to the map's left edge and right edge -1 and 1; y; axis, w: 1 = perspective; origin: as of
// ShadowFace, relative to the list of triangles' origin.
layout(location = 6) uniform vec4 face[4];
layout(location = 10) uniform uint number;  // of the face, among those of all lamps

// Where the window of (5.3) has its middle: as close to where the map sees the place as it can be
// without crossing the map's edges. Behind the lamp, on the side that is closest.
vec2 window_center(vec3 place) {
  vec3 p = place - face[3].xyz;
  vec2 at = vec2(dot(p, face[0].xyz), dot(p, face[1].xyz));
  float depth = dot(p, face[2].xyz);
  if (face[2].w > 0.5) at /= depth > 0.0 ? depth : max(max(abs(at.x), abs(at.y)), 1.0e-20) * 1.0e-3;
  at = (at - vec2(face[0].w, face[1].w)) * 0.5 + 0.5;
  return clamp(at, vec2(0.5 * spread), vec2(1.0 - 0.5 * spread));
}

// The part of the map's integral that a sample at `at` stands for.
float sample_weight(vec2 at, vec2 center, uint in_window) {
#if MIXED
  // The balance heuristic between those of the window and those of the whole map.
  vec2 off = abs(at - center);
  float inside = max(off.x, off.y) <= 0.5 * spread ? 1.0 : 0.0;
  return 1.0 / (float(in_window) * inside / (spread * spread) + float(samples.x - in_window));
#else
  return spread * spread / float(samples.x);
#endif
}

// Samples in solid voxels are aimed at from so far before them that surfaces next to them, in
// corners, hide them no more than the light that falls on them there, in voxels.
const float MARCH_SHORT = 1.0;

// Whether the geometry volume leaves the way open to a place on a surface.
bool sees_surface(vec3 from, vec3 place, vec3 normal, int v, float random) {
  int at = v;
  while (at + 1 < cache.count.x && !holds_voxel(cache.volumes[at], voxel_of(cache.volumes[at], place))) ++at;
  float side = voxel_size(cache.volumes[at]);
  // No voxel that the surface's plane meets lies as far before it.
  vec3 target = place + normal * (side * dot(abs(normal), vec3(1.0)));
  vec3 way = target - from;
  float reach = length(way);
  return !march(from, way / max(reach, 1.0e-20), v, random, reach - MARCH_SHORT * side).hit;
}

// Places in the cell are as evenly spread as those on the map: powers of the root of x^4 = x + 1, which
// makes the additive sequence of three dimensions with the lowest discrepancy known (Roberts 2018).
const vec3 PLACE_STEPS = vec3(0.8191725134, 0.6710436067, 0.5497004779);

void main() {
  uint slot = spread_invocation(1u);
  if (slot >= counts.x) return;
  uint listed = active_cells[slot];
  Cell cell = cell_of(cache, listed);
  CacheVolume volume = cache.volumes[cell.volume];
  float side = voxel_size(volume), turn = cell_turn(cell.at + lattice[cell.volume].xyz, counts.y);
  vec3 seed = seed_in_volume(volume, cell.at, texelFetch(seeds, int(listed)).x);
  vec2 center = window_center(volume.low.xyz + seed * side);
  float least = 0.5 * volume.low.w, texels = float(counts.z * counts.z);
  // Cells, and faces at a cell, have their points elsewhere, so that their errors are not the same.
  uint key = hash(floatBitsToUint(turn) + number);
  vec2 shift = random_point(key).xy;
  vec3 place_shift = random_point(key);
#if MIXED
  uint in_window = samples.x / 2u;
#else
  uint in_window = samples.x;
#endif

  vec3 sums[9];
  for (int i = 0; i < 9; ++i) sums[i] = vec3(0.0);
  for (uint k = samples.y; k < samples.z; ++k) {
    bool narrow = k < in_window;
    vec2 u = fract(texelFetch(halton, int(narrow ? k : k - in_window)).xy + shift);
    vec2 at = narrow ? center + (u - 0.5) * spread : u;
    uvec2 texel = min(uvec2(at * float(counts.z)), uvec2(counts.z - 1u));
    int index = int(texel.y * counts.z + texel.x);
    vec3 flux = unpack_light(texelFetch(map_flux, index).x);
    uvec4 there = texelFetch(map_places, index);
    vec3 place = uintBitsToFloat(there.xyz), normal = unpack_unit(there.w);

    uint random = hash(k + key);
    vec3 within = fract(float(k) * PLACE_STEPS + place_shift);
    vec3 from = volume.low.xyz + place_in_cell(volume, cell.at, seed, within, random) * side;
    vec3 way = place - from;
    float squared = dot(way, way);
    vec3 direction = way * inversesqrt(max(squared, 1.0e-30));
    // 1 / d^2 has no bound of its own; nearer than half a cell, cells do not tell places apart.
    float sent = texels * sample_weight(at, center, in_window) * max(-dot(normal, direction), 0.0) /
                 (CACHE_PI * max(squared, least * least));
    vec3 arriving = flux * sent;
    if (max(arriving.r, max(arriving.g, arriving.b)) > 0.0 &&
        sees_surface(from, place, normal, cell.volume, unit_float(hash(random)))) {
      float basis[9] = spherical_harmonics(direction);
      for (int i = 0; i < 9; ++i) sums[i] += arriving * basis[i];
    }
  }
  for (uint i = 0u; i < 9u; ++i) reflected[slot * 9u + i].rgb += sums[i];
}
