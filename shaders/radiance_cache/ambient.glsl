// Light that comes from everywhere but straight from lamps: of the radiance cache, or without one the
// world's as if nothing stood in its way.
#include "base/cpp_glsl.h"
#include "base/spherical_harmonics.glsl"
#if RADIANCE_CACHE
#include "radiance_cache/look_up.glsl"
#if CACHE_SCALES
#include "radiance_cache/scales.glsl"
#endif
#endif

struct Ambient {
  vec3 world;    // has met no surface yet; with the cache told apart only if CACHE_SPLIT
  vec3 bounced;  // has left a surface
  float clipped; // CacheLight::clipped
};

#if WORLD_LIGHT
// Coefficients of the world's radiance.
layout(std140, binding = 1) uniform WorldBlock { vec4 world_harmonics[9]; };

vec3 open_world(float weights[9]) {
  vec3 sum = vec3(0.0);
  for (int k = 0; k < 9; ++k) sum += world_harmonics[k].rgb * weights[k];
  return max(sum, vec3(0.0));
}
#else
vec3 open_world(float weights[9]) { return vec3(0.0); }
#endif

#if RADIANCE_CACHE
#define Around CacheRadiance
#else
struct Around { float share; };  // the world's light is the same everywhere
#endif

// What arrives at `position` on the side of a surface that faces `normal`.
Around look_around(vec3 position, vec3 normal) {
#if RADIANCE_CACHE
  return cache_radiance(position, normal);
#else
  return Around(0.0);
#endif
}

// Light of it by weights of the harmonics.
Ambient ambient(Around around, float weights[9]) {
  // Beyond the border of the volumes nothing is known but the world.
  vec3 open = open_world(weights) * (1.0 - around.share);
#if RADIANCE_CACHE
  CacheLight light = cache_light(around, weights);
#if CACHE_SPLIT
  return Ambient(open + light.world * around.share, light.bounced * around.share, light.clipped);
#else
  return Ambient(vec3(0.0), open + light.bounced * around.share, light.clipped);
#endif
#else
  return Ambient(open, vec3(0.0), 0.0);
#endif
}

// What a white diffuse surface there sends back; `open` is the mean direction in which it is open.
Ambient ambient_diffuse(Around around, vec3 open) {
  return ambient(around, banded_harmonics(open, DIFFUSE_BANDS));
}

// Radiance from `direction`, as a rough mirror sees it: a lobe of GGX's width takes from band l about
// exp(-(l alpha)^2 / 4).
Ambient ambient_radiance(Around around, vec3 direction, float roughness) {
  float alpha = roughness * roughness, lobe = exp(-0.25 * alpha * alpha);
  float squared = lobe * lobe;
  return ambient(around, banded_harmonics(direction, vec3(1.0, lobe, squared * squared)));
}
