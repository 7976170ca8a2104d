// Turns counts into the arguments of indirect dispatches. At most 65 535 work groups go along x.
#include "primitive_tracer/build.glsl"

layout(local_size_x = 1) in;

uvec4 groups_for(uint invocations) {
  uint groups = (invocations + 63u) / 64u, across = min(groups, 65535u);
  return uvec4(across, across == 0u ? 0u : (groups + across - 1u) / across, 1u, 0u);
}

void main() {
  counters.dispatch_blocks = groups_for(min(counters.blocks, pool_sizes.y) * 8u);
  counters.dispatch_entries = groups_for(min(counters.entries, pool_sizes.x));
  counters.dispatch_nodes = groups_for(list_sizes.x + min(counters.nodes, list_sizes.y));
  counters.dispatch_crowded = groups_for(counters.lists[CROWDED_LISTS] * 64u);
}
