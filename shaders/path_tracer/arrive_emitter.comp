// Light from glowing surfaces of one material, whose emission varies, at the end of shadow rays.
#include "gpu_scene/material.glsl"
#include "generated/material.glsl"
#include "path_tracer/arrivals.glsl"
#include "tracing/met_surface.glsl"

layout(std430, binding = 0) readonly buffer Rays { TracedRay shadow_rays[]; };
layout(location = 1) uniform uvec2 range;  // of `listed`: first, count

void main() {
  uint i = invocation();
  if (i >= range.y) return;
  uint index = listed[range.x + i];
  Arrival arrival = arrivals[index];
  Surface surface = empty_surface();
  evaluate_material(met_hit(shadow_rays[index], arrival.source), surface);
  arrive(index, vec3(arrival.r, arrival.g, arrival.b) * finite(surface.emission), arrival.scatterings);
}
