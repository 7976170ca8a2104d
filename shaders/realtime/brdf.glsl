// Lobes and falloffs of direct light. Each lobe is without its cosine; Cycles is the reference.
#include "base/albedo.glsl"
#include "base/falloff.glsl"
#include "base/scattering.glsl"

vec3 half_vector(vec3 n, vec3 v, vec3 l) { return normalize(l + v + 1.0e-12 * n); }

// diffuse_lobe() of directions.
float diffuse_lobe(float roughness, vec3 n, vec3 v, vec3 l) {
  return diffuse_lobe(roughness, clamp(dot(n, l), 0.0, 1.0), clamp(dot(n, v), 0.0, 1.0), dot(l, v),
                      dot(l, half_vector(n, v, l)));
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

// GGX with height-correlated Smith masking (Heitz 2014), before Fresnel's term.
float ggx_lobe(float alpha, vec3 n, vec3 v, vec3 l) {
  float a2 = alpha * alpha;
  float nl = clamp(dot(n, l), 1.0e-5, 1.0), nv = clamp(dot(n, v), 1.0e-5, 1.0);
  float nh = clamp(dot(n, half_vector(n, v, l)), 0.0, 1.0);
  float t = nh * nh * (a2 - 1.0) + 1.0;
  float distribution = a2 / (PI * t * t);
  float masking = 0.5 / (nl * sqrt(a2 + (1.0 - a2) * nv * nv) + nv * sqrt(a2 + (1.0 - a2) * nl * nl));
  return min(distribution * masking, 1.0e8);
}

float alpha_from_roughness(float roughness) { return max(roughness * roughness, 1.0e-3); }

// Single-scatter GGX whose reflectance rises from `f0` to `f90` as a dielectric's of index `ior` does.
vec3 glossy_lobe(vec3 f0, vec3 f90, float ior, float roughness, vec3 n, vec3 v, vec3 l) {
  float rise = fresnel_rise(dot(l, half_vector(n, v, l)), ior);
  return mix(f0, f90, rise) * ggx_lobe(alpha_from_roughness(roughness), n, v, l);
}

const float COAT_IOR = 1.5;

// A clear coat: GGX; or, where roughness is negative, that of Disney's BRDF as Cycles has it before
// 4.0 (Burley 2012: GTR1, masked as if of roughness .25 squared).
float coat_lobe(float roughness, vec3 n, vec3 v, vec3 l) {
  vec3 h = half_vector(n, v, l);
  float fresnel = fresnel_dielectric(dot(l, h), COAT_IOR);
  float alpha = alpha_from_roughness(roughness);
  if (roughness > 0.0) return fresnel * ggx_lobe(alpha, n, v, l);
  float nl = clamp(dot(n, l), 1.0e-5, 1.0), nv = clamp(dot(n, v), 1.0e-5, 1.0);
  float nh = clamp(dot(n, h), 0.0, 1.0);
  float a2 = alpha * alpha;
  const float MASK = 0.0625;
  float distribution =
      alpha < 1.0 ? (a2 - 1.0) / (PI * log(a2) * (1.0 + (a2 - 1.0) * nh * nh)) : 1.0 / PI;
  float masking = 1.0 / ((nl + sqrt(MASK + (1.0 - MASK) * nl * nl)) *
                         (nv + sqrt(MASK + (1.0 - MASK) * nv * nv)));
  return fresnel * distribution * masking;
}

// sheen_lobe() of directions.
float sheen_lobe(float roughness, vec3 n, vec3 v, vec3 l) {
  vec3 h = half_vector(n, v, l);
  return sheen_lobe(roughness, dot(n, l), dot(n, v), dot(n, h), dot(l, h));
}
