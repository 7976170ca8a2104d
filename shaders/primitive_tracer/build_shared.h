// What the build passes of every arrangement of views share.
#pragma once

#include "base/cpp_glsl.h"

SHARED_BEGIN

// A triangle crosses a cell: what lists are made from.
struct CellEntry {
  uint cell;
  uint primitive;
  uint low, high;  // its depths in the cell, as the arrangement codes them
};
SHARED_ASSERT_SIZE(CellEntry, 16)

// 8x8 cells of a view that a large triangle may cross.
struct RasterBlock {
  uint primitive;
  uint view;
  uint x, y;  // in blocks
};
SHARED_ASSERT_SIZE(RasterBlock, 16)

const uint CROWDED_LISTS = 10u;  // index in BuildCounters.lists

// Counted past the end of what they count, so that the host knows what would have fitted.
struct BuildCounters {
  uint entries;  // CellEntry
  uint blocks;   // RasterBlock
  uint nodes;    // that an arrangement allocates beside its dense ones
  uint offsets;  // words that say where buckets begin
  uint ids;      // triangles in buckets
  uint lists[11];  // nodes by the length of their lists: ceil(log2), and all longer ones last
  uvec4 dispatch_blocks;   // indirect dispatch over blocks, eight invocations each
  uvec4 dispatch_entries;  // indirect dispatch over entries
  uvec4 dispatch_nodes;    // indirect dispatch over dense and allocated nodes
  uvec4 dispatch_crowded;  // indirect dispatch over crowded nodes, a work group each
};
SHARED_ASSERT_SIZE(BuildCounters, 128)

SHARED_END
