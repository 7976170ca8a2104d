// Puts the entries into all buckets of their tiles that they reach into (thesis, section 7.3.1.2):
// into linked lists, or counts them first (PLACED 0) and lists them then (PLACED 1).
#include "primitive_tracer/build.glsl"
#include "primitive_tracer/cube.glsl"

layout(local_size_x = 64) in;
#if LINKED_LISTS
layout(std430, binding = 3) readonly buffer Nodes { uvec2 nodes[]; };
layout(std430, binding = 5) buffer Heads { uint heads[]; };             // one for each bucket
layout(std430, binding = 6) writeonly buffer Links { uvec2 links[]; };  // primitive, next link
#else
layout(std430, binding = 3) readonly buffer Nodes { uvec4 nodes[]; };
layout(std430, binding = 5) buffer Offsets { uint offsets[]; };
layout(std430, binding = 6) writeonly buffer Ids { uint ids[]; };
#endif

void main() {
  uint i = invocation();
  if (i >= min(counters.entries, pool_sizes.x)) return;
  CellEntry entry = entries[i];
#if LINKED_LISTS
  uvec2 bounds = nodes[entry.cell];
  int buckets = cube.grid.z;
  uint first = entry.cell * uint(buckets);
#else
  uvec2 bounds = nodes[entry.cell].xy;
  int buckets = int(nodes[entry.cell].w);
  uint first = nodes[entry.cell].z;
  if (buckets == 0) return;  // a tile that found no room
#endif
  uint last = first + uint(bucket_of(entry.high, bounds, buckets));
  for (uint b = first + uint(bucket_of(entry.low, bounds, buckets)); b <= last; ++b) {
#if LINKED_LISTS
    uint link = atomicAdd(counters.ids, 1u);
    if (link >= list_sizes.w) continue;  // the host makes room and starts again
    links[link] = uvec2(entry.primitive, atomicExchange(heads[b], link));
#elif PLACED
    uint place = atomicAdd(offsets[b], 0xffffffffu) - 1u;
    if (place < list_sizes.w) ids[place] = entry.primitive;
#else
    atomicAdd(offsets[b], 1u);
#endif
  }
}
