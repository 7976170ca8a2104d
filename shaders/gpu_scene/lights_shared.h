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
const uint LIGHT_MESH = 4u;  // a point of a glowing surface
const uint NO_SHADOW = 0xffffffffu;
const uint CUBE_FACES = 6u;

struct Light {
  vec4 position;   // xyz: the point of it that this sample uses, relative to the camera, metres
                   // (lamps but suns); w: its radius while the point is the centre; meshes: light is
                   // bounded within that distance, metres
  vec4 center;     // xyz: likewise, of the whole lamp; meshes: power of the back
  vec4 axis;       // xyz: unit, where it shines (suns, spots, areas); meshes: normal of the front
  vec4 power;      // xyz: irradiance at normal incidence (suns, W/m2), else radiant intensity (W/sr)
  vec4 cone;       // spots: x cosine of the half angle, y 1 / width of the blend in cosines
                   // areas: x tan(spread / 2), y normalisation, x < 0 for no spread
                   // z: radius that penumbrae are filtered by, metres; suns: tan(angle / 2)
  uint type;
  uint shadow;     // first face in `shadow_faces`, or NO_SHADOW
  uint faces;      // 1; CUBE_FACES in the order +x -x +y -y +z -z; suns: cascades, finest first
  uint padding;
};
SHARED_ASSERT_SIZE(Light, 96)

// A shadow map's frame. For a point p relative to `origin`, its depth is dot(p, axis), and its place
// in the map, -1..1, is (dot(p, x), dot(p, y)) / (perspective ? depth : 1) - (x.w, y.w).
struct ShadowFace {
  vec4 origin;       // xyz: relative to the camera, metres; w: width of a texel (at depth 1)
  vec4 x, y;         // xyz: unit vectors divided by half_extent
  vec4 axis;         // xyz: unit; w: 1 = perspective
  vec4 half_extent;  // x, y: metres, perspective: tangents; z: layer of the map, -1 for
                     // none; w: texels along x that the face uses of its layer
  vec4 depth;        // stored = x / depth + y (perspective), x * depth + y; z: nearest depth;
                     // w: texels along y, which shadow maps have as many of as along x
};
SHARED_ASSERT_SIZE(ShadowFace, 96)

SHARED_END
