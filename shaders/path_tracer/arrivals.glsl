// Light at the end of its shadow ray.
#include "base/invocation.glsl"
#include "path_tracer/path_shared.h"
#include "path_tracer/light_sums.glsl"
#include "path_tracer/lights_shared.h"
#include "tracing/rays_shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 1) buffer Arrivals { Arrival arrivals[]; };
layout(std430, binding = 2) readonly buffer Listed { uint listed[]; };
#if LIGHT_PASSES
layout(std430, binding = 3) readonly buffer Shares { vec4 shares[]; };  // two a path
#endif

void arrive(uint index, vec3 light, uint scatterings) {
#if LIGHT_PASSES
  add_light(index, light, scatterings, shares[index * 2u].rgb, shares[index * 2u + 1u].rgb);
#else
  add_light(index, light, scatterings, vec3(0.0), vec3(0.0));
#endif
}
