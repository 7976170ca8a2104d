// The world's light on surfaces that nothing shades, from harmonics of its radiance.
#include "base/spherical_harmonics.glsl"

layout(std140, binding = 1) uniform WorldBlock { vec4 world[9]; };

// Irradiance on a plane that faces `n`, divided by pi: what a white diffuse surface sends back.
vec3 world_diffuse(vec3 n) {
  const float band[3] = float[3](1.0, 2.0 / 3.0, 0.25);
  float basis[9] = spherical_harmonics(n);
  vec3 sum = vec3(0.0);
  for (int k = 0; k < 9; ++k)
    sum += world[k].rgb * basis[k] * band[k == 0 ? 0 : (k < 4 ? 1 : 2)];
  return max(sum, vec3(0.0));
}
