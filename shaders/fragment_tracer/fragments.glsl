// The lists of a pixel, and what it takes to be hit (thesis, section 6.2.3, Figure 6.5).
#include "fragment_tracer/layout.glsl"

layout(binding = 1) uniform usamplerBuffer pixels;
layout(binding = 2) uniform usamplerBuffer nodes;
layout(binding = 3) uniform usamplerBuffer data;  // of fragments: primitive, barycentrics

uint pixel_word(uint pixel, int word) { return texelFetch(pixels, int(pixel) * PIXEL_WORDS + word).x; }
uint node_word(uint node, int word) { return texelFetch(nodes, int(node) * NODE_WORDS + word).x; }
float node_depth(uint node) { return uintBitsToFloat(node_word(node, 0)); }

// Lists are walked from the ray's side; those without links to the previous node only from the eye's.
bool walks_forward(Traversal at) { return LINKS == 1 || at.slope.z >= 0.0; }

// The depths of the ray in the cell.
vec2 ray_depths(Traversal at) {
  float a = at.start.z + at.cell_start * at.slope.z, b = at.start.z + at.cell_end * at.slope.z;
  return vec2(min(a, b), max(a, b));
}

// By the plane: how much deeper a surface may be than its fragment elsewhere in the pixel, in widths of a pixel: as much
// as one that the eye sees at 5 degrees.
const float STEEPEST = 8.0;

// The depths of fragments that may be hit: a surface goes on behind its fragment for its thickness, and by its own plane
// it may be hit before and behind.
vec2 hit_depths(Traversal at, vec2 depths) {
#if BY_PLANE
  float factor = 1.0 + max(block.limits.x, STEEPEST * block.views[at.view].x.w);
  return vec2(depths.x / factor, depths.y * factor);
#else
  return vec2(depths.x / (1.0 + block.limits.x), depths.y);
#endif
}

#if LINKS == 0
// The first of `count` fragments from `first` on that is not nearer than `depth`, or that is farther (`behind`).
uint first_from(uint first, uint count, float depth, bool behind) {
  uint low = first, high = first + count;
  while (low < high) {
    uint middle = (low + high) / 2u;
    float there = node_depth(middle);
    if (there < depth || (behind && there == depth)) low = middle + 1u;
    else high = middle;
  }
  return low;
}
#endif

#if BUCKETS
int bucket_word(Traversal at) { return HEADS_AT + at.bucket + (walks_forward(at) ? 0 : TAILS_AT); }

// The first fragment of the bucket at hand or, where it is empty, of the next that is not.
void find_bucket(inout Traversal at) {
  at.entry = pixel_word(at.pixel, bucket_word(at));
  while (at.entry == NO_FRAGMENT && at.bucket != at.last_bucket) {
    at.bucket += at.last_bucket > at.bucket ? 1 : -1;
    at.entry = pixel_word(at.pixel, bucket_word(at));
  }
}
#endif

// Begins with the fragments of a pixel; by what it knows of their depths, without those that cannot be hit.
void begin_list(inout Traversal at, uint pixel) {
  vec2 wanted = hit_depths(at, ray_depths(at));
  bool forward = at.slope.z >= 0.0;
  at.pixel = pixel;
#if BUCKETS
  uvec2 bits = uvec2(pixel_word(pixel, 0), pixel_word(pixel, 1));
  vec2 bounds = uintBitsToFloat(bits);
  at.listing = bits.x != NO_FRAGMENT;
  int from = 0, to = BUCKETS - 1;
#if SKIPPING
  at.listing = at.listing && wanted.y >= bounds.x && wanted.x <= bounds.y;
  from = int(bucket_of(wanted.x, bounds));
  to = int(bucket_of(wanted.y, bounds));
#endif
  at.bucket = forward ? from : to;
  at.last_bucket = forward ? to : from;
  at.entry = NO_FRAGMENT;
  for (int turn = at.listing ? 0 : 1; turn < 1; ++turn) find_bucket(at);
  at.listing = at.entry != NO_FRAGMENT;
#elif LINKS == 0
  uint first = pixel_word(pixel, 0), count = pixel_word(pixel, 1);
  at.listing = count > 0u;
#if SKIPPING
  for (int turn = at.listing ? 0 : 1; turn < 1; ++turn)
    at.listing = wanted.y >= node_depth(first) && wanted.x <= node_depth(first + count - 1u);
#endif
  uint begin = first, end = first + count;
#if BINARY
  for (int turn = at.listing ? 0 : 1; turn < 1; ++turn) {
    begin = first_from(first, count, wanted.x, false);
    end = first_from(first, count, wanted.y, true);
  }
#endif
  at.left = int(end - begin);
  at.listing = at.listing && at.left > 0;
  at.entry = forward ? begin : end - 1u;
#else
  at.entry = pixel_word(pixel, 0);
  at.listing = at.entry != NO_FRAGMENT;
#if LINKS == 2
  uint last = pixel_word(pixel, TAILS_AT);
#if SKIPPING
  for (int turn = at.listing ? 0 : 1; turn < 1; ++turn)
    at.listing = wanted.y >= node_depth(at.entry) && wanted.x <= node_depth(last);
#endif
  if (!forward) at.entry = last;
#endif
#endif
}

// On to the next fragment of the pixel; `over`: the list at hand has none that is near enough.
void next_fragment(inout Traversal at, bool over) {
#if LINKS == 0
  --at.left;
  at.entry = at.slope.z >= 0.0 ? at.entry + 1u : at.entry - 1u;
  at.listing = at.left > 0 && !over;
#else
  at.entry = over ? NO_FRAGMENT : node_word(at.entry, walks_forward(at) ? 1 : LINKS);
#if BUCKETS
  for (int turn = at.entry == NO_FRAGMENT && at.bucket != at.last_bucket ? 0 : 1; turn < 1; ++turn) {
    at.bucket += at.last_bucket > at.bucket ? 1 : -1;
    find_bucket(at);
  }
#endif
  at.listing = at.entry != NO_FRAGMENT;
#endif
}

struct Data {
  uint primitive;
  vec2 barycentrics;
};

Data fetch_data(uint node) {
#if DECOUPLED
#if LINKS == 0
  node = node_word(node, 1);
#endif
  int word = int(node) * 3;
  return Data(texelFetch(data, word).x,
              uintBitsToFloat(uvec2(texelFetch(data, word + 1).x, texelFetch(data, word + 2).x)));
#else
  return Data(node_word(node, DATA_AT),
              uintBitsToFloat(uvec2(node_word(node, DATA_AT + 1), node_word(node, DATA_AT + 2))));
#endif
}
