// Sends a triangle into every view that may see it, as a shape whose tiles cube_raster.frag chooses
// from: with CONSERVATIVE the triangle itself, a little larger, since hardware then visits each
// tile that it touches; else, and where the larger triangle has no corners, its rectangle of tiles.
#define GEOMETRY_STAGE
#include "primitive_tracer/cube_raster.glsl"

layout(points, invocations = VIEWS) in;
layout(triangle_strip, max_vertices = 4) out;
flat in uint vertex_primitive[];
flat out uint raster_primitive;

void send(vec3 place) {  // in homogeneous tiles
  raster_primitive = vertex_primitive[0];
  gl_Layer = gl_InvocationID;
  gl_Position = vec4(place.xy * (2.0 / float(cube.grid.x)) - place.zz, 0.0, place.z);
  EmitVertex();
}

void main() {
  uint primitive = vertex_primitive[0], view = uint(gl_InvocationID);
  Placed placed;
  ivec4 cells;
  if ((views_of(primitive) & 1u << view) == 0u || !place(primitive, view, placed, cells)) return;

#if CONSERVATIVE
  // Each edge's plane moved out by the margin; corners lie where two of them meet.
  vec3 edge0 = placed.edge0, edge1 = placed.edge1, edge2 = placed.edge2;
  const float margin = REACH - 0.5;
  edge0.z += margin * (abs(edge0.x) + abs(edge0.y)) + placed.slack.x;
  edge1.z += margin * (abs(edge1.x) + abs(edge1.y)) + placed.slack.y;
  edge2.z += margin * (abs(edge2.x) + abs(edge2.y)) + placed.slack.z;
  vec3 corner0 = cross(edge2, edge0), corner1 = cross(edge0, edge1), corner2 = cross(edge1, edge2);
  if (!placed.edge_on && placed.nearest > 0.0 && min(corner0.z, min(corner1.z, corner2.z)) > 0.0) {
    send(corner0);
    send(corner1);
    send(corner2);
    EndPrimitive();
    return;
  }
#endif
  vec2 low = vec2(cells.xy), high = vec2(cells.zw + 1);
  send(vec3(low, 1.0));
  send(vec3(high.x, low.y, 1.0));
  send(vec3(low.x, high.y, 1.0));
  send(vec3(high, 1.0));
  EndPrimitive();
}
