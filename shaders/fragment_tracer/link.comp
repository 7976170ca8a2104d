// Makes the sorted run of each list what the variant stores: an array, or nodes with links, at the places where the
// fragments arrived; and writes where each pixel's lists begin and end.
#include "fragment_tracer/layout.glsl"
#include "fragment_tracer/lists.glsl"

#if BUCKETS
layout(std430, binding = 1) readonly buffer Bounds { uint bounds[]; };
#endif
layout(std430, binding = 5) readonly buffer Data { uint data[]; };
layout(std430, binding = 7) readonly buffer Sorted { uvec2 sorted[]; };
layout(std430, binding = 8) writeonly buffer Nodes { uint nodes[]; };
layout(std430, binding = 9) writeonly buffer Pixels { uint pixels[]; };
layout(location = 1) uniform uint most;  // fragments that a list keeps

void main() {
  uint i = invocation();
  if (i >= count) return;
  uvec2 mine = sorted[i];
  uint list = entries[mine.y].list, first = firsts[list], kept = min(counts[list], most), place = i - first;
  if (place >= kept) return;
#if LINKS
  uint node = mine.y;
  bool last = place + 1u == kept;
#else
  uint node = i;
#endif
  uint word = node * uint(NODE_WORDS);
  nodes[word] = mine.x;
#if LINKS
  nodes[word + 1u] = last ? NO_FRAGMENT : sorted[i + 1u].y;
#endif
#if LINKS == 2
  nodes[word + 2u] = place == 0u ? NO_FRAGMENT : sorted[i - 1u].y;
#endif
#if DECOUPLED && !LINKS
  nodes[word + 1u] = mine.y;
#elif !DECOUPLED
  for (uint k = 0u; k < 3u; ++k) nodes[word + uint(DATA_AT) + k] = data[3u * mine.y + k];
#endif

#if BUCKETS
  uint pixel = list / uint(BUCKETS), bucket = list % uint(BUCKETS);
  uint at = pixel * uint(PIXEL_WORDS) + uint(HEADS_AT) + bucket;
  if (place == 0u) {
    // Each bucket's first writes the same.
    pixels[pixel * uint(PIXEL_WORDS)] = bounds[2u * pixel];
    pixels[pixel * uint(PIXEL_WORDS) + 1u] = bounds[2u * pixel + 1u];
  }
#else
  uint at = list * uint(PIXEL_WORDS);
#endif
#if LINKS
  if (place == 0u) pixels[at] = node;
#if LINKS == 2
  if (last) pixels[at + uint(TAILS_AT)] = node;
#endif
#else
  if (place == 0u) {
    pixels[at] = first;
    pixels[at + 1u] = kept;
  }
#endif
}
