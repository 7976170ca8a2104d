// The nodes that triangles are listed in: tiles, then the parts of divided tiles.
#include "primitive_tracer/build.glsl"
#include "primitive_tracer/orthographic.glsl"

layout(std430, binding = 3) buffer Nodes { uvec4 nodes[]; };
layout(std430, binding = 4) buffer Lists { NodeList lists[]; };

uint node_count() { return list_sizes.x + min(counters.nodes, list_sizes.y); }

uint node_number(uint i) { return uint(box.grid.w) + i; }
