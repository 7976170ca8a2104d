// Occlusion at work, in place of the scene.
#include "rasterize/bins.glsl"
#include "film/film.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2DArray estimates;
layout(binding = 1) uniform sampler2D combined;
layout(binding = 7) uniform usampler2D visibility;
layout(location = 2) uniform int views;

vec2 estimate(ivec2 pixel, int k) { return texelFetch(estimates, ivec3(pixel, k), 0).xy; }

// (4.1) over all views but one; -1: over all.
float occlusion_without(ivec2 pixel, int missing) {
  float sum = 0.0, weights = 0.0;
  for (int k = 0; k < views; ++k) {
    vec2 e = estimate(pixel, k);
    float weight = k == missing ? 0.0 : e.y;
    sum += weight * e.x;
    weights += weight;
  }
  return weights > 0.0 ? sum / weights : estimate(pixel, 0).x;
}

// Blue, cyan, green, yellow, red for 0 to 1.
vec3 heat(float x) { return clamp(vec3(1.5) - abs(4.0 * x - vec3(3.5, 2.0, 0.5)), 0.0, 1.0); }

vec3 shown(ivec2 pixel) {
#if PICTURE == WEIGHTS
  vec3 weights = vec3(0.0);
  for (int k = 0; k < min(views, 3); ++k) weights[k] = estimate(pixel, k).y;
  return weights;
#elif PICTURE == SAMPLES
  float taken = 0.0;
  for (int k = 0; k < views; ++k) taken += texelFetch(estimates, ivec3(pixel, k), 0).z;
  return heat(taken / float(views));
#elif PICTURE == CONTRIBUTION
  float whole = occlusion_without(pixel, -1);
  vec3 contribution = vec3(0.0);
  for (int k = 1; k < min(views, 4); ++k)
    contribution[k - 1] = abs(whole - occlusion_without(pixel, k));
  return contribution;
#elif PICTURE == BENT_NORMALS
  return 0.5 + 0.5 * texelFetch(combined, pixel, 0).xyz;
#elif PICTURE == SINGLE_VIEW
  return vec3(1.0 - estimate(pixel, 0).x);
#else
  return vec3(texelFetch(combined, pixel, 0).w);
#endif
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, view.size.xy))) return;
  bool covered = texelFetch(visibility, pixel, 0).x != 0u;
  film_add(FILM_COMBINED, pixel, vec4(covered ? shown(pixel) : vec3(0.0), 1.0));
}
