// Shares of light that lobes send back.
#include "base/scattering.glsl"

// Share of white light that single-scatter GGX of reflectance 1 reflects: 1 - r^2 p(r, mu), fitted
// by least squares to its quadrature (sampled visible normals, 21 x 21 points); off by at most 6 %.
float ggx_albedo(float r, float mu) {
  vec4 m = vec4(1.0, mu, mu * mu, mu * mu * mu);
  float p2 = dot(m, vec4(4.6127, -19.6597, 21.9707, -6.9309));
  float p3 = dot(m, vec4(-18.1718, 101.7268, -139.5625, 55.7317));
  float p4 = dot(m, vec4(23.6193, -145.9813, 221.1227, -95.4447));
  float p5 = dot(m, vec4(-10.0113, 65.8664, -105.9431, 47.7559));
  return clamp(1.0 - r * r * (p2 + r * (p3 + r * (p4 + r * p5))), 0.0, 1.0);
}

// Share of white light that a rough mirror of reflectance f0 reflects. The part that Fresnel's
// factor takes to grazing angles is Karis' fit (2013).
vec3 environment_reflectance(vec3 f0, vec3 f90, float roughness, float nv) {
  vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
  float a = min(r.x * r.x, exp2(-9.28 * nv)) * r.x + r.y;
  float all = ggx_albedo(roughness, nv);
  float grazing = clamp(1.04 * a + r.w, 0.0, all);
  return f0 * (all - grazing) + f90 * grazing;
}

// The same with masking of both directions apart, by alpha: a fit of E to its quadrature (sampled
// visible normals, 25 x 39 points), off by at most .34 %.
float ggx_separable_albedo(float alpha, float mu) {
  vec4 a = vec4(1.0, alpha, alpha * alpha, alpha * alpha * alpha);
  float q = mu / max(mu + alpha, 1.0e-6);
  float e = dot(a, vec4(-1.9375, -6.6435, 4.4493, -3.3701));
  e = e * q + dot(a, vec4(2.9017, 15.7127, 3.4178, -15.0613));
  e = e * q + dot(a, vec4(-0.3839, -14.6725, -3.175, 16.7594));
  e = e * q + dot(a, vec4(-0.5256, 6.0931, -1.46, -4.3062));
  e = e * q + dot(a, vec4(0.008, -0.7585, -0.4535, 0.6573));
  e = e * q + dot(a, vec4(0.9341, -0.0314, -0.5152, 0.2241));
  return clamp(e, 0.05, 1.0);
}

// Share of white light from everywhere that the sheen sends back: fits to quadrature.
float sheen_albedo(float roughness, float nv) {
  nv = clamp(nv, 0.0, 1.0);
  float x = 1.0 - nv;
  if (roughness < 0.0) return 0.088 * x * x * sqrt(x);
  float t = nv / max(roughness, 1.0e-2), squared = nv * nv;
  return exp(-t * (0.81 + 0.407 * t)) * (1.0 - min(1.45 - 1.1 * roughness, 1.0) * squared * squared);
}

// Share of white light from everywhere that the diffuse lobe sends back. Oren and Nayar's is exact;
// Burley's is a fit to its quadrature, off by at most 2.5 %.
float diffuse_albedo(float roughness, float nv) {
  nv = clamp(nv, 1.0e-3, 1.0);
  if (roughness < 0.0) {
    float r = -1.0 - roughness;
    float sine = sqrt(1.0 - nv * nv);
    float g = sine * (acos(nv) - sine * nv) +
              2.0 / 3.0 * (sine / nv * (1.0 - sine * sine * sine) - sine);
    return (PI + r * g) / (PI + (0.5 * PI - 2.0 / 3.0) * r);
  }
  float grazing = fifth_power(1.0 - nv);
  return mix(0.976 - 0.488 * grazing, 1.035 + 0.55 * grazing, roughness);
}
