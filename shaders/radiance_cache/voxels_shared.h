// What the passes that make the geometry volume hand on.
#pragma once

#include "base/cpp_glsl.h"

SHARED_BEGIN

// That the area of a voxel's face is counted in; words hold that of 2^18 faces.
const float AREA_STEPS = 16384.0f;

// A triangle that may be drawn for a voxel.
struct Contender {
  uint voxel;  // word * 32 + bit
  uint key;    // bits of a positive number: the greatest wins
  uint primitive;
};
SHARED_ASSERT_SIZE(Contender, 12)

SHARED_END
