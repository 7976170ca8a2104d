// A triangle at a pixel's centre. STORE 0: notes the pixel's depth bounds; 1: stores the fragment, for
// fragment_tracer/scatter.comp to bring to its list.
#include "fragment_tracer/views.glsl"

layout(location = 0) uniform int view;
layout(location = 1) uniform uint capacity;
flat in uint primitive;
in vec2 barycentrics;

layout(std430, binding = 0) buffer Counters { FragmentCounters counters; };
layout(std430, binding = 1) buffer Bounds { uint bounds[]; };  // bits of the least and the greatest depth
#if STORE
layout(std430, binding = 3) writeonly buffer Entries { FragmentEntry entries[]; };
layout(std430, binding = 4) buffer Counts { uint counts[]; };  // of lists
layout(std430, binding = 5) writeonly buffer Data { uint data[]; };
#endif

void main() {
  float depth = 1.0 / gl_FragCoord.w;
  uint pixel = pixel_number(view, ivec2(gl_FragCoord.xy));
#if !STORE || !BUCKETS
  // Bits of positive floats are ordered as these.
  atomicMin(bounds[2u * pixel], floatBitsToUint(depth));
  atomicMax(bounds[2u * pixel + 1u], floatBitsToUint(depth));
#endif
#if STORE
#if BUCKETS
  vec2 range = uintBitsToFloat(uvec2(bounds[2u * pixel], bounds[2u * pixel + 1u]));
  uint list = pixel * uint(BUCKETS) + bucket_of(depth, range);
#else
  uint list = pixel;
#endif
  uint place = atomicAdd(counters.fragments, 1u);
  if (place >= capacity) return;  // counted all the same: the host makes room and starts again
  entries[place] = FragmentEntry(depth, list, atomicAdd(counts[list], 1u), primitive);
  data[3u * place] = primitive;
  data[3u * place + 1u] = floatBitsToUint(barycentrics.x);
  data[3u * place + 2u] = floatBitsToUint(barycentrics.y);
#endif
}
