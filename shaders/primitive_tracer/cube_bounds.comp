// One level of the pyramid of depth bounds (thesis, "Mipmap Depth"): the tiles' from rasterisation,
// the others' from the level below.
#include "primitive_tracer/build.glsl"
#include "primitive_tracer/cube.glsl"

layout(local_size_x = 64) in;
// Words 0 and 1 of NODE_WORDS: least and greatest depth of what lies there.
layout(std430, binding = 3) buffer Nodes { uint node_words[]; };
layout(std430, binding = 4) readonly buffer Ranges { TileRange ranges[]; };
layout(location = 3) uniform int level;  // that is written, from 0

uvec2 bounds_of(int node) {
  uint i = uint(node) * uint(NODE_WORDS);
  return uvec2(node_words[i], node_words[i + 1u]);
}

void main() {
  int side = cube.grid.x >> level, i = int(invocation());
  if (i >= VIEWS * side * side) return;
  int view = i / (side * side), rest = i - view * side * side;
  ivec2 cell = ivec2(rest % side, rest / side);
  uint node = uint(node_index(view, level, cell)) * uint(NODE_WORDS);

  uvec2 bounds;
  if (level == 0) {
    bounds = uvec2(ranges[i].low, ranges[i].high);
  } else {
    int below = node_index(view, level - 1, 2 * cell), above = below + 2 * side;
    uvec2 a = bounds_of(below), b = bounds_of(below + 1), c = bounds_of(above),
          d = bounds_of(above + 1);
    bounds = uvec2(min(min(a.x, b.x), min(c.x, d.x)), max(max(a.y, b.y), max(c.y, d.y)));
  }
  node_words[node] = bounds.x;
  node_words[node + 1u] = bounds.y;
#if !LINKED_LISTS
  node_words[node + 2u] = 0u;
  node_words[node + 3u] = 0u;
#endif
}
