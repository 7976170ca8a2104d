// Triangles in the perspective views, for the raster passes: tile by tile, with the range of depths
// that the triangle has there (thesis, section 7.3.1.1), as the plane over the tile gives it, which
// is what clipping to the tile's frustum is for.
#include "primitive_tracer/cube.glsl"
#include "primitive_tracer/edges.glsl"

layout(std430, binding = 4) buffer Ranges { uint range_words[]; };  // as TileRange

struct Placed {
  // Planes through the centre and an edge: dot with (x, y, 1) is not negative inside. Rounding may
  // take at most `slack` from them, which near the centre is more than a tile's size.
  vec3 edge0, edge1, edge2;
  vec3 slack;
  // The plane: depth = offset / dot(normal, (x, y, 1)).
  vec3 normal;
  float normal_slack, offset, offset_slack;
  float nearest, farthest;  // depths in the view
  bool edge_on;             // its plane may pass through the centre: either side may be seen
};

// Bits of the views that may see a triangle, as its box tells.
uint views_of(uint primitive) {
  Corners corners = fetch_corners(primitive);
  if ((corners.flags & TRIANGLE_SEEN_BY) == 0u) return 0u;
#if SINGLE_VIEW
  return 1u;
#else
  vec3 low = (min(corners.p0, min(corners.p1, corners.p2)) - cube.centre.xyz) * cube.centre.w;
  vec3 high = (max(corners.p0, max(corners.p1, corners.p2)) - cube.centre.xyz) * cube.centre.w;
  vec3 aside = max(vec3(0.0), max(low, -high));  // distance of the box from zero
  uint views = 0u;
  for (int axis = 0; axis < 3; ++axis) {
    float least = max(aside[(axis + 1) % 3], aside[(axis + 2) % 3]) * 0.9999 - 4.0 * POSITION_ERROR;
    if (high[axis] >= least) views |= 1u << (2 * axis);
    if (-low[axis] >= least) views |= 2u << (2 * axis);
  }
  return views;
#endif
}

// Adds what the part of an edge in the view spans. The view is widened by what rounding may do, so
// that its sides meet behind the centre.
void add_edge(vec3 a, vec3 b, inout vec2 low, inout vec2 high, inout float nearest,
              inout float farthest) {
  float tiles = float(cube.grid.x), from = 0.0, to = 1.0;
  vec4 at_a = vec4(a.xy, tiles * a.zz - a.xy) + tiles * POSITION_ERROR;
  vec4 at_b = vec4(b.xy, tiles * b.zz - b.xy) + tiles * POSITION_ERROR;
  for (int side = 0; side < 4; ++side) {
    float crossing = at_a[side] / (at_a[side] - at_b[side]);
    if (at_a[side] < 0.0 && at_b[side] < 0.0) from = 2.0;
    else if (at_a[side] < 0.0) from = max(from, crossing);
    else if (at_b[side] < 0.0) to = min(to, crossing);
  }
  if (from > to) return;
  vec3 p = mix(a, b, from), q = mix(a, b, to);
  vec2 p2 = p.xy / p.z, q2 = q.xy / q.z;
  low = min(low, min(p2, q2));
  high = max(high, max(p2, q2));
  nearest = min(nearest, min(p.z, q.z));
  farthest = max(farthest, max(p.z, q.z));
}

// Most that rounding may change about an edge's plane, which is cross(p, along): by component.
vec3 edge_error(vec3 p, vec3 along, vec3 position_error) {
  p = abs(p) * 5e-7 + position_error;
  along = abs(along);
  return p.yzx * along.zxy + p.zxy * along.yzx;
}

