// The pools that rasterisation fills: entries of cells, and blocks of large triangles.
#include "primitive_tracer/build_shared.h"
#ifndef FRAGMENT_STAGE
#include "base/invocation.glsl"
#endif

// Arrangements that rasterise twice define LISTED as 0, then as 1.
#ifndef LISTED
#define LISTED 0
#endif

layout(std430, binding = 0) buffer Entries { CellEntry entries[]; };
layout(std430, binding = 1) buffer Blocks { RasterBlock blocks[]; };
layout(std430, binding = 2) buffer Counters { BuildCounters counters; };
layout(location = 0) uniform uint triangle_count;
layout(location = 1) uniform uvec2 pool_sizes;  // of entries, of blocks
layout(location = 2) uniform uvec4 list_sizes;  // dense nodes; most allocated nodes, offsets, ids
layout(location = 4) uniform uint entry_limit;  // more are not wanted: the host takes larger cells

// True when the build is in vain already.
bool too_many_entries() {
  return counters.entries > entry_limit || counters.blocks > entry_limit / 16u;
}

void add_entry(uint cell, uint primitive, uint low, uint high) {
  uint place = atomicAdd(counters.entries, 1u);
  if (place < pool_sizes.x) entries[place] = CellEntry(cell, primitive, low, high);
}

void add_block(uint primitive, uint view, uvec2 block) {
  uint place = atomicAdd(counters.blocks, 1u);
  if (place < pool_sizes.y) blocks[place] = RasterBlock(primitive, view, block.x, block.y);
}
