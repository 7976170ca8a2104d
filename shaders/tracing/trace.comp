// Traces a batch of rays, those of it that a list names (LISTED), or those that were not through yet
// (RESUMED).
#include "base/invocation.glsl"
#include "tracing/intersect.glsl"

layout(local_size_x = 64) in;
layout(binding = 6) uniform samplerBuffer rays;  // as TracedRay
layout(std430, binding = 0) buffer Hits { TracedHit hits[]; };
// Of the rays that are not through: number, hit, traversal.
layout(std430, binding = 1) writeonly buffer PendingOut { uint pending_out[]; };
layout(std430, binding = 2) buffer Counter { uint pending_count; };
#if RESUMED
layout(std430, binding = 3) readonly buffer PendingIn { uint pending_in[]; };
#elif LISTED
layout(std430, binding = 3) readonly buffer Listed { uint listed[]; };
#endif
#if COUNT_WORK
layout(std430, binding = 4) buffer Work { TracedWork all_work[]; };
#endif
layout(location = 0) uniform uint count;     // rays to trace here
layout(location = 1) uniform uint capacity;  // of pending_out, in rays
layout(location = 2) uniform int budget;

void put_word(uint word, uint value) { pending_out[word] = value; }
#if RESUMED
uint get_word(uint word) { return pending_in[word]; }
#endif

#include "generated/tracer.glsl"

const uint SAVED_WORDS = 5u + TRAVERSAL_WORDS;

Ray fetch_ray(uint i) {
  vec4 texel0 = texelFetch(rays, int(i) * 3), texel1 = texelFetch(rays, int(i) * 3 + 1);
  uvec4 texel2 = floatBitsToUint(texelFetch(rays, int(i) * 3 + 2));
  return make_ray(texel0.xyz, texel0.w, texel1.xyz, texel1.w, texel2.x, texel2.y, texel2.z);
}

void main() {
  uint slot = spread_invocation(1u);
  if (slot >= count) return;
#if RESUMED
  uint word = slot * SAVED_WORDS;
  uint index = get_word(word);
  Ray ray = fetch_ray(index);
  TracedHit hit = TracedHit(uintBitsToFloat(get_word(word + 1u)), get_word(word + 2u),
                            uintBitsToFloat(get_word(word + 3u)),
                            uintBitsToFloat(get_word(word + 4u)));
  Traversal at = traversal_load(ray, word + 5u);
#else
#if LISTED
  uint index = listed[slot];
#else
  uint index = slot;
#endif
  Ray ray = fetch_ray(index);
  TracedHit hit = TracedHit(ray.t_max, NO_PRIMITIVE, 0.0, 0.0);
  Traversal at = traversal_begin(ray);
#endif
  bool through = traverse(ray, at, hit, budget);
#if COUNT_WORK
#if RESUMED || LISTED
  work.steps += all_work[index].steps;
  work.tests += all_work[index].tests;
  if (work.longest == 0u) work.cell = all_work[index].cell;
  work.longest = max(work.longest, all_work[index].longest);
#endif
  all_work[index] = work;
#endif
  if (through) {
    hits[index] = hit;
    return;
  }
  uint place = atomicAdd(pending_count, 1u);
  if (place >= capacity) return;  // counted all the same: the host makes room and starts again
  uint to = place * SAVED_WORDS;
  put_word(to, index);
  put_word(to + 1u, floatBitsToUint(hit.t));
  put_word(to + 2u, hit.primitive);
  put_word(to + 3u, floatBitsToUint(hit.u));
  put_word(to + 4u, floatBitsToUint(hit.v));
  traversal_save(at, to + 5u);
}
