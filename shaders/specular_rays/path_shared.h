// What a path of mirrors and glass knows between two surfaces, and what all paths of a sample share.
// All positions are about the origin of the list of triangles, metres.
#pragma once

#include "base/cpp_glsl.h"

SHARED_BEGIN

// Lobes that rays follow, and how one left its pixel's surface: SpecularPath.lobes, and what a pixel
// keeps of its ray.
const uint FOLLOWS_SPECULAR = 1u;
const uint FOLLOWS_COAT = 2u;
const uint FOLLOWS_TRANSMISSION = 4u;
const uint FOLLOWS = 7u;
const uint LEFT_BY_REFRACTION = 8u;

// A path ends after so often being mirrored or refracted: enough to see through a hollow glass and a
// pane, or through a ball in a mirror.
const uint MOST_EVENTS = 8u;

struct SpecularPath {
  float throughput_r, throughput_g, throughput_b;
  float way;   // from the camera on, metres
  uint pixel;  // y * width + x
  uint lobes;  // of the surface it meets first: those to follow; of that where it ends: those that
               // have been followed by others in its place
  uint unused0, unused1;
};
SHARED_ASSERT_SIZE(SpecularPath, 32)

struct SpecularFrame {
  vec4 camera;    // xyz: its place; w: rays end here, metres
  vec4 roughness; // x: of the roughest lobes that are followed
  uvec4 sampling; // x: index of the sample; y: seed
};
SHARED_ASSERT_SIZE(SpecularFrame, 48)

SHARED_END

#ifndef __cplusplus
layout(std140, binding = 4) uniform SpecularBlock { SpecularFrame frame; };
#endif
