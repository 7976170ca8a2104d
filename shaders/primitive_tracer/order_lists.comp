// Orders the nodes that have lists by the lists' length, so that what runs together takes equally long.
#include "primitive_tracer/nodes.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 7) writeonly buffer Order { uint order[]; };

void main() {
  if (invocation() >= node_count()) return;
  uint node = node_number(invocation()), count = lists[node].end - lists[node].start;
  if (count > 0u) order[lists_before(list_class(count)) + nodes[node].x] = node;
}
