// A triangle at a pixel's centre.
#define BOUND 0   // notes the pixel's depth bounds
#define NEAREST 1 // notes the depths of the nearest fragments
#define STORE 2   // stores the fragment, for fragment_tracer/scatter.comp to bring to its list
#include "fragment_tracer/views.glsl"

layout(location = 0) uniform int view;
layout(location = 1) uniform uint capacity;
layout(location = 2) uniform uint layers;  // with NEAREST, or KEEP: that a pixel keeps
layout(location = 4) uniform uint most;    // that are counted: more cannot be held whatever their number
flat in uint primitive;
in vec2 barycentrics;

layout(std430, binding = 0) buffer Counters { FragmentCounters counters; };
layout(std430, binding = 1) buffer Bounds { uint bounds[]; };  // bits of the least and the greatest depth
#if PASS == NEAREST || KEEP
layout(std430, binding = 2) buffer Nearest { uint nearest[]; };  // of pixels: bits of depths, in their order
#endif
#if PASS == STORE
layout(std430, binding = 3) writeonly buffer Entries { FragmentEntry entries[]; };
layout(std430, binding = 4) buffer Counts { uint counts[]; };  // of lists
layout(std430, binding = 5) writeonly buffer Data { uint data[]; };
#endif

void main() {
  float depth = 1.0 / gl_FragCoord.w;
  uint bits = floatBitsToUint(depth);  // those of positive floats are ordered as these
  uint pixel = pixel_number(view, ivec2(gl_FragCoord.xy));
#if PASS == NEAREST
  // Each place keeps the lesser of what it has and what comes, and the greater goes on to the next.
  uint first = pixel * layers, end = first + layers;
  if (bits >= nearest[end - 1u]) return;
  for (uint i = first; i < end && bits != NO_FRAGMENT; ++i) bits = max(bits, atomicMin(nearest[i], bits));
#else
#if PASS == STORE && KEEP
  if (bits > nearest[pixel * layers + layers - 1u]) return;
#endif
#if PASS == BOUND || !BUCKETS
  atomicMin(bounds[2u * pixel], bits);
  atomicMax(bounds[2u * pixel + 1u], bits);
#endif
#if PASS == STORE
#if BUCKETS
  vec2 range = uintBitsToFloat(uvec2(bounds[2u * pixel], bounds[2u * pixel + 1u]));
  uint list = pixel * uint(BUCKETS) + bucket_of(depth, range);
#else
  uint list = pixel;
#endif
  if (counters.fragments >= most) return;
  uint place = atomicAdd(counters.fragments, 1u);
  if (place >= capacity) return;  // counted all the same: the host makes room and starts again
  entries[place] = FragmentEntry(depth, list, atomicAdd(counts[list], 1u), primitive);
  // Where a triangle comes near the eye, rounding takes them out of it.
  float b1 = clamp(barycentrics.x, 0.0, 1.0), b2 = clamp(barycentrics.y, 0.0, 1.0 - b1);
  data[3u * place] = primitive;
  data[3u * place + 1u] = floatBitsToUint(b1);
  data[3u * place + 2u] = floatBitsToUint(b2);
#endif
#endif
}
