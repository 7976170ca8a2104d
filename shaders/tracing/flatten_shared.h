// What flatten.comp reads and reports.
#pragma once

#include "base/cpp_glsl.h"

SHARED_BEGIN

// Metres from the list's origin, along an axis. Beyond, the products of three coordinates that the
// intersection of a ray with a triangle takes would leave the range of floats.
const float FARTHEST = 1.0e12f;

// Triangles of one material of one instance.
struct TriangleSpan {
  uint first_primitive;
  uint instance;        // place of the instance on the GPU
  uint first_triangle;  // in the instance's mesh
  uint flags;           // TracedTriangle.flags of all of them
};
SHARED_ASSERT_SIZE(TriangleSpan, 16)

// Bounds of all vertices, as whole numbers that are ordered as the floats are: the negated bits of
// negative ones, the others with the first bit set.
struct FlattenSummary {
  uvec4 low, high;
  uint lost;  // triangles that are not finite or beyond FARTHEST
  uint unused0, unused1, unused2;
};
SHARED_ASSERT_SIZE(FlattenSummary, 48)

SHARED_END
