// What one view's estimate of ambient occlusion is asked for, and how the view sees.
#pragma once

#include "base/cpp_glsl.h"
#include "gpu_scene/lights_shared.h"

SHARED_BEGIN

struct OcclusionView {
  vec4 range;      // x: r_max, metres; y: 1 / x; z: b of (4.2); w: sine of the least elevation that counts
  uvec4 samples;   // x: N_s; y: N_init; z: number of the sequence's first point; w: seed
  uvec4 place;     // x: layer of the estimates; y: faces of the view; z: probes: every so many pixels;
                   // w: probes: of how many views; phantom views: layers of the others' estimates
  ShadowFace faces[6];
};
SHARED_ASSERT_SIZE(OcclusionView, 48 + 6 * 96)

// A pixel of the picture as one view estimates it, for the choice of views.
struct OcclusionProbe {
  float occlusion, weight;
  float depth;    // along the camera's axis, metres
  uint covered;   // 1: the probe's pixel shows a surface
};
SHARED_ASSERT_SIZE(OcclusionProbe, 16)

SHARED_END
