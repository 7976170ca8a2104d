// The triangles that a view sees.
#include "fragment_tracer/views.glsl"
#include "tracing/triangles.glsl"

layout(binding = 1) uniform usamplerBuffer sifted;  // triangles, view by view
layout(location = 0) uniform int view;
layout(location = 3) uniform int first;  // of the view
flat out uint primitive;
out vec2 barycentrics;  // of the second and third vertex

void main() {
  primitive = texelFetch(sifted, first + gl_VertexID / 3).x;
  int corner = gl_VertexID % 3;
  Corners corners = fetch_corners(primitive);
  vec3 position = corner == 0 ? corners.p0 : corner == 1 ? corners.p1 : corners.p2;
  barycentrics = vec2(corner == 1, corner == 2);
  vec3 place = to_pixels(position - block.centre.xyz, view);
  vec2 size = vec2(block.views[view].size.xy);
  // In the middle of the clip range: what lies behind the eye is left out by the sides of the view alone.
  gl_Position = vec4(place.xy / size * 2.0 - place.zz, 0.0, place.z);
}
