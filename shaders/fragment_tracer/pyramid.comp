// Depth bounds of each cell from those of the four below; of level 0 from the pixels' own.
#include "base/invocation.glsl"
#include "fragment_tracer/views.glsl"
#include "fragment_tracer/levels.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 1) readonly buffer Bounds { uint bounds[]; };
layout(std430, binding = 3) buffer Levels { uvec2 levels[]; };
layout(location = 0) uniform int view;
layout(location = 1) uniform int level;

void main() {
  ivec2 size = level_size(view, level);
  int i = int(invocation());
  if (i >= size.x * size.y) return;
  ivec2 cell = ivec2(i % size.x, i / size.x);
  uvec2 found = uvec2(0xffffffffu, 0u);
  if (level == 0) {
    uint pixel = pixel_number(view, cell);
    found = uvec2(bounds[2u * pixel], bounds[2u * pixel + 1u]);
  } else {
    ivec2 below = level_size(view, level - 1);
    for (int k = 0; k < 4; ++k) {
      ivec2 child = 2 * cell + ivec2(k & 1, k >> 1);
      if (any(greaterThanEqual(child, below))) continue;
      uvec2 part = levels[level_index(view, level - 1, child)];
      found = uvec2(min(found.x, part.x), max(found.y, part.y));
    }
  }
  levels[level_index(view, level, cell)] = found;
}
