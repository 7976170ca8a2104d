// Projects the world's radiance onto the first nine spherical harmonics: each work group adds up a
// part of the sphere's directions (texel centres of an equirectangular map); the host adds groups.
#include "gpu_scene/world.glsl"
#include "base/spherical_harmonics.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 5) writeonly buffer Sums { vec4 sums[]; };  // nine a work group
layout(location = 1) uniform uvec2 extent;           // of the map of directions
layout(location = 2) uniform uint directions_each;   // that one invocation adds up
shared vec3 partial[64];

void main() {
  vec3 coefficients[9];
  for (int k = 0; k < 9; ++k) coefficients[k] = vec3(0.0);
  uint first = gl_GlobalInvocationID.x * directions_each;
  uint end = min(first + directions_each, extent.x * extent.y);
  for (uint i = first; i < end; ++i) {
    float phi = (float(i % extent.x) + 0.5) / float(extent.x) * 6.28318530718;
    float band = 3.14159265359 / float(extent.y);
    float theta = (float(i / extent.x) + 0.5) * band;
    vec3 direction = vec3(sin(theta) * vec2(cos(phi), sin(phi)), cos(theta));
    // The exact solid angle of the texel.
    float weight = 6.28318530718 / float(extent.x) * 2.0 * sin(theta) * sin(0.5 * band);
    vec3 radiance = finite_world(direction) * weight;
    float basis[9] = spherical_harmonics(direction);
    for (int k = 0; k < 9; ++k) coefficients[k] += radiance * basis[k];
  }
  for (int k = 0; k < 9; ++k) {
    partial[gl_LocalInvocationIndex] = coefficients[k];
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
      vec3 sum = vec3(0.0);
      for (int j = 0; j < 64; ++j) sum += partial[j];
      sums[gl_WorkGroupID.x * 9u + uint(k)] = vec4(sum, 0.0);
    }
    barrier();
  }
}
