// Rasterises the queue of blocks of large triangles, one row of eight cells an invocation.
#include "primitive_tracer/build.glsl"
#include "tracing/triangles.glsl"
#include "primitive_tracer/edges.glsl"
#include "generated/views.glsl"

layout(local_size_x = 64) in;

void main() {
  uint row = invocation();
  if (row / 8u >= min(counters.blocks, pool_sizes.y) || too_many_entries()) return;
  RasterBlock block = blocks[row / 8u];
  Placed placed;
  ivec4 cells;
  if (!place(block.primitive, block.view, placed, cells)) return;
  ivec2 cell = ivec2(block.x, block.y) * 8 + ivec2(0, row & 7u);
  if (cell.y < cells.y || cell.y > cells.w) return;
  int last = min(cell.x + 7, cells.z);
  for (cell.x = max(cell.x, cells.x); cell.x <= last; ++cell.x)
    if (overlaps(placed, vec2(cell) + 0.5, REACH))
      emit(block.primitive, block.view, placed, cell);
}
