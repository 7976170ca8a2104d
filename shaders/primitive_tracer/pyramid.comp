// One level of the pyramid of masks, from the level below.
#include "primitive_tracer/nodes.glsl"

layout(local_size_x = 64) in;
layout(location = 3) uniform int side;  // of the level that is written

void main() {
  int i = int(invocation());
  if (i >= side * side) return;
  int below = level_start(2 * side) + (i / side) * 4 * side + (i % side) * 2, above = below + 2 * side;
  nodes[level_start(side) + i] = uvec4(nodes[below].xy | nodes[below + 1].xy | nodes[above].xy |
                                           nodes[above + 1].xy, 0u, 0u);
}
