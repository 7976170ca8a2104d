// Lobes and falloffs of direct light. Each lobe is without its cosine; Cycles is the reference.

const float PI = 3.14159265359;

float fifth_power(float x) {
  float squared = x * x;
  return squared * squared * x;
}

// Burley's diffuse lobe (Burley 2012), or Lambert's for roughness < 0; without the albedo.
float diffuse_lobe(float roughness, vec3 n, vec3 v, vec3 l) {
  if (roughness < 0.0) return 1.0 / PI;
  vec3 h = normalize(l + v + 1.0e-12 * n);
  float lh = dot(l, h);
  float f90 = 0.5 + 2.0 * roughness * lh * lh;
  float in_light = fifth_power(1.0 - clamp(dot(n, l), 0.0, 1.0));
  float in_view = fifth_power(1.0 - clamp(dot(n, v), 0.0, 1.0));
  return (1.0 + (f90 - 1.0) * in_light) * (1.0 + (f90 - 1.0) * in_view) / PI;
}

vec3 schlick(vec3 f0, float cosine) {
  // Nothing reflects at grazing angles what reflects nothing at normal incidence.
  float f90 = clamp(50.0 * max(max(f0.r, f0.g), f0.b), 0.0, 1.0);
  return f0 + (f90 - f0) * fifth_power(1.0 - clamp(cosine, 0.0, 1.0));
}

// Single-scatter GGX with height-correlated Smith masking (Heitz 2014).
vec3 glossy_lobe(vec3 f0, float roughness, vec3 n, vec3 v, vec3 l) {
  float alpha = max(roughness * roughness, 1.0e-3);
  float a2 = alpha * alpha;
  vec3 h = normalize(l + v + 1.0e-12 * n);
  float nl = clamp(dot(n, l), 1.0e-5, 1.0), nv = clamp(dot(n, v), 1.0e-5, 1.0);
  float nh = clamp(dot(n, h), 0.0, 1.0);
  float t = nh * nh * (a2 - 1.0) + 1.0;
  float distribution = a2 / (PI * t * t);
  float masking = 0.5 / (nl * sqrt(a2 + (1.0 - a2) * nv * nv) + nv * sqrt(a2 + (1.0 - a2) * nl * nl));
  return schlick(f0, dot(l, h)) * min(distribution * masking, 1.0e8);
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

// Measured in Cycles 3.4: the cone's smooth step times the cosine, as of a disk square to the axis.
float spot_falloff(vec2 cone, float cosine) {
  if (cosine <= cone.x) return 0.0;
  float t = clamp((cosine - cone.x) * cone.y, 0.0, 1.0);
  return cosine * t * t * (3.0 - 2.0 * t);
}

// One-sided Lambertian emitter; `spread` narrows it (Cycles' formula, measured).
float area_falloff(vec2 spread, float cosine) {
  if (cosine <= 0.0) return 0.0;
  if (spread.x < 0.0) return cosine;
  float tangent = sqrt(max(1.0 - cosine * cosine, 0.0)) / cosine;
  return cosine * max(spread.x - tangent, 0.0) * spread.y;
}
