// Paths that have met nothing: the world's light, and that of lamps before it.
#define STATE_UNIT 7
// What others include too comes before what may not be compiled.
#include "base/color.glsl"
#include "base/fresnel.glsl"
#include "base/invocation.glsl"
#include "path_tracer/path_state.glsl"
#include "path_tracer/light_sums.glsl"
#include "tracing/rays_shared.h"
#if WORLD
#include "gpu_scene/world.glsl"
#endif
#if LIGHTS
#include "path_tracer/lights.glsl"
#endif

layout(local_size_x = 64) in;
layout(binding = 5) uniform samplerBuffer rays;  // as TracedRay
layout(std430, binding = 0) readonly buffer Sorted { uint sorted[]; };
layout(std430, binding = 1) readonly buffer PassedIn { vec4 passed[]; };
layout(location = 1) uniform uvec2 range;  // of `sorted`: first, count

void main() {
  uint i = invocation();
  if (i >= range.y) return;
  uint index = sorted[range.x + i];
  Path path = fetch_path(index);
  path.throughput *= passed[index].rgb;
  uint scatterings = turns_of_all(path.turns);
  vec3 origin = texelFetch(rays, int(index) * 3).xyz;
  vec3 direction = texelFetch(rays, int(index) * 3 + 1).xyz;
  vec3 shining = vec3(0.0);
#if WORLD
  shining = finite_world(direction);
#ifdef PASS_ENV
  if (scatterings == 0u) set_pass(index, PASS_ENV, path.throughput * shining);
#endif
#if LIGHTS
  if (path.scattering_pdf > 0.0)
    shining *= power_heuristic(path.scattering_pdf, light_pdf_world(origin, path.normal, direction));
#endif
#endif
#if LAMPS_SEEN
  if (scatterings > 0u)
    shining += lamps_seen(origin, path.normal, direction, FAR, path.scattering_pdf);
#endif
#if TRANSPARENT_FILM
  if (scatterings == 0u) {
    sums[index * uint(PASSES)] = vec4(0.0);
    return;
  }
#endif
#if LIGHT_PASSES
  add_light(index, path.throughput * shining, scatterings, path.diffuse_share, path.glossy_share);
#else
  add_light(index, path.throughput * shining, scatterings, vec3(0.0), vec3(0.0));
#endif
}
