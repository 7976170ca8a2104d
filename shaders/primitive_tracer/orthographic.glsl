// From the space of the triangle list to tiles: x and y count tiles, z runs from 0 to 1.
#include "primitive_tracer/orthographic_shared.h"
#include "tracing/triangles.glsl"

layout(std140, binding = 2) uniform OrthographicBlock { OrthographicView box; };

vec3 to_tiles(vec3 position) {
  return axis_last(position - box.low.xyz, box.grid.x) * vec3(box.low.ww, box.depth.x);
}

vec3 vector_to_tiles(vec3 v) {
  return axis_last(v, box.grid.x) * vec3(box.low.ww, box.depth.x);
}

uint depth_code(float depth) {
  // Clamped as a whole number: comparisons of floats mind NaN, which takes longer.
  return uint(clamp(int(depth * float(1u << DEPTH_BITS)), 0, int(1u << DEPTH_BITS) - 1));
}

// Bits low .. high (0 .. 63) of the two words.
uvec2 mask_between(uint low, uint high) {
  uint a = (low < 32u ? 0xffffffffu << low : 0u) & (high < 31u ? (2u << high) - 1u : 0xffffffffu);
  uint b = (low > 32u ? 0xffffffffu << (low - 32u) : 0xffffffffu) &
           (high < 32u ? 0u : high < 63u ? (2u << (high - 32u)) - 1u : 0xffffffffu);
  return uvec2(a, b);
}

// First node of the level of the pyramid that is `side` nodes wide, a power of two. The widest, last,
// are the tiles, and the parts of divided tiles follow: (4^n - 1) / 3 nodes are in n levels.
int level_start(int side) { return 0x55555555 & (side * side - 1); }
