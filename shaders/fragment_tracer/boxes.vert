// Boxes in one view, twelve triangles each.
#include "fragment_tracer/views.glsl"

layout(binding = 0) uniform samplerBuffer boxes;
layout(location = 0) uniform int view;
flat out uint holds_eye;

// Corners of the sides' triangles; bits x, y, z of a corner's number choose the high end.
const int CORNERS[36] = int[](0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6,
                              1, 3, 5, 3, 7, 5);

void main() {
  int box = gl_VertexID / 36, corner = CORNERS[gl_VertexID % 36];
  vec4 low = texelFetch(boxes, 2 * box);
  vec3 high = texelFetch(boxes, 2 * box + 1).xyz, centre = block.centre.xyz;
  holds_eye = all(lessThanEqual(low.xyz, centre)) && all(lessThanEqual(centre, high)) ? 1u : 0u;
  bvec3 upper = bvec3((corner & 1) != 0, (corner & 2) != 0, (corner & 4) != 0);
  vec3 place = to_pixels(mix(low.xyz, high, upper) - centre, view);
  gl_Position = vec4(place.xy / vec2(block.views[view].size.xy) * 2.0 - place.zz, 0.0, place.z);
  if (low.w == 0.0) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}
