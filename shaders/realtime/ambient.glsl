// Light that comes from everywhere but straight from lamps: of the radiance cache, or without one the
// world's as if nothing stood in its way.
#include "base/spherical_harmonics.glsl"
#if RADIANCE_CACHE
#include "radiance_cache/look_up.glsl"
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

// Light at `position` on the side of a surface that faces `normal`, by weights of the harmonics.
Ambient ambient(vec3 position, vec3 normal, float weights[9]) {
#if RADIANCE_CACHE
  CacheLight light = cache_light(position, normal, weights);
  // Beyond the border of the volumes nothing is known but the world.
  vec3 open = open_world(weights) * (1.0 - light.share);
#if CACHE_SPLIT
  return Ambient(open + light.world * light.share, light.bounced * light.share, light.clipped);
#else
  return Ambient(vec3(0.0), open + light.bounced * light.share, light.clipped);
#endif
#else
  return Ambient(open_world(weights), vec3(0.0), 0.0);
#endif
}

// What a white diffuse surface there sends back; `open` is the mean direction in which it is open.
Ambient ambient_diffuse(vec3 position, vec3 normal, vec3 open) {
  return ambient(position, normal, banded_harmonics(open, DIFFUSE_BANDS));
}

// Radiance from `direction`, as a rough mirror sees it: a lobe of GGX's width takes from band l about
// exp(-(l alpha)^2 / 4).
Ambient ambient_radiance(vec3 position, vec3 normal, vec3 direction, float roughness) {
  float alpha = roughness * roughness, lobe = exp(-0.25 * alpha * alpha);
  float squared = lobe * lobe;
  return ambient(position, normal, banded_harmonics(direction, vec3(1.0, lobe, squared * squared)));
}
