// The boxes about runs of triangles that follow each other in the list.
#include "base/invocation.glsl"
#include "fragment_tracer/views.glsl"
#include "tracing/triangles.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer Boxes { vec4 boxes[]; };  // low and high corner; w of low: 1 if it holds any
layout(location = 0) uniform uint count;  // triangles
layout(location = 1) uniform float width;  // of the widest pixel, at a depth of one metre

// By how much boxes are larger, so that no rounding of the rasteriser leaves a triangle's pixel without its box: parts
// of their size, and of a pixel.
const float LARGER = 1.0e-4, PIXELS = 1.0 / 32.0;

void main() {
  uint box = invocation(), begin = box * TRIANGLES_OF_BOX, end = min(begin + TRIANGLES_OF_BOX, count);
  if (begin >= count) return;
  vec3 low = vec3(1.0e30), high = vec3(-1.0e30);
  bool any_seen = false;
  for (uint i = begin; i < end; ++i) {
    Corners corners = fetch_corners(i);
    if ((corners.flags & TRIANGLE_SEEN_BY) == 0u) continue;
    any_seen = true;
    low = min(low, min(corners.p0, min(corners.p1, corners.p2)));
    high = max(high, max(corners.p0, max(corners.p1, corners.p2)));
  }
  vec3 far = max(abs(low - block.centre.xyz), abs(high - block.centre.xyz));
  float margin = any_seen ? LARGER * length(high - low) + PIXELS * width * length(far) : 0.0;
  boxes[2u * box] = vec4(low - margin, any_seen ? 1.0 : 0.0);
  boxes[2u * box + 1u] = vec4(high + margin, 0.0);
}
