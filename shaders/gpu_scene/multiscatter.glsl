// What GGX reflects and refracts in all, as far as closures must know it; and what light that is
// scattered several times between its facets adds to what is scattered once, as a factor (Turquin
// 2019): white metals and white glass then lose nothing.
#include "base/albedo.glsl"
#include "base/microfacet.glsl"

// For facets that reflect `f0` to `f90`. Masking of both directions apart hides more than is hidden
// after one bounce; that part comes back as it is, the rest in the colour of further bounces (Kulla
// and Conty 2017).
vec3 reflected_bounces(vec3 f0, vec3 f90, float roughness, float cosine) {
  cosine = clamp(cosine, 0.0, 1.0);
  float once = ggx_albedo(roughness, cosine);
  // The mean of ggx_albedo() over all directions, and that of Schlick's rise.
  float r = roughness;
  float mean_once = 1.0 - r * r * (-0.2808 + r * (2.1575 + r * (-1.3181 + r * 0.0312)));
  vec3 f = clamp(mix(f0, f90, 1.0 / 21.0), 0.0, 1.0);
  vec3 further = f * mean_once / (1.0 - f * (1.0 - mean_once));
  return mix(further, vec3(1.0), once) / ggx_separable_albedo(r * r, cosine);
}

// A visible facet of GGX under a normal of +Z, at random in cell `i` of side * side; the other half
// of the circle is the mirror image of this one.
vec3 random_facet(float alpha, vec3 v, int i, int side, inout uint seed) {
  seed = hash(seed);
  vec2 random = (vec2(i % side, i / side) + vec2(seed & 0xffffu, seed >> 16) / 65536.0) / float(side);
  return sample_ggx(alpha, v, vec2(cos(PI * random.x), sin(PI * random.x)), random.y);
}

// Share of white light that GGX of transmittance 1 refracts, by some facets: right on average,
// whatever the index of refraction. Where facets may reflect totally, it takes more of them.
float refracted_albedo(float alpha, float ior, float cosine, inout uint seed) {
  vec3 v = vec3(sqrt(1.0 - cosine * cosine), 0.0, cosine), l;
  int side = ior < 1.0 ? 6 : 4;
  float sum = 0.0;
  for (int i = 0; i < side * side; ++i) {
    vec3 h = random_facet(alpha, v, i, side, seed);
    if (refracted(v, h, ior, l) && l.z < 0.0) sum -= 2.0 * l.z / smith_root(-l.z, alpha * alpha);
  }
  return sum / float(side * side);
}

// Share of white light that GGX of reflectance `f0` to `f90` reflects, by 4 facets: right on average.
vec3 reflected_albedo(vec3 f0, vec3 f90, float ior, float roughness, float cosine, inout uint seed) {
  float alpha = roughness * roughness, all = 0.0, risen = 0.0;
  cosine = clamp(cosine, 0.01, 1.0);
  vec3 v = vec3(sqrt(1.0 - cosine * cosine), 0.0, cosine);
  for (int i = 0; i < 4; ++i) {
    vec3 h = random_facet(alpha, v, i, 2, seed);
    float height = 2.0 * dot(v, h) * h.z - v.z;
    float unmasked = height > 0.0 ? 2.0 * height / smith_root(height, alpha * alpha) : 0.0;
    all += 0.25 * unmasked;
    risen += 0.25 * unmasked * fresnel_rise(dot(v, h), ior);
  }
  return f0 * (all - risen) + f90 * risen;
}

// For glass that reflects the share `reflected` by its normal, and refracts the rest.
float glass_bounces(float reflected, float roughness, float ior, float cosine, inout uint seed) {
  float alpha = roughness * roughness;
  if (is_smooth(alpha)) return 1.0;
  cosine = clamp(cosine, 0.01, 1.0);
  float once = reflected * ggx_separable_albedo(alpha, cosine);
  if (reflected < 1.0) once += (1.0 - reflected) * refracted_albedo(alpha, ior, cosine, seed);
  return 1.0 / clamp(once, 0.05, 1.0);
}
