// One view that the scene is rasterised from: the camera, or one face of a shadow map.
#pragma once

#include "base/cpp_glsl.h"

SHARED_BEGIN

// All vectors have world axes. "Relative" means: minus world_origin, which is the camera's or the
// lamp's place, so that scenes far from the world's origin keep their precision.
struct View {
  mat4 clip_from_relative;  // depth 1 at the near plane, 0 at the far plane
  vec4 world_origin;        // xyz: metres
  // The ray through (x, y), in pixels from the lower left corner of the view:
  // origin + x * origin_dx + y * origin_dy, and the same for its direction (unit along the axis).
  vec4 ray_origin, ray_origin_dx, ray_origin_dy;
  vec4 ray_direction, ray_direction_dx, ray_direction_dy;
  vec4 axis;         // xyz: unit, the direction in which the view looks
  ivec4 size;        // x, y: pixels; z: sample index; w: seed
  vec4 alpha;        // x: threshold of the alpha test, or below 0: a random one; y: which view this
                     // is, so that views draw different random thresholds
  vec4 filtering;    // x: bias on the texture level (log2); y: width of a pixel at distance 1
                     // (perspective) or at any distance (orthographic); z: 1 = perspective
};
SHARED_ASSERT_SIZE(View, 64 + 16 * 11)

// What is drawn at once: one material of one instance. The visibility buffer names it by index + 1.
struct DrawRecord {
  uint instance;
  uint material;        // dense index, not the caller's id
  uint first_triangle;  // in the mesh's own triangles
  uint index;           // this record's own
};
SHARED_ASSERT_SIZE(DrawRecord, 16)

SHARED_END

#ifndef __cplusplus
layout(std140, binding = 0) uniform ViewBlock { View view; };

vec3 view_direction(vec2 pixel) {
  return normalize(view.ray_direction.xyz + pixel.x * view.ray_direction_dx.xyz +
                   pixel.y * view.ray_direction_dy.xyz);
}
#endif
