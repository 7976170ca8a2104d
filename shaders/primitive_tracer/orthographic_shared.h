// The single view along the shortest axis of the scene's box, divided into square tiles, and the
// nodes of its pyramid.
#pragma once

#include "base/cpp_glsl.h"

SHARED_BEGIN

struct OrthographicView {
  vec4 low;    // xyz: corner of the box; w: tiles a metre
  vec4 depth;  // x: 1 / depth of the box, 1/metre; y: how far rounding may put a depth off, in
               // depths of the box; z: the same for a place on a ray, metres
  ivec4 grid;  // x: axis; y: tiles a side, a power of two; z: its logarithm; w: node of the first tile
};
SHARED_ASSERT_SIZE(OrthographicView, 48)

// Depths are whole numbers of 2^-DEPTH_BITS of the box; nodes keep a mask with a bit for each 64th.
const uint DEPTH_BITS = 16u;
const uint MASK_SHIFT = DEPTH_BITS - 6u;

// A node of the pyramid, of a tile, or of a part of a tile is a uvec4: its mask in x and y. Those
// that triangles are listed in have
//     z   where the offsets of its buckets begin
//     w   bits 3..7: shift from depths to buckets; bits 8..15: buckets - 1; above: first bucket
// and a tile that is divided into 2^k x 2^k parts has z: its first part and w: k.
const uint NODE_LEVELS = 7u;
const uint NODE_SHIFT = 3u;
const uint NODE_BUCKETS = 8u;
const uint NODE_FIRST = 16u;
const uint MOST_BUCKETS = 256u;

// The triangles that cross a node, while it is built: first counted, then listed as entries from
// `start` on.
struct NodeList {
  uint end;    // behind the last entry; before there are any, how many there will be
  uint start;  // before that, triangles whose middle is in the tile
};
SHARED_ASSERT_SIZE(NodeList, 8)

// One of them: its depths in the node, the lower in the lower half.
struct NodeEntry {
  uint primitive;
  uint depths;
};
SHARED_ASSERT_SIZE(NodeEntry, 8)

SHARED_END
