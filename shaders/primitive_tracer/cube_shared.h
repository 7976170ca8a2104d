// The perspective views about one centre: six faces of a cube, or a single camera's.
#pragma once

#include "base/cpp_glsl.h"

SHARED_BEGIN

// Lengths are in units of the reach: how far the scene's box goes from the centre along any axis.
struct CubeViews {
  vec4 centre;   // xyz: relative to the list's origin; w: 1 / reach, 1/metre
  vec4 low;      // xyz: corner of the scene's box, relative to the list's origin
  vec4 high;     // xyz: the opposite corner
  ivec4 grid;    // x: tiles a side, a power of two; y: its logarithm; z: buckets of linked lists
  // A single view's axes, relative to the list's origin: dot products with x and y divided by that
  // with z run from -1 to 1 over the view.
  vec4 view_x, view_y, view_z;
};
SHARED_ASSERT_SIZE(CubeViews, 112)

// How far rounding may put a position off, in reaches: sixteen times what one operation does.
const float POSITION_ERROR = 1e-6;

// A cell of the pyramid is a node: its least and greatest depth, the least above the greatest where
// it holds nothing. Without linked lists there follow, in tiles, where the offsets of its buckets
// begin, and how many buckets it has; so it is a uvec4, and a uvec2 else.

// What rasterisation finds out about a tile.
struct TileRange {
  uint low, high;  // depths
  uint count;      // triangles
  uint extents;    // of their depths, added up, in units of 2^EXTENT_SHIFT
};
SHARED_ASSERT_SIZE(TileRange, 16)

// Ends a linked list.
const uint NO_LINK = 0xffffffffu;

SHARED_END
