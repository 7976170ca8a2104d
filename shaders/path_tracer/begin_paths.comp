// The camera's rays, one path each: through a place in the pixel by the pixel filter's weight, and
// through a place of the lens. With CENTRE: through the pixels' centres and the lens' middle.
#include "base/invocation.glsl"
#include "gpu_scene/view_shared.h"
#include "path_tracer/path_state.glsl"
#include "base/sampling.glsl"
#include "scene/visibility_shared.h"
#include "tracing/rays_shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer Rays { TracedRay rays[]; };
layout(std430, binding = 1) writeonly buffer States { uvec4 new_states[]; };
layout(std430, binding = 2) writeonly buffer Passed { vec4 passed[]; };
layout(std430, binding = 3) writeonly buffer Sums { vec4 sums[]; };
#if LISTED
layout(std430, binding = 4) readonly buffer Pixels { uint pixels[]; };
#endif
#if !CENTRE
// Offsets from the pixel's centre, in filter widths, at equal steps of probability.
layout(binding = 4) uniform samplerBuffer filter_offsets;

float filter_offset(float u) {
  float place = u * float(textureSize(filter_offsets) - 1);
  int step = int(place);
  return frame.clip.z * mix(texelFetch(filter_offsets, step).x,
                            texelFetch(filter_offsets, step + 1).x, place - float(step));
}
#endif

#if LENS
// Concentric map of the square to the unit disk (Shirley and Chiu 1997).
vec2 disk(vec2 u) {
  vec2 a = 2.0 * u - 1.0;
  if (a.x == 0.0 && a.y == 0.0) return vec2(0.0);
  bool wide = abs(a.x) > abs(a.y);
  float radius = wide ? a.x : a.y;
  float angle = wide ? 0.785398163 * a.y / a.x : 1.570796327 - 0.785398163 * a.x / a.y;
  return radius * vec2(cos(angle), sin(angle));
}

// Uniform over a regular polygon in the unit circle, with the middle of an edge on the x axis as in
// Cycles: one of its triangles, folded to the square.
vec2 polygon(vec2 u, float corners) {
  float corner = floor(u.x * corners);
  u.x = u.x * corners - corner;
  float root = sqrt(u.x), half_angle = 3.14159265359 / corners;
  float along = root * cos(half_angle), across = (2.0 * u.y - 1.0) * root * sin(half_angle);
  float angle = 2.0 * corner * half_angle;
  return along * vec2(cos(angle), sin(angle)) + across * vec2(-sin(angle), cos(angle));
}
#endif

void main() {
  uint path = invocation();
  if (path >= frame.range.w) return;
#if LISTED
  uint pixel = pixels[frame.range.z + path];
#else
  uint pixel = frame.range.z + path;
#endif
  uint key = hash(frame.range.y ^ hash(pixel));
  vec2 place = vec2(pixel % frame.size.x, pixel / frame.size.x) + 0.5;
#if !CENTRE
  vec2 u = path_pair(key, frame.range.x, 0u);
  place += vec2(filter_offset(u.x), filter_offset(u.y));
#endif
  vec3 origin = frame.camera.xyz + view.ray_origin.xyz + place.x * view.ray_origin_dx.xyz +
                place.y * view.ray_origin_dy.xyz;
  // One metre along the camera's axis.
  vec3 direction = view.ray_direction.xyz + place.x * view.ray_direction_dx.xyz +
                   place.y * view.ray_direction_dy.xyz;
#if LENS && !CENTRE
  vec2 v = path_pair(key, frame.range.x, 1u);
  vec2 aperture = frame.lens_y.w < 3.0 ? disk(v) : polygon(v, frame.lens_y.w);
  vec3 offset = aperture.x * frame.lens_x.xyz + aperture.y * frame.lens_y.xyz;
  origin += offset;
  direction -= offset / frame.lens_x.w;
#endif
  float stretch = length(direction);
  direction /= stretch;
  rays[path] = TracedRay(origin.x, origin.y, origin.z, frame.clip.x * stretch, direction.x,
                         direction.y, direction.z, frame.clip.y * stretch, NO_PRIMITIVE,
                         SEEN_BY_CAMERA, hash(key ^ hash(frame.range.x)), pixel);
  new_states[path * uint(STATE_TEXELS)] = uvec4(floatBitsToUint(vec3(1.0)), 0u);
  new_states[path * uint(STATE_TEXELS) + 1u] = uvec4(floatBitsToUint(1.0e30), 0u, 0u, 0u);
#if LIGHT_PASSES
  new_states[path * uint(STATE_TEXELS) + 2u] = new_states[path * uint(STATE_TEXELS) + 3u] = uvec4(0u);
#endif
  passed[path] = vec4(1.0, 1.0, 1.0, 0.0);
  sums[path * uint(PASSES)] = vec4(0.0, 0.0, 0.0, 1.0);
  for (int pass = 1; pass < PASSES; ++pass) sums[path * uint(PASSES) + uint(pass)] = vec4(0.0);
}
