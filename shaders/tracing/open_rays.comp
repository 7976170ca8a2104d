// Lists the rays that opaque surfaces have not stopped; what passes starts with 1 there, and is 0
// for the others.
#include "base/invocation.glsl"
#include "tracing/rays_shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Hits { TracedHit hits[]; };
layout(std430, binding = 2) buffer Counter { uint open_count; };
#if LISTED
layout(std430, binding = 3) readonly buffer Listed { uint listed[]; };
#endif
layout(std430, binding = 4) writeonly buffer Open { uint open_rays[]; };
#if TRANSMITTANCE
layout(std430, binding = 6) buffer Passed { vec4 passed[]; };
#endif
layout(location = 1) uniform uint count;

void main() {
  uint slot = invocation();
  if (slot >= count) return;
#if LISTED
  uint ray = listed[slot];
#else
  uint ray = slot;
#endif
  bool open = hits[ray].primitive == NO_PRIMITIVE;
#if TRANSMITTANCE
  passed[ray].rgb = vec3(open ? 1.0 : 0.0);
#endif
  if (open) open_rays[atomicAdd(open_count, 1u)] = ray;
}
