// Counts the triangles whose middle lies in each tile, by which tiles are divided.
#include "primitive_tracer/build.glsl"
#include "primitive_tracer/orthographic.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 4) buffer Lists { NodeList lists[]; };

void main() {
  uint primitive = invocation();
  if (primitive >= triangle_count) return;
  Corners corners = fetch_corners(primitive);
  if ((corners.flags & TRIANGLE_SEEN_BY) == 0u) return;
  vec3 middle = to_tiles(corners.p0 + ((corners.p1 - corners.p0) + (corners.p2 - corners.p0)) / 3.0);
  ivec2 tile = clamp(ivec2(middle.xy), ivec2(0), ivec2(box.grid.y - 1));
  atomicAdd(lists[box.grid.w + tile.y * box.grid.y + tile.x].start, 1u);
}
