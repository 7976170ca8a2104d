// Puts the entries into the buckets of their nodes: counts them (PLACED 0), then lists them
// (PLACED 1).
#include "primitive_tracer/build.glsl"
#include "primitive_tracer/orthographic_shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 3) readonly buffer Nodes { uvec4 nodes[]; };
layout(std430, binding = 5) buffer Offsets { uint offsets[]; };
#if PLACED
layout(std430, binding = 6) writeonly buffer Ids { uint ids[]; };
#endif

void main() {
  uint i = invocation();
  if (i >= min(counters.entries, pool_sizes.x)) return;
  CellEntry entry = entries[i];
  uvec2 info = nodes[entry.cell].zw;
  if (info.y >> NODE_SHIFT == 0u) return;  // a node that found no room
  uint shift = info.y >> NODE_SHIFT & 31u, first = info.y >> NODE_FIRST;
  uint last = (entry.high >> shift) - first;
  for (uint b = (entry.low >> shift) - first; b <= last; ++b) {
#if PLACED
    uint place = atomicAdd(offsets[info.x + b], 0xffffffffu) - 1u;
    if (place < list_sizes.w) ids[place] = entry.primitive;
#else
    atomicAdd(offsets[info.x + b], 1u);
#endif
  }
}
