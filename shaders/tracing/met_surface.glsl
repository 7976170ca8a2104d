// For programs of materials: where a ray has met a triangle. After gpu_scene/material.glsl; positions
// are about the list of triangles' origin, which has to be the view's.
#include "tracing/rays_shared.h"

layout(binding = 7) uniform samplerBuffer triangles;  // as TracedTriangle

Hit met_hit(TracedRay traced, uint primitive) {
  Ray ray;
  ray.origin = vec3(traced.origin_x, traced.origin_y, traced.origin_z);
  ray.direction = vec3(traced.direction_x, traced.direction_y, traced.direction_z);
  int texel = int(primitive) * 3;
  return fetch_hit(ray, floatBitsToUint(texelFetch(triangles, texel).w),
                   floatBitsToUint(texelFetch(triangles, texel + 1).w));
}
