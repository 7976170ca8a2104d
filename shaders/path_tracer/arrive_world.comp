// Light from the world, at the end of shadow rays that nothing has stopped.
#include "gpu_scene/world.glsl"
#include "path_tracer/arrivals.glsl"

layout(std430, binding = 0) readonly buffer Rays { TracedRay shadow_rays[]; };
layout(location = 1) uniform uvec2 range;  // of `listed`: first, count

void main() {
  uint i = invocation();
  if (i >= range.y) return;
  uint index = listed[range.x + i];
  Arrival arrival = arrivals[index];
  TracedRay ray = shadow_rays[index];
  vec3 radiance = finite_world(vec3(ray.direction_x, ray.direction_y, ray.direction_z));
  arrive(index, vec3(arrival.r, arrival.g, arrival.b) * radiance, arrival.scatterings);
}
