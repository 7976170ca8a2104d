// The list's triangles in one view.
#include "fragment_tracer/views.glsl"
#include "tracing/triangles.glsl"

layout(location = 0) uniform int view;
flat out uint primitive;
out vec2 barycentrics;  // of the second and third vertex

void main() {
  primitive = uint(gl_VertexID) / 3u;
  int corner = gl_VertexID % 3;
  Corners corners = fetch_corners(primitive);
  vec3 position = corner == 0 ? corners.p0 : corner == 1 ? corners.p1 : corners.p2;
  barycentrics = vec2(corner == 1, corner == 2);
  vec3 place = to_pixels(position - block.centre.xyz, view);
  vec2 size = vec2(block.views[view].size.xy);
  // In the middle of the clip range: what lies behind the eye is left out by the sides of the view alone.
  gl_Position = vec4(place.xy / size * 2.0 - place.zz, 0.0, place.z);
  // A triangle that nobody sees has no fragments.
  if ((corners.flags & TRIANGLE_SEEN_BY) == 0u) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}
