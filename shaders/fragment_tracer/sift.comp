// Which views see a triangle, so that each draws no others: a number of triangles for each invocation. WRITE 0: notes
// the views of each triangle and counts; 1: writes the lists, in any order, since fragments are sorted.
#include "base/invocation.glsl"
#include "fragment_tracer/views.glsl"
#include "tracing/triangles.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Seen { uint seen[]; };      // of triangles: a bit for each view
layout(std430, binding = 1) buffer Counts { uint counts[]; };  // of views; with WRITE: where the rest of its list begins
#if WRITE
layout(std430, binding = 2) writeonly buffer Sifted { uint sifted[]; };
#endif
layout(location = 0) uniform uint count;  // triangles

// Further than this beside a pixel's centre, in pixels, no rasteriser's rounding finds it inside.
const float ROUNDING = 1.0 / 64.0;
// Where depths are not this share of the distance, places in the view are too inexact to leave anything out by them.
const float SHALLOW = 0.1;

bool sees(int view, Corners corners) {
  vec3 centre = block.centre.xyz;
  vec3 a = to_pixels(corners.p0 - centre, view), b = to_pixels(corners.p1 - centre, view),
       c = to_pixels(corners.p2 - centre, view);
  vec2 size = vec2(block.views[view].size.xy);
  // Beside one of the view's sides.
  vec2 low = max(max(a.xy, b.xy), c.xy);
  vec2 high = max(max(size * a.z - a.xy, size * b.z - b.xy), size * c.z - c.xy);
  if (any(lessThan(low, vec2(0.0))) || any(lessThan(high, vec2(0.0)))) return false;
  vec3 away = vec3(length(corners.p0 - centre), length(corners.p1 - centre), length(corners.p2 - centre));
  vec3 depths = vec3(a.z, b.z, c.z);
  if (any(lessThanEqual(depths, SHALLOW * away))) return true;
  // No pixel's centre in the box about it.
  vec2 pa = a.xy / a.z, pb = b.xy / b.z, pc = c.xy / c.z;
  vec2 first = ceil(min(min(pa, pb), pc) - 0.5 - ROUNDING), last = floor(max(max(pa, pb), pc) - 0.5 + ROUNDING);
  return all(lessThanEqual(first, last));
}

void main() {
  uint begin = invocation() * SIFTED_AT_ONCE, end = min(begin + SIFTED_AT_ONCE, count);
  if (begin >= count) return;
  uint found[VIEWS];
  for (int view = 0; view < VIEWS; ++view) found[view] = 0u;
  for (uint i = begin; i < end; ++i) {
#if WRITE
    uint bits = seen[i];
#else
    Corners corners = fetch_corners(i);
    uint bits = 0u;
    if ((corners.flags & TRIANGLE_SEEN_BY) != 0u)
      for (int view = 0; view < VIEWS; ++view) bits |= sees(view, corners) ? 1u << view : 0u;
    seen[i] = bits;
#endif
    for (int view = 0; view < VIEWS; ++view) found[view] += bits >> view & 1u;
  }
  for (int view = 0; view < VIEWS; ++view)
    if (found[view] > 0u) found[view] = atomicAdd(counts[view], found[view]);
#if WRITE
  for (uint i = begin; i < end; ++i)
    for (int view = 0; view < VIEWS; ++view)
      if ((seen[i] >> view & 1u) != 0u) sifted[found[view]++] = i;
#endif
}