bool place(uint primitive, uint view_number, out Placed placed, out ivec4 cells) {
  int view = int(view_number);
  float tiles = float(cube.grid.x);
  Corners corners = fetch_corners(primitive);
  vec3 p0 = to_tiles(corners.p0 - cube.centre.xyz, view);
  vec3 p1 = to_tiles(corners.p1 - cube.centre.xyz, view);
  vec3 p2 = to_tiles(corners.p2 - cube.centre.xyz, view);
  // Edges are transformed as vectors: the difference of transformed vertices loses their low bits.
  vec3 e1 = to_tiles(corners.p1 - corners.p0, view), e2 = to_tiles(corners.p2 - corners.p0, view);
  vec3 position_error = vec3(tiles, tiles, 1.0) * POSITION_ERROR;
  vec3 farthest_tile = vec3(tiles, tiles, 1.0);

  vec3 normal = cross(e1, e2);
  vec3 normal_error = edge_error(e1, e2, vec3(0.0));
  float offset = dot(normal, p0);
  float offset_slack = dot(normal_error, abs(p0)) +
                       dot(abs(normal), 5e-7 * abs(p0) + position_error);
  if (offset < 0.0) {
    normal = -normal;
    offset = -offset;
    vec3 swap = p1; p1 = p2; p2 = swap;
    swap = e1; e1 = e2; e2 = swap;
  }
  placed.normal = normal;
  placed.offset = offset;
  placed.offset_slack = offset_slack;
  placed.normal_slack = dot(normal_error, farthest_tile);
  placed.edge_on = offset <= offset_slack;
  placed.edge0 = cross(p0, e1);
  placed.edge1 = cross(p1, e2 - e1);
  placed.edge2 = cross(p2, -e2);
  vec3 error0 = edge_error(p0, e1, position_error);
  vec3 error1 = edge_error(p1, e2 - e1, position_error);
  vec3 error2 = edge_error(p2, e2, position_error);
  placed.slack = vec3(dot(error0, farthest_tile), dot(error1, farthest_tile),
                      dot(error2, farthest_tile));

  // What the triangle spans in the view.
  cells = ivec4(0, 0, -1, -1);
  vec2 low = vec2(1e30), high = vec2(-1e30);
  float nearest = 1e30, farthest = -1e30;
  vec3 x = vec3(p0.x, p1.x, p2.x), y = vec3(p0.y, p1.y, p2.y), z = vec3(p0.z, p1.z, p2.z);
  vec3 beyond_x = tiles * z - x, beyond_y = tiles * z - y, outside = vec3(-tiles * POSITION_ERROR);
  if (all(lessThan(x, outside)) || all(lessThan(y, outside)) || all(lessThan(beyond_x, outside)) ||
      all(lessThan(beyond_y, outside)))
    return false;
  vec3 least = min(min(x, y), min(beyond_x, beyond_y));
  bool contained = min(least.x, min(least.y, least.z)) >= 0.0 &&
                   min(z.x, min(z.y, z.z)) >= 2.0 * POSITION_ERROR;
  if (contained) {
    vec3 u = x / z, v = y / z;
    low = vec2(min(u.x, min(u.y, u.z)), min(v.x, min(v.y, v.z)));
    high = vec2(max(u.x, max(u.y, u.z)), max(v.x, max(v.y, v.z)));
    nearest = min(z.x, min(z.y, z.z));
    farthest = max(z.x, max(z.y, z.z));
  }
  // A loop of no or one turn: software skips it where no triangle at hand needs it, but no branch.
  for (int turn = contained ? 1 : 0; turn < 1; ++turn) {
    add_edge(p0, p1, low, high, nearest, farthest);
    add_edge(p1, p2, low, high, nearest, farthest);
    add_edge(p2, p0, low, high, nearest, farthest);
    for (int corner = 0; corner < 4; ++corner) {
      vec3 at = vec3(tiles * float(corner & 1), tiles * float(corner >> 1), 1.0);
      vec3 e = vec3(dot(placed.edge0, at), dot(placed.edge1, at), dot(placed.edge2, at));
      float slope = dot(normal, at);
      if (any(lessThan(e, -placed.slack)) || slope <= 0.0) continue;
      low = min(low, at.xy);
      high = max(high, at.xy);
      nearest = min(nearest, offset / slope);
      farthest = max(farthest, offset / slope);
    }
    // The centre lies in the triangle: there is no telling which tiles it covers.
    bool holds_centre = placed.edge_on && dot(placed.edge0, normal) >= -dot(error0, abs(normal)) &&
                        dot(placed.edge1, normal) >= -dot(error1, abs(normal)) &&
                        dot(placed.edge2, normal) >= -dot(error2, abs(normal));
    if (nearest < 2.0 * POSITION_ERROR || (holds_centre && farthest > 0.0)) {
      nearest = 0.0;
      low = vec2(0.0);
      high = vec2(tiles);
    }
  }
  if (low.x > high.x) return false;
  placed.nearest = nearest;
  placed.farthest = farthest;
  float margin = 0.02 + tiles * POSITION_ERROR / max(nearest, POSITION_ERROR);
  cells = ivec4(clamp(vec4(floor(low - margin), floor(high + margin)), 0.0, tiles - 1.0));
  return true;
}

bool overlaps(Placed placed, vec2 centre, float half_size) {
  return edges_reach(placed.edge0, placed.edge1, placed.edge2, placed.slack, placed.edge_on,
                     centre, half_size);
}

// cube_raster.geom emits no entries.
#ifndef GEOMETRY_STAGE
void emit(uint primitive, uint view, Placed placed, ivec2 cell) {
  // The plane over the tile, no further than the triangle itself.
  float slope = dot(placed.normal, vec3(vec2(cell) + 0.5, 1.0));
  float reach = REACH * (abs(placed.normal.x) + abs(placed.normal.y)) + placed.normal_slack;
  float least = (placed.edge_on ? abs(slope) : slope) - reach, most = slope + reach;
  float low = placed.edge_on || most <= 0.0
                  ? placed.nearest
                  : max(placed.offset - placed.offset_slack, 0.0) / most;
  float high = least > 0.0 ? (placed.offset + placed.offset_slack) / least : placed.farthest;
  low = clamp(low, placed.nearest, placed.farthest);
  high = clamp(high, low, placed.farthest);
  uint first = depth_code(low - DEPTH_MARGIN), last = depth_code(high + DEPTH_MARGIN);

  uint tile = (view * uint(cube.grid.x) + uint(cell.y)) * uint(cube.grid.x) + uint(cell.x);
  atomicMin(range_words[4u * tile], first);
  atomicMax(range_words[4u * tile + 1u], last);
#if !LINKED_LISTS
  atomicAdd(range_words[4u * tile + 2u], 1u);
  uint extent = (last - first) >> EXTENT_SHIFT;
  // Not past what 32 bits hold: then an average of some 100 000 triangles is as good.
  if (extent > 0u && range_words[4u * tile + 3u] < 0xc0000000u)
    atomicAdd(range_words[4u * tile + 3u], extent);
#endif
  add_entry(tile, primitive, first, last);
}
#endif
