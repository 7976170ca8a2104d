// The depth pass: metres along the camera's axis, from one rasterisation; depth is not filtered.
// Taken from the triangle, not from the depth buffer, which holds what snapped vertices span.
#include "gpu_scene/geometry.glsl"
#include "rasterize/bins.glsl"
#include "film/film.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 7) uniform usampler2D visibility;

const float NOTHING = 1.0e10;  // Blender's value for the background

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, view.size.xy))) return;
  uvec2 visible = texelFetch(visibility, pixel, 0).xy;
  float metres = NOTHING;
  if (visible.x != 0u) {
    Hit hit = fetch_hit(view_ray(vec2(pixel) + 0.5), records[visible.x - 1u].instance, visible.y);
    metres = dot(hit.position, view.axis.xyz);
  }
  film_add(FILM_DEPTH, pixel, vec4(metres));
}
