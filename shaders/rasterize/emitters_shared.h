// Points of glowing surfaces whose radiance is asked for, and the answers.
#pragma once

#include "base/cpp_glsl.h"

SHARED_BEGIN

struct EmitterPlace {
  uint instance;  // its place on the GPU
  uint triangle;  // in the mesh
  float u, v;     // barycentric coordinates of the second and third vertex
};
SHARED_ASSERT_SIZE(EmitterPlace, 16)

struct EmitterRadiance {
  vec4 front, back;  // xyz: W/(m2 sr)
};
SHARED_ASSERT_SIZE(EmitterRadiance, 32)

SHARED_END
