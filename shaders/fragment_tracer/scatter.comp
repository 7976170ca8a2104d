// Brings the fragment of each invocation to the run of its list.
#include "fragment_tracer/lists.glsl"

layout(std430, binding = 7) writeonly buffer Sorted { uvec2 sorted[]; };  // bits of the depth; entry

void main() {
  uint i = invocation();
  if (i >= count) return;
  FragmentEntry entry = entries[i];
  sorted[firsts[entry.list] + entry.rank] = uvec2(floatBitsToUint(entry.depth), i);
}
