// Light from the radiance cache at a point of a surface (thesis, section 5.3, "Irradiance
// Reconstruction"). The volumes lie relative to the origin of the points.
#include "radiance_cache/encoding.glsl"
#include "radiance_cache/parts.glsl"
#include "radiance_cache/reach.glsl"
#include "radiance_cache/touched_cells.glsl"

// CELL_TEXELS texels for each part of a cell, cells by number.
layout(binding = CACHE_UNIT) uniform samplerBuffer cells;
#if CACHE_WALLS
layout(binding = REACH_UNIT) uniform usamplerBuffer reach;  // of voxels by number
#endif

// Radiance around a point, and how much of it is known.
struct CacheRadiance {
  vec4 parts[CACHE_PARTS * CELL_TEXELS];
  float share;  // 1 within the volumes, 0 beyond their border
};

struct CacheLight {
  vec3 world;    // with CACHE_SPLIT: what came straight from the world; else 0
  vec3 bounced;  // with CACHE_SPLIT: what surfaces have sent on; else all
  float clipped; // what was cut off below 0, relative to the light
};

#if CACHE_WALLS
// Cells whose seeds lie this far before a surface, in cells, count in full; from there on down to 0
// less and less, those behind it not at all, nor those whose seeds do not see what is before the
// surface. Where nothing else is near, they are better than nothing.
const float CACHE_BEFORE = 0.125, CACHE_LEAST = 1.0e-6;

// What reaches the voxel at a place in cells, and in `cell` the one that it lies in.
uint reach_at(CacheVolume volume, vec3 place, out ivec3 cell) {
  cell = clamp(ivec3(place), ivec3(0), volume.cells.xyz - 1);
  int side = volume.cells.w;
  ivec3 within = clamp(ivec3((place - vec3(cell)) * float(side)), ivec3(0), ivec3(side - 1));
  ivec3 voxel = cell * side + within;
  int row = voxel.z * volume.cells.y * side + voxel.y;
  int word = volume.first.y + row * volume.first.x + (voxel.x >> 5);
  return texelFetch(reach, word * 32 + (voxel.x & 31)).x;
}

// Which of the eight cells from `corner` on have seeds that see what is before a surface: as bits of
// reach.glsl from that of `corner` on.
uint reaching_cells(CacheVolume volume, vec3 place, vec3 normal, ivec3 corner) {
  ivec3 cell, nearer;
  uint bits = reach_at(volume, place + normal * CACHE_OFFSET, cell);
  // In a narrow place that may be within another surface.
  uint bits_nearer = reach_at(volume, place + normal / float(volume.cells.w), nearer);
  if (bits == 0u) {
    bits = bits_nearer;
    cell = nearer;
  }
  ivec3 first = corner - cell;  // -1 or 0, or the voxel knows nothing of these cells
  bool known = all(lessThanEqual(abs(2 * first + 1), ivec3(1)));
  return known ? bits >> uint(first.x + 1 + 3 * (first.y + 1 + 3 * (first.z + 1))) : 0u;
}
#endif

// What arrives at `position` on the side of a surface that faces `normal`.
CacheRadiance cache_radiance(vec3 position, vec3 normal) {
  CacheRadiance radiance;
  CacheVolume volume = cached.volumes[volume_of(position, radiance.share)];
  vec3 place = (position - volume.low.xyz) / volume.low.w;
  vec3 fraction;
  ivec3 corner = lowest_cell(volume, place, normal, fraction);
  for (int k = 0; k < CACHE_PARTS * CELL_TEXELS; ++k) radiance.parts[k] = vec4(0.0);
#if CACHE_WALLS
  uint reaching = reaching_cells(volume, place, normal, corner);
#endif
  float weights = 0.0;
  for (int i = 0; i < 8; ++i) {
    ivec3 step = ivec3(i & 1, i >> 1 & 1, i >> 2);
    ivec3 cell = min(corner + step, volume.cells.xyz - 1);
    vec3 parts = mix(1.0 - fraction, fraction, vec3(step));
    int first = cell_number(volume, cell) * CACHE_PARTS * CELL_TEXELS;
    vec4 last = texelFetch(cells, first + CELL_TEXELS - 1);
    uint seed = uint(last[COEFFICIENTS % 4]);
    float weight = seed == 0u ? 0.0 : parts.x * parts.y * parts.z;
#if CACHE_WALLS
    float before = dot(vec3(cell) + seed_place(seed, volume.cells.w) - place, normal);
    float reaches = float(reaching >> uint(step.x + 3 * step.y + 9 * step.z) & 1u);
    weight *= max(min(before / CACHE_BEFORE, reaches), CACHE_LEAST);
#endif
    weights += weight;
    for (int k = 0; k < CACHE_PARTS * CELL_TEXELS; ++k)
      radiance.parts[k] += weight * (k == CELL_TEXELS - 1 ? last : texelFetch(cells, first + k));
  }
  float scale = weights > 0.0 ? 1.0 / weights : 0.0;
  for (int k = 0; k < CACHE_PARTS * CELL_TEXELS; ++k) radiance.parts[k] *= scale;
  return radiance;
}

vec3 decode_part(CacheRadiance radiance, int part, float weights[9]) {
  vec4 texels[CELL_TEXELS];
  for (int k = 0; k < CELL_TEXELS; ++k) texels[k] = radiance.parts[part * CELL_TEXELS + k];
  return decode(texels, weights);
}

// Its light by weights of the harmonics.
CacheLight cache_light(CacheRadiance radiance, float weights[9]) {
  CacheLight light;
#if CACHE_SPLIT
  vec3 world = decode_part(radiance, 0, weights), bounced = decode_part(radiance, 1, weights);
#else
  vec3 world = vec3(0.0), bounced = decode_part(radiance, 0, weights);
#endif
  light.world = max(world, vec3(0.0));
  light.bounced = max(bounced, vec3(0.0));
  vec3 cut = light.world - world + light.bounced - bounced;
  vec3 all = light.world + light.bounced;
  light.clipped = (cut.r + cut.g + cut.b) / max(all.r + all.g + all.b, 1.0e-20);
  return light;
}
