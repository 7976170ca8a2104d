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

// Blender's equirectangular map: +X at the middle column's right quarter, +Z at the top row.
vec4 sample_environment_at(sampler2D image, bool srgb, vec3 direction) {
  float u = -atan(direction.y, direction.x) * 0.15915494309 + 0.5;
  float v = atan(direction.z, length(direction.xy)) * 0.31830988618 + 0.5;
  vec4 color = textureLod(image, vec2(u, v), 0.0);
  if (srgb) color.rgb = linear_from_srgb(color.rgb);
  return color;
}
#define sample_environment(index, direction)                                                     \
  sample_environment_at(material_images[min(index, IMAGE_COUNT - 1)],                            \
                        ((material_block.z >> min(index, IMAGE_COUNT - 1)) & 1u) != 0u, direction)

#include "generated/world.glsl"

// What is not finite counts as black.
vec3 finite_world(vec3 direction) {
  vec3 radiance = evaluate_world(direction);
  for (int i = 0; i < 3; ++i)
    if (!(abs(radiance[i]) <= 1.0e30)) radiance[i] = 0.0;
  return radiance;
}
