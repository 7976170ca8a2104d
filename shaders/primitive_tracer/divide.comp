// Divides crowded tiles into 2^k x 2^k parts and empties the nodes of tiles and parts.
#include "primitive_tracer/build.glsl"
#include "primitive_tracer/orthographic.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 3) writeonly buffer Nodes { uvec4 nodes[]; };
layout(std430, binding = 4) buffer Lists { NodeList lists[]; };
layout(location = 3) uniform uvec2 division;  // triangles that a part should hold; most levels

// Triangles from which on a tile is divided once more. From the third time on twice as many a part:
// finer parts cost more to build, which only a crowd pays back.
uint crowd(uint levels) { return division.x << (2u * levels + (levels >= 2u ? levels - 1u : 0u)); }

void main() {
  if (invocation() >= list_sizes.x) return;
  uint tile = uint(box.grid.w) + invocation();
  uint count = lists[tile].start, levels = 0u;
  while (levels < division.y && count > crowd(levels)) ++levels;

  uint first = 0u;
  if (levels > 0u) {
    uint parts = 1u << (2u * levels);
    uint place = atomicAdd(counters.nodes, parts);
    if (place + parts > list_sizes.y) {
      levels = 0u;  // the host makes room and starts again
    } else {
      first = uint(box.grid.w) + list_sizes.x + place;
      for (uint i = 0u; i < parts; ++i) {
        nodes[first + i] = uvec4(0u);
        lists[first + i] = NodeList(0u, 0u);
      }
    }
  }
  nodes[tile] = uvec4(0u, 0u, first, levels);
  lists[tile] = NodeList(0u, 0u);
}
