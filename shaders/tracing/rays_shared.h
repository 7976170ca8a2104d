// What every tracer reads and writes: triangles, rays and hits. All positions of one batch are
// relative to one world-space origin (tracing::TriangleList::origin), metres.
#pragma once

#include "base/cpp_glsl.h"

SHARED_BEGIN

const uint NO_PRIMITIVE = 0xffffffffu;

// Bits of TracedTriangle.flags: below, who sees it (SEEN_BY_...); a triangle whom nobody sees is hit
// by no ray and enters no structure.
const uint TRIANGLE_SEEN_BY = 63u;
const uint TRIANGLE_HAS_ALPHA = 64u;     // its material decides whether a ray stops here
const uint TRIANGLE_MATERIAL_SHIFT = 8u; // above: the material's dense index

// A triangle in the order of primitives; where it comes from lies in what alignment leaves over.
struct TracedTriangle {
  float x0, y0, z0;
  uint instance;     // place of its instance on the GPU
  float x1, y1, z1;
  uint triangle;     // its number in the instance's mesh
  float x2, y2, z2;
  uint flags;
};
SHARED_ASSERT_SIZE(TracedTriangle, 48)

// Meets what lies at t in (t_min, t_max], or at t_min itself if its primitive is greater than
// `after`: so that a ray goes on behind a surface without meeting it twice or skipping another that
// lies in the same place.
struct TracedRay {
  float origin_x, origin_y, origin_z;
  float t_min;  // not negative
  float direction_x, direction_y, direction_z;  // of any length but zero; t counts in it
  float t_max;
  uint after;    // NO_PRIMITIVE: nothing at t_min itself
  uint seen_by;  // meets triangles that have one of these bits
  uint seed;     // for what is decided by chance on the way
  uint tag;      // the caller's own
};
SHARED_ASSERT_SIZE(TracedRay, 48)

struct TracedHit {
  float t;         // t_max of the ray where there is none
  uint primitive;  // NO_PRIMITIVE: nothing was met
  float u, v;      // barycentric coordinates of the second and third vertex
};
SHARED_ASSERT_SIZE(TracedHit, 16)

// What one ray cost.
struct TracedWork {
  uint steps;    // nodes or cells visited
  uint tests;    // triangles tested
  uint longest;  // triangles in the longest list that was tested
  uint cell;     // where the last list lay, as the tracer numbers its cells or leaves
};
SHARED_ASSERT_SIZE(TracedWork, 16)

SHARED_END
