// What the middles of pixels show: depth along the camera's axis and position, in the first sample's
// stead, since averages of either mean nothing.
#include "base/invocation.glsl"
#include "gpu_scene/view_shared.h"
#include "path_tracer/path_shared.h"
#include "tracing/rays_shared.h"
#include "film/film.glsl"

layout(local_size_x = 64) in;
layout(binding = 5) uniform samplerBuffer rays;   // as TracedRay
layout(binding = 6) uniform usamplerBuffer hits;  // as TracedHit

const float NOTHING = 1.0e10;  // Blender's depth of the background

void main() {
  uint path = invocation();
  if (path >= frame.range.w) return;
  vec4 ray0 = texelFetch(rays, int(path) * 3);
  vec3 direction = texelFetch(rays, int(path) * 3 + 1).xyz;
  uint number = floatBitsToUint(texelFetch(rays, int(path) * 3 + 2).w);
  ivec2 pixel = ivec2(number % frame.size.x, number / frame.size.x);
  uvec4 hit = texelFetch(hits, int(path));
  // From the camera on: its own coordinates may be large.
  vec3 place = ray0.xyz - frame.camera.xyz + uintBitsToFloat(hit.x) * direction;
  bool met = hit.y != NO_PRIMITIVE;
#ifdef FILM_DEPTH
  film_add(FILM_DEPTH, pixel, vec4(met ? dot(place, view.axis.xyz) : NOTHING));
#endif
#ifdef FILM_POSITION
  film_add(FILM_POSITION, pixel, vec4(met ? place + view.world_origin.xyz : vec3(0.0), 0.0));
#endif
}
