// What an artist multiplies bounced light by: everywhere, and in boxes.
#pragma once

#include "base/cpp_glsl.h"

SHARED_BEGIN

#define MOST_SCALE_REGIONS 8

struct ScaleRegion {
  mat4 box_from_place;  // from positions about the camera to [-1, 1]^3
  vec4 scale;           // x: of luminance; y: of chrominance, beside that
};

struct CacheScales {
  ScaleRegion regions[MOST_SCALE_REGIONS];
  vec4 scale;   // x, y: as above, everywhere
  ivec4 count;  // x: regions
};
SHARED_ASSERT_SIZE(CacheScales, 80 * MOST_SCALE_REGIONS + 32)

SHARED_END
