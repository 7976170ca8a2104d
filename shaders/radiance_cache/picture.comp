// The radiance cache at work, in place of the scene (names.h).
#define G_BUFFER_READ 1
#include "gpu_scene/view_shared.h"
#include "rasterize/g_buffer.glsl"
#include "radiance_cache/look_up.glsl"
#include "radiance_cache/march.glsl"
#include "radiance_cache/surfel_color.glsl"
#include "film/film.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 7) uniform usampler2D visibility;
layout(binding = 0) uniform usamplerBuffer seeds;  // of all cells: CELL_OCCUPIED
layout(location = 2) uniform vec3 offset;          // from positions about the camera to those of surfels

#if PICTURE == GEOMETRY
// The first solid voxel before the camera.
vec3 shown(ivec2 pixel, GBufferPixel g) {
  vec3 origin = view.ray_origin.xyz + (float(pixel.x) + 0.5) * view.ray_origin_dx.xyz +
                (float(pixel.y) + 0.5) * view.ray_origin_dy.xyz + offset;
  vec3 direction = view_direction(vec2(pixel) + 0.5);
  CacheVolume last = cache.volumes[cache.count.x - 1];
  // On to where the ray enters the volumes.
  vec3 high = last.low.xyz + last.low.w * vec3(last.cells.xyz);
  vec3 pace = 1.0 / mix(direction, vec3(1.0e-20), lessThan(abs(direction), vec3(1.0e-20)));
  vec3 one = (last.low.xyz - origin) * pace, other = (high - origin) * pace;
  vec3 first = min(one, other), end = max(one, other);
  float enter = max(max(first.x, first.y), max(first.z, 0.0));
  if (enter > min(end.x, min(end.y, end.z))) return vec3(0.0);
  float share;
  int v = volume_of(origin + direction * enter - offset, share);
  March m = march(origin + direction * enter, direction, v, 0.5, MARCH_ALL);
  if (!m.hit) return vec3(0.0);
  Surfel surfel = fetch_surfel(surfel_of(cache.volumes[m.volume], m.voxel));
  vec3 normal = unpack_unit(surfel.surface.x);
  bool front = dot(normal, direction) <= 0.0;
  return unpack_color(front ? surfel.surface.y : surfel.surface.z) *
         (0.3 + 0.7 * abs(dot(normal, direction)));
}
#else
CacheVolume volume_at(vec3 position) {
  float share;
  return cached.volumes[volume_of(position, share)];
}

// The cell that a surface lies in.
ivec3 cell_at(CacheVolume volume, vec3 position) {
  return clamp(ivec3(floor((position - volume.low.xyz) / volume.low.w)), ivec3(0),
               volume.cells.xyz - 1);
}

uint seed_of(CacheVolume volume, ivec3 cell) {
  int first = cell_number(volume, cell) * CACHE_PARTS * CELL_TEXELS;
  return uint(texelFetch(cells, first + CELL_TEXELS - 1)[COEFFICIENTS % 4]);
}

#if PICTURE == OCCUPANCY
vec3 shown(ivec2 pixel, GBufferPixel g) {
  CacheVolume volume = volume_at(g.position);
  ivec3 cell = cell_at(volume, g.position + 0.5 * volume.low.w * g.geometric_normal);
  bool occupied = (texelFetch(seeds, cell_number(volume, cell)).x & CELL_OCCUPIED) != 0u;
  bool lit = seed_of(volume, cell) != 0u;
  // Every other cell is darker, so that they are told apart.
  float shade = ((cell.x + cell.y + cell.z) & 1) == 0 ? 1.0 : 0.6;
  return shade * (lit ? (occupied ? vec3(0.1, 0.8, 0.1) : vec3(0.8, 0.1, 0.1)) : vec3(0.0));
}
#elif PICTURE == LOBES
// A ball in the middle of each cell that holds light, about the visible surface.
vec3 shown(ivec2 pixel, GBufferPixel g) {
  CacheVolume volume = volume_at(g.position);
  ivec3 middle = cell_at(volume, g.position + 0.5 * volume.low.w * g.geometric_normal);
  vec3 origin = view.ray_origin.xyz + (float(pixel.x) + 0.5) * view.ray_origin_dx.xyz +
                (float(pixel.y) + 0.5) * view.ray_origin_dy.xyz;
  vec3 direction = view_direction(vec2(pixel) + 0.5);
  float radius = 0.3 * volume.low.w, nearest = 1.0e30;
  vec3 color = vec3(0.02);
  for (int i = 0; i < 27; ++i) {
    ivec3 cell = middle + ivec3(i % 3, i / 3 % 3, i / 9) - 1;
    if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, volume.cells.xyz))) continue;
    if (seed_of(volume, cell) == 0u) continue;
    vec3 to_middle = volume.low.xyz + (vec3(cell) + 0.5) * volume.low.w - origin;
    float along = dot(to_middle, direction);
    float squared = radius * radius - dot(to_middle, to_middle) + along * along;
    float t = along - sqrt(max(squared, 0.0));
    if (squared < 0.0 || t <= 0.0 || t >= nearest) continue;
    nearest = t;
    vec3 outward = (direction * t - to_middle) / radius;
    CacheRadiance radiance;
    int first = cell_number(volume, cell) * CACHE_PARTS * CELL_TEXELS;
    for (int k = 0; k < CACHE_PARTS * CELL_TEXELS; ++k) radiance.parts[k] = texelFetch(cells, first + k);
    CacheLight light = cache_light(radiance, banded_harmonics(outward, vec3(1.0)));
    color = light.world + light.bounced;
  }
  return color;
}
#else
vec3 shown(ivec2 pixel, GBufferPixel g) {
  CacheRadiance radiance = cache_radiance(g.position, g.geometric_normal);
  CacheLight light = cache_light(radiance, banded_harmonics(g.normal, DIFFUSE_BANDS));
#if PICTURE == LIGHT
  return light.world + light.bounced;
#else
  // All of it where harmonics leave nothing.
  return vec3(min(light.clipped, 1.0));
#endif
}
#endif
#endif

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, view.size.xy))) return;
  bool covered = texelFetch(visibility, pixel, 0).x != 0u || PICTURE == GEOMETRY;
  vec3 color = covered ? shown(pixel, read_g_buffer(pixel)) : vec3(0.0);
  film_add(FILM_COMBINED, pixel, vec4(color, 1.0));
}
