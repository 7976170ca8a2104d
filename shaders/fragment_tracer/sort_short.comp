// Sorts the list of each invocation by insertion, unless it is too long for that.
#include "fragment_tracer/lists.glsl"

layout(std430, binding = 7) buffer Sorted { uvec2 sorted[]; };
layout(location = 1) uniform uint longest;  // that is sorted here

void main() {
  uint list = invocation();
  if (list >= count || counts[list] < 2u || counts[list] > longest) return;
  uint first = firsts[list], end = first + counts[list];
  for (uint i = first + 1u; i < end; ++i) {
    uvec2 moved = sorted[i];
    uint to = i;
    while (to > first && before(moved, sorted[to - 1u])) {
      sorted[to] = sorted[to - 1u];
      --to;
    }
    sorted[to] = moved;
  }
}
