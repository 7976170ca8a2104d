// Sorts the entries of every node into buckets over depth, as many as its triangles deserve, one
// behind the other, so that what a ray passes in a node is one run; and makes the node's mask.
//
// One invocation a node (CROWDED 0), or for nodes with more than 512 entries a work group each
// (CROWDED 1): with so many, one invocation would take too long, and far more would meet llvmpipe's
// limit of iterations.
#include "primitive_tracer/nodes.glsl"

layout(local_size_x = 64) in;
layout(binding = 1) uniform usamplerBuffer listed;  // as NodeEntry: reads are faster this way
layout(std430, binding = 5) writeonly buffer Offsets { uint offsets[]; };
layout(std430, binding = 6) writeonly buffer Ids { uint ids[]; };
layout(std430, binding = 7) readonly buffer Order { uint order[]; };
layout(location = 3) uniform uint buckets_per_triangle;

#if CROWDED
shared uint shared_low, shared_high, shared_start, shared_copies, shared_extent, shared_mask[2];
shared uint bucket_counts[MOST_BUCKETS];
#define FIRST gl_LocalInvocationIndex
#define STRIDE 64u
#define ALONE (gl_LocalInvocationIndex == 0u)
#define WAIT memoryBarrier(); barrier();
uint take(uint bucket) { return atomicAdd(bucket_counts[bucket], 1u); }
#else
uint bucket_counts[MOST_BUCKETS];
#define FIRST 0u
#define STRIDE 1u
#define ALONE true
#define WAIT
uint take(uint bucket) { return bucket_counts[bucket]++; }
#endif

uvec2 depths_of(uint word) { return uvec2(word & 0xffffu, word >> DEPTH_BITS); }

void sort(uint node, uint start, uint end) {
  // The depths of all entries, which slices they touch, and how deep they are together.
  uint low = 0xffffffffu, high = 0u;
  float extent = 0.0;
  uvec2 mask = uvec2(0u);
  for (uint i = start + FIRST; i < end; i += STRIDE) {
    uvec2 depths = depths_of(texelFetch(listed, int(i)).y);
    low = min(low, depths.x);
    high = max(high, depths.y);
    extent += float(depths.y - depths.x);
    mask |= mask_between(depths.x >> MASK_SHIFT, depths.y >> MASK_SHIFT);
  }
#if CROWDED
  if (ALONE) {
    shared_low = 0xffffffffu;
    shared_high = shared_copies = shared_extent = shared_mask[0] = shared_mask[1] = 0u;
  }
  WAIT
  atomicMin(shared_low, low);
  atomicMax(shared_high, high);
  atomicAdd(shared_extent, uint(extent) >> 8u);
  atomicOr(shared_mask[0], mask.x);
  atomicOr(shared_mask[1], mask.y);
  WAIT
  low = shared_low;
  high = shared_high;
  extent = float(shared_extent) * 256.0;
  mask = uvec2(shared_mask[0], shared_mask[1]);
#endif

  // A power of two of depths a bucket: the least that needs no more buckets than wanted, and not so
  // little that the average triangle would stand in more than a few.
  uint wanted = min((end - start) * buckets_per_triangle, MOST_BUCKETS);
  wanted = wanted <= 1u ? 1u : 2u << findMSB(wanted - 1u);
  uint shift = 0u;
  float mean = extent / float(end - start);
  while ((high >> shift) - (low >> shift) >= wanted || float(8u << shift) < mean) ++shift;
  uint first = low >> shift, buckets = (high >> shift) - first + 1u;
#if CROWDED
  if (ALONE) shared_start = atomicAdd(counters.offsets, buckets + 1u);
  WAIT
  uint offset = shared_start;
#else
  uint offset = atomicAdd(counters.offsets, buckets + 1u);
#endif
  if (offset + buckets + 1u > list_sizes.z) return;  // the host makes room and starts again

  for (uint b = FIRST; b < buckets; b += STRIDE) bucket_counts[b] = 0u;
  WAIT
  // A triangle stands in every second bucket of those that it touches, and rays begin one bucket
  // early: they still find it, and where it touches two or three, it is there once or twice.
  uint copies = 0u;
  for (uint i = start + FIRST; i < end; i += STRIDE) {
    uvec2 range = (depths_of(texelFetch(listed, int(i)).y) >> shift) - first;
    for (uint b = range.x; b <= range.y; b += 2u) take(b);
    copies += (range.y - range.x) / 2u + 1u;
  }
#if CROWDED
  atomicAdd(shared_copies, copies);
  WAIT
  copies = shared_copies;
#endif
  // Where each bucket begins.
  if (ALONE) {
    uint at = atomicAdd(counters.ids, copies);
    for (uint b = 0u; b < buckets; ++b) {
      uint count = bucket_counts[b];
      bucket_counts[b] = offsets[offset + b] = at;
      at += count;
    }
    offsets[offset + buckets] = at;
    nodes[node] = uvec4(mask, offset, shift << NODE_SHIFT | (buckets - 1u) << NODE_BUCKETS |
                                          first << NODE_FIRST);
  }
  WAIT
  for (uint i = start + FIRST; i < end; i += STRIDE) {
    uvec2 entry = texelFetch(listed, int(i)).xy;
    uvec2 range = (depths_of(entry.y) >> shift) - first;
    for (uint b = range.x; b <= range.y; b += 2u) {
      uint place = take(b);
      if (place < list_sizes.w) ids[place] = entry.x;
    }
  }
}

void main() {
#if CROWDED
  uint i = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  if (i >= counters.lists[CROWDED_LISTS]) return;
  uint node = order[lists_before(CROWDED_LISTS) + i];
#else
  uint i = spread_invocation(1u);
  if (i >= lists_before(CROWDED_LISTS)) return;
  uint node = order[i];
#endif
  // Lists that found no room in the pool are cut off: the host makes room and starts again.
  uint start = lists[node].start, end = min(lists[node].end, pool_sizes.x);
  if (start < end) sort(node, start, end);
}
