// Real spherical harmonics to the second order and irradiance from them (Ramamoorthi and Hanrahan
// 2001). Order: 1; y, z, x; xy, yz, 3z^2 - 1, xz, x^2 - y^2.

float[9] spherical_harmonics(vec3 d) {
  return float[9](0.282094792, 0.488602512 * d.y, 0.488602512 * d.z, 0.488602512 * d.x,
                  1.092548431 * d.x * d.y, 1.092548431 * d.y * d.z,
                  0.315391565 * (3.0 * d.z * d.z - 1.0), 1.092548431 * d.x * d.z,
                  0.546274215 * (d.x * d.x - d.y * d.y));
}
