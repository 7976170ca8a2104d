// What generated world code calls; it defines vec3 evaluate_world(vec3 direction).
#include "base/color.glsl"
#include "base/fresnel.glsl"
#include "gpu_scene/view_shared.h"

layout(binding = 6) uniform samplerBuffer material_params;
#if IMAGE_COUNT > 0
layout(binding = 8) uniform sampler2D material_images[IMAGE_COUNT];
#endif
layout(location = 0) uniform uvec3 material_block;

vec4 param(int i) { return texelFetch(material_params, int(material_block.x) + i); }

#if IMAGE_COUNT > 0
#include "gpu_scene/sampling.glsl"
#define sample_image_wide(index, uv, width, unassociate) \
  sample_image_linear(IMAGE(index), uv, 0.0, unassociate)
#define sample_image_cubic(index, uv, width, unassociate) \
  sample_image_bicubic(IMAGE(index), uv, 0.0, unassociate)
#endif

#include "generated/world.glsl"

// What is not finite counts as black.
vec3 finite_world(vec3 direction) {
  vec3 radiance = evaluate_world(direction);
  for (int i = 0; i < 3; ++i)
    if (!(abs(radiance[i]) <= 1.0e30)) radiance[i] = 0.0;
  return radiance;
}
