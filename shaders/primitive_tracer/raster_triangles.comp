// Rasterises triangles into the cells of all views, conservatively, one invocation a triangle; large
// ones go to a queue of blocks, or one invocation would hold up all others.
//
// The arrangement's file defines
//     struct Placed;                                       a triangle in a view
//     uint views_of(uint primitive);                       bits of the views that may see it
//     bool place(uint primitive, uint view, out Placed placed, out ivec4 cells);
//                                                          cells: first x, y, last x, y
//     bool overlaps(Placed placed, vec2 centre, float half_size);   all in cells
//     void emit(uint primitive, uint view, Placed placed, ivec2 cell);
#include "primitive_tracer/build.glsl"
#include "tracing/triangles.glsl"
#include "primitive_tracer/edges.glsl"
#include "generated/views.glsl"

layout(local_size_x = 64) in;

const int MOST_CELLS = 64;       // of a triangle that is rasterised here
const float BLOCK_REACH = 4.1;  // half a block and the same for it

void main() {
  uint primitive = spread_invocation(16u);
  if (primitive >= triangle_count || too_many_entries()) return;
  for (uint views = views_of(primitive); views != 0u; views &= views - 1u) {
    uint view = uint(findLSB(views));
    Placed placed;
    ivec4 cells;
    if (!place(primitive, view, placed, cells)) continue;
    ivec2 size = cells.zw - cells.xy + 1;
    if (size.x * size.y <= MOST_CELLS) {
      ivec2 cell = cells.xy;
      for (int i = size.x * size.y; i > 0; --i) {
        if (overlaps(placed, vec2(cell) + 0.5, REACH)) emit(primitive, view, placed, cell);
        cell = cell.x < cells.z ? ivec2(cell.x + 1, cell.y) : ivec2(cells.x, cell.y + 1);
      }
    } else if (LISTED == 0) {  // they are in the queue from then on
      ivec4 range = cells >> 3;
      ivec2 block = range.xy;
      for (int i = (range.z - range.x + 1) * (range.w - range.y + 1); i > 0; --i) {
        if (overlaps(placed, vec2(block * 8 + 4), BLOCK_REACH))
          add_block(primitive, view, uvec2(block));
        block = block.x < range.z ? ivec2(block.x + 1, block.y) : ivec2(range.x, block.y + 1);
      }
    }
  }
}
