// One ray from each first surface, by the cosine over its shading normal: what they do not meet nearby
// is the AO pass.
#include "base/invocation.glsl"
#include "base/lobes.glsl"
#include "path_tracer/path_state.glsl"
#include "base/sampling.glsl"
#include "tracing/surface_record.glsl"
#include "scene/visibility_shared.h"
#include "tracing/rays_shared.h"

layout(local_size_x = 64) in;
layout(binding = 5) uniform samplerBuffer rays_in;  // as TracedRay
layout(binding = 8) uniform usamplerBuffer records;
layout(std430, binding = 0) writeonly buffer Rays { TracedRay occlusion_rays[]; };
layout(std430, binding = 1) writeonly buffer Passed { vec4 passed[]; };
layout(std430, binding = 2) writeonly buffer List { uint list[]; };
layout(std430, binding = 3) buffer Counter { uint listed; };
layout(location = 0) uniform uint count;

// The pair of dimensions behind which no path's own numbers lie.
const uint OCCLUSION_PAIR = 0x40000000u;

void main() {
  uint i = invocation();
  if (i >= count) return;
  int record = int(i) * SURFACE_TEXELS;
  uvec4 head0 = texelFetch(records, record), head1 = texelFetch(records, record + 1);
  uint index = head1.x;
  uint pixel = floatBitsToUint(texelFetch(rays_in, int(index) * 3 + 2).w);
  vec3 arriving = texelFetch(rays_in, int(index) * 3 + 1).xyz;
  uvec4 texels[LOBES_TEXELS];
  for (int k = 0; k < LOBES_TEXELS; ++k) texels[k] = texelFetch(records, record + LOBES_AT + k);
  Lobes lobes = unpack_lobes(texels, -arriving);
  vec3 n = lobes_normal(lobes);

  uint key = hash(frame.range.y ^ hash(pixel));
  vec2 u = path_pair(key, frame.range.x, OCCLUSION_PAIR);
  // A point of the sphere on top of the normal is a direction by the cosine.
  float z = 1.0 - 2.0 * u.x, angle = 6.28318530718 * u.y;
  vec3 direction = n + vec3(sqrt(max(1.0 - z * z, 0.0)) * vec2(cos(angle), sin(angle)), z);
  float size = length(direction);
  direction = size > 1.0e-4 ? direction / size : n;
  // Below the surface's own plane nothing is open.
  if (dot(direction, lobes.geometric_normal) <= 0.0) return;
  vec3 origin = uintBitsToFloat(head0.xyz) + uintBitsToFloat(head0.w) * lobes.geometric_normal;
  float reach = frame.clamps.w > 0.0 ? min(frame.clamps.w, frame.camera.w) : frame.camera.w;
  occlusion_rays[index] = TracedRay(origin.x, origin.y, origin.z, 0.0, direction.x, direction.y,
                                    direction.z, reach, NO_PRIMITIVE, SEEN_BY_SHADOW,
                                    hash(key ^ frame.range.x), index);
  passed[index] = vec4(1.0, 1.0, 1.0, 0.0);
  list[atomicAdd(listed, 1u)] = index;
}
