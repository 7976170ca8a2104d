// Gives every node that holds triangles its buckets over depth: first (PLACED 0) as many as its
// triangles deserve, then (PLACED 1), with the triangles of each counted, room for the triangles one
// bucket behind the other, so that what a ray passes in a node is one run.
#include "primitive_tracer/build.glsl"
#include "primitive_tracer/orthographic.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 3) buffer Nodes { uvec4 nodes[]; };
layout(std430, binding = 4) readonly buffer Ranges { NodeRange ranges[]; };
layout(std430, binding = 5) buffer Offsets { uint offsets[]; };
layout(location = 3) uniform uint buckets_per_triangle;

void main() {
  uint i = invocation();
  if (i >= list_sizes.x + min(counters.nodes, list_sizes.y)) return;
  uint node = i < list_sizes.x ? i : uint(box.grid.w) + i - list_sizes.x;
  NodeRange range = ranges[node];
  if (range.count == 0u) return;

#if !PLACED
  // A power of two of depths a bucket, the least that needs no more buckets than wanted.
  uint wanted = min(range.count * buckets_per_triangle, MOST_BUCKETS);
  wanted = wanted <= 1u ? 1u : 2u << findMSB(wanted - 1u);
  uint shift = LEAST_SHIFT;
  while ((range.high >> shift) - (range.low >> shift) >= wanted) ++shift;
  uint first = range.low >> shift, buckets = (range.high >> shift) - first + 1u;
  uint start = atomicAdd(counters.offsets, buckets + 1u);
  if (start + buckets + 1u > list_sizes.z) return;  // the host makes room and starts again
  for (uint b = 0u; b <= buckets; ++b) offsets[start + b] = 0u;
  nodes[node].zw =
      uvec2(start, shift << NODE_SHIFT | (buckets - 1u) << NODE_BUCKETS | first << NODE_FIRST);
#else
  uvec2 info = nodes[node].zw;
  uint buckets = (info.y >> NODE_BUCKETS & 511u) + 1u;
  if (info.y == 0u || info.x + buckets + 1u > list_sizes.z) return;
  uint count = 0u;
  for (uint b = 0u; b < buckets; ++b) count += offsets[info.x + b];
  // Each bucket's offset stands at its end; placing counts it down to its beginning.
  uint end = atomicAdd(counters.ids, count);
  for (uint b = 0u; b < buckets; ++b) {
    end += offsets[info.x + b];
    offsets[info.x + b] = end;
  }
  offsets[info.x + buckets] = end;
#endif
}
