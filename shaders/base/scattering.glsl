// Lobes of surfaces that Real-time and the path tracer share, as functions of cosines; each is without
// its own cosine and without its albedo. n: the lobe's normal, l: towards the light, v: towards the
// viewer, h: between l and v, all unit. Cycles is the reference.
#include "base/fresnel.glsl"

const float PI = 3.14159265359;

float fifth_power(float x) {
  float squared = x * x;
  return squared * squared * x;
}

// Burley's diffuse lobe (Burley 2012) for roughness 0..1; below, at -1 - roughness, the improved
// qualitative model of Oren and Nayar (Fujii), which without roughness is Lambert's. nl, nv: 0..1.
float diffuse_lobe(float roughness, float nl, float nv, float lv, float lh) {
  if (roughness < 0.0) {
    float r = -1.0 - roughness;
    float across = lv - nl * nv;
    if (across > 0.0) across /= max(max(nl, nv), 1.0e-6);
    return (1.0 + r * across) / (PI + (0.5 * PI - 2.0 / 3.0) * r);
  }
  float f90 = 0.5 + 2.0 * roughness * lh * lh;
  return (1.0 + (f90 - 1.0) * fifth_power(1.0 - nl)) * (1.0 + (f90 - 1.0) * fifth_power(1.0 - nv)) / PI;
}

// Ashikhmin's velvet of that deviation; for negative roughness the sheen of Disney's BRDF.
float sheen_lobe(float roughness, float nl, float nv, float nh, float lh) {
  lh = clamp(lh, 1.0e-5, 1.0);
  if (roughness < 0.0) return fifth_power(1.0 - lh);
  nl = clamp(nl, 1.0e-5, 1.0);
  nv = clamp(nv, 1.0e-5, 1.0);
  nh = clamp(nh, 1.0e-5, 1.0 - 1.0e-5);
  float sine2 = 1.0 - nh * nh;
  float inverse = 1.0 / max(roughness * roughness, 1.0e-4);
  float distribution = exp(-nh * nh / sine2 * inverse) * inverse / (PI * sine2 * sine2);
  float masking = min(1.0, 2.0 * nh / lh * min(nl, nv));
  return 0.25 * distribution * masking / (nl * nv);
}

// Where a mapped normal leaves the interpolated one, light fades out before the surface's own
// horizon instead of being cut there (Conty Estevez et al. 2019, with Cycles' polynomial).
float bump_shadowing(vec3 smooth_normal, vec3 n, vec3 l) {
  float across = dot(n, l) * dot(n, smooth_normal);
  float g = dot(smooth_normal, l) / (abs(across) > 1.0e-12 ? across : 1.0e-12);
  if (g >= 1.0) return 1.0;
  if (g <= 0.0) return 0.0;
  return g * (1.0 + g - g * g);
}

// The share of a light that falls on a surface from `l`.
float incidence(vec3 smooth_normal, vec3 n, vec3 l) {
  return bump_shadowing(smooth_normal, n, l) * max(dot(n, l), 0.0);
}
