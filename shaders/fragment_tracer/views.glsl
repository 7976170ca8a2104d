// The views, for the programs that build and those that trace.
#include "fragment_tracer/views_shared.h"

layout(std140, binding = 2) uniform FragmentBlock { FragmentViews block; };

// A vector, or a position relative to the centre, in a view's homogeneous pixels.
vec3 to_pixels(vec3 v, int view) {
  return vec3(dot(block.views[view].x.xyz, v), dot(block.views[view].y.xyz, v), dot(block.views[view].z.xyz, v));
}

uint pixel_number(int view, ivec2 pixel) {
  ivec4 size = block.views[view].size;
  return uint(size.z + pixel.y * size.x + pixel.x);
}

#if BUCKETS
// Uniform intervals of a pixel's depths (section 6.2.2): the farthest in the last one, and a pixel of a single depth in
// the first.
uint bucket_of(float depth, vec2 bounds) {
  float range = bounds.y - bounds.x;
  float place = range > 0.0 ? (depth - bounds.x) / range * float(BUCKETS) : 0.0;
  return uint(clamp(place, 0.0, float(BUCKETS - 1)));
}
#endif
