// The masks of divided tiles, from those of their parts.
#include "primitive_tracer/nodes.glsl"

layout(local_size_x = 64) in;

void main() {
  if (invocation() >= list_sizes.x) return;
  uint tile = node_number(invocation());
  uvec4 node = nodes[tile];
  uint levels = node.w & NODE_LEVELS;
  if (levels == 0u) return;
  uint end = node.z + (1u << (2u * levels));
  for (uint part = node.z; part < end; ++part) node.xy |= nodes[part].xy;
  nodes[tile] = node;
}
