// Triangles in the orthographic view, for the raster passes: tile by tile, and in divided tiles part
// by part. They run twice, first (LISTED 0) to count the triangles of each node, then to list them
// with the range of depths that each has there: rasterising again is cheaper than a stream of
// entries through memory, whose every place costs an atomic that all threads want.
#include "primitive_tracer/edges.glsl"
#include "primitive_tracer/orthographic.glsl"

layout(binding = 1) uniform usamplerBuffer nodes;
layout(std430, binding = 0) writeonly buffer NodeEntries { NodeEntry node_entries[]; };
layout(std430, binding = 4) buffer Lists { NodeList lists[]; };

struct Placed {
  vec3 edge0, edge1, edge2;  // not negative inside: dot with (x, y, 1)
  vec3 corner;               // the first vertex
  vec2 slope, slope_error;   // of depth over x and y, and by how much rounding may mistake it
  vec2 low, high;            // bounds in x and y
  float depth_low, depth_high;
  bool edge_on;              // too thin as seen here for its orientation to be known
};

uint views_of(uint primitive) {
  return (fetch_corners(primitive).flags & TRIANGLE_SEEN_BY) != 0u ? 1u : 0u;
}

vec3 edge_function(vec2 p, vec2 along) {
  return vec3(-along.y, along.x, along.y * p.x - along.x * p.y);
}

bool place(uint primitive, uint view, out Placed placed, out ivec4 cells) {
  Corners corners = fetch_corners(primitive);
  // Edges are transformed as vectors: the difference of transformed vertices loses their low bits.
  vec3 p0 = to_tiles(corners.p0);
  vec3 e1 = vector_to_tiles(corners.p1 - corners.p0), e2 = vector_to_tiles(corners.p2 - corners.p0);
  vec3 p1 = p0 + e1, p2 = p0 + e2;

  // The plane's slope, and how uncertain rounding of the products makes it.
  float area = e1.x * e2.y - e1.y * e2.x;
  float size = (abs(e1.x) + abs(e1.y)) * (abs(e2.x) + abs(e2.y));
  placed.edge_on = abs(area) < 1e-4 * size || size < 1e-20;
  float inverse = placed.edge_on ? 0.0 : 1.0 / area;
  placed.corner = p0;
  placed.slope = vec2(e1.z * e2.y - e2.z * e1.y, e2.z * e1.x - e1.z * e2.x) * inverse;
  vec2 products = vec2(abs(e1.z * e2.y) + abs(e2.z * e1.y), abs(e2.z * e1.x) + abs(e1.z * e2.x));
  placed.slope_error = 5e-7 * abs(inverse) * (products + abs(placed.slope) * size);

  vec2 q1 = p1.xy, q2 = p2.xy, f1 = e1.xy, f2 = e2.xy;
  if (area < 0.0) {
    q1 = p2.xy;
    q2 = p1.xy;
    f1 = e2.xy;
    f2 = e1.xy;
  }
  placed.edge0 = edge_function(p0.xy, f1);
  placed.edge1 = edge_function(q1, f2 - f1);
  placed.edge2 = edge_function(q2, -f2);
  placed.low = min(p0.xy, min(q1, q2));
  placed.high = max(p0.xy, max(q1, q2));
  placed.depth_low = min(p0.z, min(p1.z, p2.z));
  placed.depth_high = max(p0.z, max(p1.z, p2.z));
  cells = ivec4(max(ivec2(floor(placed.low - 0.02)), ivec2(0)),
                min(ivec2(floor(placed.high + 0.02)), ivec2(box.grid.y - 1)));
  return true;
}

bool overlaps(Placed placed, vec2 centre, float half_size) {
  vec3 slack = 1e-6 * abs(vec3(placed.edge0.z, placed.edge1.z, placed.edge2.z));
  return edges_reach(placed.edge0, placed.edge1, placed.edge2, slack, placed.edge_on, centre,
                     half_size);
}

// Counts the triangle in a node, or lists it with its depths there.
void list(uint primitive, Placed placed, uint node, vec2 centre, float half_size) {
  uint slot = atomicAdd(lists[node].end, 1u);
#if LISTED
  if (slot >= pool_sizes.x) return;  // the host makes room and starts again
  // The plane over the cell, no further than the triangle itself.
  vec2 offset = centre - placed.corner.xy;
  float depth = placed.corner.z + dot(placed.slope, offset);
  float reach = half_size * (abs(placed.slope.x) + abs(placed.slope.y)) +
                dot(placed.slope_error, abs(offset) + half_size);
  float low = placed.edge_on ? placed.depth_low
                             : clamp(depth - reach, placed.depth_low, placed.depth_high);
  float high = placed.edge_on ? placed.depth_high
                              : clamp(depth + reach, placed.depth_low, placed.depth_high);
  node_entries[slot] = NodeEntry(
      primitive, depth_code(low - box.depth.y) | depth_code(high + box.depth.y) << DEPTH_BITS);
#endif
}

void emit(uint primitive, uint view, Placed placed, ivec2 cell) {
  uint tile = uint(box.grid.w + cell.y * box.grid.y + cell.x);
  uvec4 node = texelFetch(nodes, int(tile));
  uint levels = node.w & NODE_LEVELS;
  if (levels == 0u) {
    list(primitive, placed, tile, vec2(cell) + 0.5, REACH);
    return;
  }
  int parts = 1 << levels;
  float size = 1.0 / float(parts);
  ivec2 corner = cell * parts;
  ivec2 from = max(ivec2(floor(placed.low * float(parts) - 0.02)), corner);
  ivec2 to = min(ivec2(floor(placed.high * float(parts) + 0.02)), corner + parts - 1);
  ivec2 part = from;
  for (int i = (to.x - from.x + 1) * (to.y - from.y + 1); i > 0; --i) {
    vec2 centre = (vec2(part) + 0.5) * size;
    ivec2 within = part - corner;
    if (overlaps(placed, centre, REACH * size))
      list(primitive, placed, node.z + uint(within.y * parts + within.x), centre, REACH * size);
    part = part.x < to.x ? ivec2(part.x + 1, part.y) : ivec2(from.x, part.y + 1);
  }
}
