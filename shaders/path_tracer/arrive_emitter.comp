// Light from glowing surfaces of one material, whose emission varies, at the end of shadow rays.
#include "gpu_scene/material.glsl"
#include "generated/material.glsl"
#include "path_tracer/arrivals.glsl"

layout(binding = 7) uniform samplerBuffer triangles;  // as TracedTriangle
layout(std430, binding = 0) readonly buffer Rays { TracedRay shadow_rays[]; };
layout(location = 1) uniform uvec2 range;  // of `listed`: first, count

void main() {
  uint i = invocation();
  if (i >= range.y) return;
  uint index = listed[range.x + i];
  Arrival arrival = arrivals[index];
  TracedRay traced = shadow_rays[index];
  Ray ray;
  ray.origin = vec3(traced.origin_x, traced.origin_y, traced.origin_z);
  ray.direction = vec3(traced.direction_x, traced.direction_y, traced.direction_z);
  int texel = int(arrival.source) * 3;
  Surface surface = empty_surface();
  evaluate_material(fetch_hit(ray, floatBitsToUint(texelFetch(triangles, texel).w),
                              floatBitsToUint(texelFetch(triangles, texel + 1).w)),
                    surface);
  arrive(index, vec3(arrival.r, arrival.g, arrival.b) * finite(surface.emission), arrival.scatterings);
}
