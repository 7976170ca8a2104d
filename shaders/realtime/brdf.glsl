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
