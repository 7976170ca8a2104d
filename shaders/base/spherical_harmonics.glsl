// Real spherical harmonics to the second order and irradiance from them (Ramamoorthi and Hanrahan
// 2001). Order: 1; y, z, x; xy, yz, 3z^2 - 1, xz, x^2 - y^2.

float[9] spherical_harmonics(vec3 d) {
  return float[9](0.282094792, 0.488602512 * d.y, 0.488602512 * d.z, 0.488602512 * d.x,
                  1.092548431 * d.x * d.y, 1.092548431 * d.y * d.z,
                  0.315391565 * (3.0 * d.z * d.z - 1.0), 1.092548431 * d.x * d.z,
                  0.546274215 * (d.x * d.x - d.y * d.y));
}

// Harmonics along `axis`, each band times its entry of `bands`: the weights by which coefficients of
// radiance become its convolution with a kernel around that axis.
float[9] banded_harmonics(vec3 axis, vec3 bands) {
  float basis[9] = spherical_harmonics(axis);
  basis[0] *= bands.x;
  for (int k = 1; k < 4; ++k) basis[k] *= bands.y;
  for (int k = 4; k < 9; ++k) basis[k] *= bands.z;
  return basis;
}

// Of the clamped cosine over pi: a white diffuse surface's radiance.
const vec3 DIFFUSE_BANDS = vec3(1.0, 2.0 / 3.0, 0.25);
