// Gives every node room for the entries that were counted in it, and a rank among the nodes whose
// lists are about as long.
#include "primitive_tracer/nodes.glsl"

layout(local_size_x = 64) in;

void main() {
  if (invocation() >= node_count()) return;
  uint node = node_number(invocation()), count = lists[node].end;
  // What wraps around would look as if it fitted.
  if (count == 0u || counters.entries > 0xc0000000u) return;
  uint start = atomicAdd(counters.entries, count);
  lists[node] = NodeList(start, start);
  nodes[node].x = atomicAdd(counters.lists[list_class(count)], 1u);
}
