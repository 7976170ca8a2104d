// What the programs that order fragments share: the runs of lists, each in one stretch of `sorted`.
#include "base/invocation.glsl"
#include "fragment_tracer/views.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Counters { FragmentCounters counters; };
layout(std430, binding = 3) readonly buffer Entries { FragmentEntry entries[]; };
layout(std430, binding = 4) readonly buffer Counts { uint counts[]; };   // of lists
layout(std430, binding = 6) buffer Firsts { uint firsts[]; };            // of lists: where their runs begin
layout(location = 0) uniform uint count;  // of what there is an invocation each

// Of equal depths the lower primitive comes first, so that the order does not depend on that of arrival.
bool before(uvec2 a, uvec2 b) {
  float depth_a = uintBitsToFloat(a.x), depth_b = uintBitsToFloat(b.x);
  if (depth_a != depth_b) return depth_a < depth_b;
  return entries[a.y].primitive < entries[b.y].primitive;
}
