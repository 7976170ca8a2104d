// A tile that a triangle may cross: an entry, if it does.
#define FRAGMENT_STAGE
#include "primitive_tracer/build.glsl"
#include "primitive_tracer/cube_raster.glsl"

flat in uint raster_primitive;

void main() {
  uint view = uint(gl_Layer);
  ivec2 cell = ivec2(gl_FragCoord.xy);
  Placed placed;
  ivec4 cells;
  if (too_many_entries() || !place(raster_primitive, view, placed, cells)) return;
  bool inside = all(greaterThanEqual(cell, cells.xy)) && all(lessThanEqual(cell, cells.zw));
  if (inside && overlaps(placed, vec2(cell) + 0.5, REACH))
    emit(raster_primitive, view, placed, cell);
}
