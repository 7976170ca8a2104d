// Gives every tile that holds triangles its buckets over depth: first (PLACED 0) as many as its
// triangles deserve, then (PLACED 1), with the triangles of each counted, room for the triangles
// one bucket behind the other, so that what a ray passes in a tile is one run.
#include "primitive_tracer/build.glsl"
#include "primitive_tracer/cube.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 3) buffer Nodes { uvec4 nodes[]; };
layout(std430, binding = 4) readonly buffer Ranges { TileRange ranges[]; };
layout(std430, binding = 5) buffer Offsets { uint offsets[]; };
layout(location = 3) uniform float buckets_per_triangle;

const uint MOST_BUCKETS = 256u;
// Of one triangle, on average: piles of steep ones would multiply otherwise.
const float MOST_PLACES = 8.0;

void main() {
  uint tile = invocation();
  if (tile >= list_sizes.x) return;
  TileRange range = ranges[tile];
  if (range.count == 0u) return;
#if !PLACED
  float whole = float((range.high - range.low) >> EXTENT_SHIFT);
  // The part of the tile's depths that a triangle crosses.
  float crossed = float(range.extents) / max(float(range.count) * whole, 1.0);
  float wanted = float(range.count) * buckets_per_triangle;
  wanted = min(wanted, min(MOST_PLACES / max(crossed, 1e-6), whole + 1.0));
  uint buckets = uint(clamp(exp2(ceil(log2(wanted))), 1.0, float(MOST_BUCKETS)));
  uint start = atomicAdd(counters.offsets, buckets + 1u);
  if (start + buckets + 1u > list_sizes.z) return;  // the host makes room and starts again
  for (uint b = 0u; b <= buckets; ++b) offsets[start + b] = 0u;
  nodes[tile].zw = uvec2(start, buckets);
#else
  uint start = nodes[tile].z, buckets = nodes[tile].w, count = 0u;
  if (buckets == 0u) return;
  for (uint b = 0u; b < buckets; ++b) count += offsets[start + b];
  // Each bucket's offset stands at its end; placing counts it down to its beginning.
  uint end = atomicAdd(counters.ids, count);
  for (uint b = 0u; b < buckets; ++b) {
    end += offsets[start + b];
    offsets[start + b] = end;
  }
  offsets[start + buckets] = end;
#endif
}
