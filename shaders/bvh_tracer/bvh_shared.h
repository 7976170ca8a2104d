// The nodes of the bounding volume hierarchy: packed by the host, walked by traverse.glsl.
#pragma once

#include "base/cpp_glsl.h"

SHARED_BEGIN

// Nodes on the way from the root to a leaf, at most; which bounds the stack of a traversal.
const uint BVH_DEPTH = 48u;

// A child is the number of a node, or, if negative, ~(first << BVH_COUNT_BITS | count): a leaf of
// `count` triangles from `first`.
const uint BVH_COUNT_BITS = 3u;

// A node has the boxes of both its children, so that one visit decides about both, on a grid of 256
// planes along each axis that spans them (after Ylitie, Karras and Laine 2017). Plane q of axis x is
// at x + q * 2^(exponent - 127).
struct BvhNode {
  float x, y, z;
  // 8 bits each: exponents of x, y, z; then 4 bits for each child: of a leaf, 1 + the number of its
  // triangles, else 0.
  uint grid;
  // 8 bits each: low and high plane of child 0, low and high plane of child 1.
  uint planes_x, planes_y, planes_z;
  // Nodes are numbered with parents before child 0 before child 1, and so are triangles: the first
  // child that is a node is the next node, and the triangles of a second leaf follow those of the
  // first. This is what is left to say: of two nodes, the second; else the first leaf's `first`.
  uint other;
};
SHARED_ASSERT_SIZE(BvhNode, 32)

SHARED_END
