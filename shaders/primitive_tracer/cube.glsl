// From the space of the triangle list to the tiles of a view. Tile coordinates are homogeneous: x /
// z and y / z count tiles and z is the depth, in reaches. So borders of tiles are planes through
// the centre, and a line stays a line.
#include "primitive_tracer/cube_shared.h"
#include "tracing/triangles.glsl"

layout(std140, binding = 2) uniform CubeBlock { CubeViews cube; };

#if SINGLE_VIEW
const int VIEWS = 1;
vec3 to_view(vec3 v, int view) {
  return vec3(dot(cube.view_x.xyz, v), dot(cube.view_y.xyz, v), dot(cube.view_z.xyz, v));
}
#else
const int VIEWS = 6;  // along +x, -x, +y, -y, +z, -z
vec3 to_view(vec3 v, int view) {
  vec3 r = axis_last(v, view >> 1);
  return (view & 1) != 0 ? vec3(r.xy, -r.z) : r;
}
#endif

// A vector, or a position relative to the centre, in reaches.
vec3 to_tiles(vec3 v, int view) {
  vec3 r = to_view(v, view) * cube.centre.w;
  return vec3((r.xy + r.zz) * (0.5 * float(cube.grid.x)), r.z);
}

// Depths are whole numbers of 2^-DEPTH_BITS reaches, since atomics want such; and what rounding may
// do to one, in reaches.
const uint DEPTH_BITS = 22u;
const float DEPTH_MARGIN = 2e-6;
const uint EXTENT_SHIFT = 8u;  // of TileRange.extents

uint depth_code(float depth) {
  // Clamped as a float, since 1e30 is no uint.
  return uint((depth > 0.0 ? depth < 1.0 ? depth : 1.0 : 0.0) * float((1u << DEPTH_BITS) - 1u));
}

// The node of a cell; level 0 are the tiles, and come first.
int node_index(int view, int level, ivec2 cell) {
  int side = cube.grid.x, narrow = side >> level;
  return VIEWS * ((4 * (side * side - narrow * narrow)) / 3) +
         (view * narrow + cell.y) * narrow + cell.x;
}

// The uniform intervals of a tile's depths (7.1). Counting from low to high + 1 keeps the farthest
// in the last bucket and a tile of one depth from dividing by zero.
int bucket_of(uint depth, uvec2 bounds, int buckets) {
  float place = float(clamp(depth, bounds.x, bounds.y) - bounds.x);
  return min(int(place * (float(buckets) / float(bounds.y - bounds.x + 1u))), buckets - 1);
}
