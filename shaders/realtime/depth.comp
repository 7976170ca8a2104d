// The depth pass: metres along the camera's axis, from one rasterisation; depth is not filtered.
#include "gpu_scene/view_shared.h"
#include "film/film.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 7) uniform sampler2D stored_depth;  // reversed: 1 near, 0 where nothing is

const float NOTHING = 1.0e10;  // Blender's value for the background

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, view.size.xy))) return;
  float z = texelFetch(stored_depth, pixel, 0).x;
  float metres = view.filtering.z > 0.5 ? view.depth.y / (z + view.depth.x)
                                        : view.depth.y - z * view.depth.x;
  film_add(FILM_DEPTH, pixel, vec4(z > 0.0 ? metres : NOTHING));
}
