// Merges the sorted stretches of `width` of each list in pairs: every fragment finds its place by searching the other
// stretch. So no list is too long, whatever an invocation may do at a time.
#include "fragment_tracer/lists.glsl"

layout(std430, binding = 7) readonly buffer From { uvec2 from[]; };
layout(std430, binding = 8) writeonly buffer To { uvec2 to[]; };
layout(location = 1) uniform uint width;

void main() {
  uint i = invocation();
  if (i >= count) return;
  uvec2 mine = from[i];
  uint list = entries[mine.y].list, first = firsts[list], end = first + counts[list];
  uint place = i - first, stretch = place & ~(width - 1u);
  uint other = first + (stretch ^ width), pair = first + min(stretch, stretch ^ width);
  uint low = min(other, end), high = min(other + width, end), begin = low;
  while (low < high) {
    uint middle = (low + high) / 2u;
    if (before(from[middle], mine)) low = middle + 1u;
    else high = middle;
  }
  to[pair + (place - stretch) + (low - begin)] = mine;
}
