// The world's mean radiance in each texel of a map of directions: latitudes from +Z down, longitudes
// from +X on.
#include "base/invocation.glsl"
#include "gpu_scene/world.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer Radiance { vec4 radiance[]; };
layout(location = 1) uniform ivec3 extent;  // texels; points along each side of a texel

const float PI = 3.14159265359;

void main() {
  int texel = int(invocation());
  if (texel >= extent.x * extent.y) return;
  vec2 corner = vec2(texel % extent.x, texel / extent.x);
  vec4 sum = vec4(0.0);
  for (int i = 0; i < extent.z * extent.z; ++i) {
    vec2 point = corner + (vec2(i % extent.z, i / extent.z) + 0.5) / float(extent.z);
    vec2 angles = point / vec2(extent.xy) * vec2(2.0 * PI, PI);
    vec3 direction = vec3(sin(angles.y) * vec2(cos(angles.x), sin(angles.x)), cos(angles.y));
    // Points of a texel lie closer to each other the nearer they are to a pole.
    sum += vec4(finite_world(direction), 1.0) * sin(angles.y);
  }
  radiance[texel] = vec4(sum.rgb / sum.w, 0.0);
}
