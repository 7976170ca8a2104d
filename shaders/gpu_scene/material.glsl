// What generated material code calls: parameters, images, normal maps and closures.
#include "base/color.glsl"
#include "base/albedo.glsl"
#include "base/fresnel.glsl"
#include "gpu_scene/geometry.glsl"

layout(binding = 6) uniform samplerBuffer material_params;
#if IMAGE_COUNT > 0
layout(binding = 8) uniform sampler2D material_images[IMAGE_COUNT];
#endif
// x: first vec4 of the material's parameters; y: first word of its attribute names in `tables`;
// z: bit i is set where image i holds sRGB codes.
layout(location = 0) uniform uvec3 material_block;

#define ATTRIBUTE(n) int(table(int(material_block.y) + (n)))

vec4 param(int i) { return texelFetch(material_params, int(material_block.x) + i); }

#include "gpu_scene/images.glsl"
#include "gpu_scene/normal_maps.glsl"
#include "gpu_scene/principled.glsl"
