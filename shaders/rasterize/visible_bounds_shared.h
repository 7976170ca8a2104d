// What the camera sees, by distance.
#pragma once

#include "base/cpp_glsl.h"

SHARED_BEGIN

const uint VISIBLE_SLABS = 24u;  // from the farthest corner of the scene to a 16-millionth of that

// Positions relative to the camera, as integers of the same order (ordered_bits()).
struct VisibleSlab {
  uint high[3];
  uint minus_low[3];
  uint pixels;
  uint padding;
};
SHARED_ASSERT_SIZE(VisibleSlab, 32)

SHARED_END
