// Light whose shadow ray met nothing, or which needs none (TRACED 0): that which is known arrives; the rest is listed, with its source
// in place of the hit, so that it can be sorted by the material that emits it.
#include "path_tracer/arrivals.glsl"

layout(std430, binding = 0) buffer Hits { TracedHit shadow_hits[]; };
#if TRACED && TRANSMITTANCE
layout(std430, binding = 4) readonly buffer Passed { vec4 shadow_passed[]; };
#endif
#if DEFERRED
layout(std430, binding = 5) writeonly buffer Deferred { uint deferred[]; };
layout(std430, binding = 7) buffer Counter { uint deferred_count; };
#endif
layout(location = 0) uniform uint count;

void main() {
  uint i = invocation();
  if (i >= count) return;
  uint index = listed[i];
#if TRACED
  if (shadow_hits[index].primitive != NO_PRIMITIVE) return;
#endif
  Arrival arrival = arrivals[index];
  vec3 light = vec3(arrival.r, arrival.g, arrival.b);
#if TRACED && TRANSMITTANCE
  light *= shadow_passed[index].rgb;
#endif
#if DEFERRED
  if (arrival.source != LIGHT_KNOWN) {
    arrival.r = light.r;
    arrival.g = light.g;
    arrival.b = light.b;
    arrivals[index] = arrival;
    shadow_hits[index].primitive = arrival.source == LIGHT_WORLD ? NO_PRIMITIVE : arrival.source;
    deferred[atomicAdd(deferred_count, 1u)] = index;
    return;
  }
#endif
  arrive(index, light, arrival.scatterings);
}
