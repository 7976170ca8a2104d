// The nodes that triangles are listed in: tiles, then the parts of divided tiles.
#include "primitive_tracer/build.glsl"
#include "primitive_tracer/orthographic.glsl"

layout(std430, binding = 3) buffer Nodes { uvec4 nodes[]; };
layout(std430, binding = 4) buffer Lists { NodeList lists[]; };

uint node_count() { return list_sizes.x + min(counters.nodes, list_sizes.y); }

uint node_number(uint i) { return uint(box.grid.w) + i; }

// Index in counters.lists of a list of so many entries.
uint list_class(uint count) {
  return count == 1u ? 0u : min(uint(findMSB(count - 1u)) + 1u, CROWDED_LISTS);
}

// Nodes with shorter lists than those of a class.
uint lists_before(uint class_index) {
  uint sum = 0u;
  for (uint i = 0u; i < class_index; ++i) sum += counters.lists[i];
  return sum;
}
