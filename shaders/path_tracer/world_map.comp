// The world's brightness times solid angle in each texel of a map of directions (world_map.glsl).
#include "base/invocation.glsl"
#include "gpu_scene/world.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer Brightness { float brightness[]; };
layout(location = 1) uniform ivec3 extent;  // texels; points along each side of a texel

const float PI = 3.14159265359;

void main() {
  int texel = int(invocation());
  if (texel >= extent.x * extent.y) return;
  vec2 corner = vec2(texel % extent.x, texel / extent.x);
  int points = extent.z;
  float sum = 0.0;
  for (int i = 0; i < points * points; ++i) {
    vec2 place = (corner + (vec2(i % points, i / points) + 0.5) / float(points)) / vec2(extent.xy);
    float phi = 2.0 * PI * place.x, theta = PI * place.y;
    vec3 direction = vec3(sin(theta) * vec2(cos(phi), sin(phi)), cos(theta));
    sum += luminance(abs(finite_world(direction))) * sin(theta);
  }
  // The texel's solid angle is about 2 pi^2 sin(theta) / texels, and all of them are 4 pi.
  brightness[texel] = sum * 2.0 * PI * PI / float(points * points * extent.x * extent.y);
}
