// Lamps as the shaders see them: points, directions and cones, whatever their extent. A lamp that
// has an extent is one point of it in each sample of the film, so that many samples make its
// penumbra exact.
#pragma once

#include "base/cpp_glsl.h"

SHARED_BEGIN

const uint LIGHT_POINT = 0u;
const uint LIGHT_SUN = 1u;
const uint LIGHT_SPOT = 2u;
const uint LIGHT_AREA = 3u;
const uint NO_SHADOW = 0xffffffffu;

struct Light {
  vec4 position;   // xyz: relative to the camera, metres (lamps but suns); w: radius, metres
  vec4 axis;       // xyz: unit, where it shines (suns, spots, areas)
  vec4 power;      // xyz: irradiance at normal incidence (suns, W/m2), else radiant intensity (W/sr)
  vec4 cone;       // spots: x cosine of the half angle, y 1 / width of the blend in cosines
                   // areas: x tan(spread / 2), y normalisation, x < 0 for no spread
  uint type;
  uint shadow;     // first face in `shadow_faces`, or NO_SHADOW
  uint faces;      // 1, or 6 of a cube in the order +x -x +y -y +z -z
  uint padding;
};
SHARED_ASSERT_SIZE(Light, 80);

struct ShadowFace {
  mat4 clip_from_relative;  // from positions relative to the camera
  vec4 texel;  // x: width of a texel, metres (sun) or metres at one metre's depth; y: 1 = perspective
  vec4 tolerance;  // of the depth test: x relative, y absolute
};
SHARED_ASSERT_SIZE(ShadowFace, 96);

SHARED_END
