// Microfacets: GGX (Walter et al. 2007) with Smith's masking of both directions apart, which is what
// Cycles has, sampled by visible normals (Heitz 2018, by the caps of Dupuy and Benyoub 2023); and
// the coat of Disney's BRDF (Burley 2012).
//
// n: the lobe's normal, v: towards the viewer, l: towards the light, h: the microfacet's normal, all
// unit; a2: alpha squared. A lobe's value has its cosine; its density is per solid angle of l. Where
// the sine of h is wanted it comes of a cross product: 1 - cosine squared has no digits left for
// nearly smooth surfaces.
#include "base/scattering.glsl"

// Below, a surface is smooth: there is one direction, and no density. Cycles' limit.
const float SMOOTH_A2 = 1.0e-7;

bool is_smooth(float alpha) { return alpha * alpha <= SMOOTH_A2; }

// Smith's masking is 2 cosine / smith_root().
float smith_root(float cosine, float a2) {
  return cosine + sqrt(a2 + (1.0 - a2) * cosine * cosine);
}

float ggx_distribution(float a2, vec3 n, vec3 h) {
  vec3 across = cross(n, h);
  float t = mix(a2, 1.0, min(dot(across, across), 1.0));
  return a2 / (PI * t * t);
}

// GGX of reflectance 1. nl and nv are positive.
float ggx_reflection(float a2, vec3 n, vec3 h, float nl, float nv, out float pdf) {
  pdf = ggx_distribution(a2, n, h) / (2.0 * smith_root(nv, a2));
  return pdf * 2.0 * nl / smith_root(nl, a2);
}

// GGX of transmittance 1, without the change of radiance between media, as Cycles has it. `ior` is
// the far side's over the near side's; nl is negative.
float ggx_refraction(float a2, float ior, vec3 n, vec3 v, vec3 l, float nl, float nv, out float pdf) {
  vec3 along = ior * l + v;
  float squared = max(dot(along, along), 1.0e-20);
  float facing = dot(along, n) < 0.0 ? -1.0 : 1.0;  // h is on the viewer's side
  vec3 h = along * (facing * inversesqrt(squared));
  float vh = dot(v, h), lh = dot(l, h);
  pdf = 0.0;
  if (!(vh > 0.0 && lh < 0.0)) return 0.0;
  pdf = 2.0 * ggx_distribution(a2, n, h) * vh * -lh * ior * ior / (smith_root(nv, a2) * squared);
  return pdf * -2.0 * nl / smith_root(-nl, a2);
}

// Disney's coat is masked as if its alpha were .25.
const float COAT_MASK_A2 = 0.0625;

float coat_reflection(float a2, vec3 n, vec3 h, float nl, float nv, float vh, out float pdf) {
  a2 = min(a2, 0.999);
  vec3 across = cross(n, h);
  float sine2 = min(dot(across, across), 1.0);
  float distribution = (a2 - 1.0) / (PI * log(a2) * mix(a2, 1.0, sine2));
  pdf = distribution * sqrt(1.0 - sine2) / (4.0 * max(vh, 1.0e-6));
  return distribution * nl / (smith_root(nl, COAT_MASK_A2) * smith_root(nv, COAT_MASK_A2));
}

// --- sampling ---------------------------------------------------------------------------------------

// Two unit vectors that are square to `n` and to each other (Duff et al. 2017), and n.
mat3 frame_around(vec3 n) {
  float facing = n.z < 0.0 ? -1.0 : 1.0;
  float a = -1.0 / (facing + n.z), b = n.x * n.y * a;
  return mat3(vec3(1.0 + facing * n.x * n.x * a, facing * b, -facing * n.x),
              vec3(b, facing + n.y * n.y * a, -n.y), n);
}

// A visible microfacet of GGX, where the normal is (0, 0, 1); `circle` is a point of the unit circle,
// `height` a random number.
vec3 sample_ggx(float alpha, vec3 v, vec2 circle, float height) {
  vec3 stretched = normalize(vec3(alpha * v.xy, v.z));
  float z = (1.0 - height) * (1.0 + stretched.z) - stretched.z;
  vec3 h = vec3(sqrt(max(1.0 - z * z, 0.0)) * circle, z) + stretched;
  return normalize(vec3(alpha * h.xy, max(h.z, 1.0e-12)));
}

// A microfacet of Disney's coat.
vec3 sample_coat(float alpha, vec2 circle, float height) {
  float a2 = min(alpha * alpha, 0.999);
  float sine2 = clamp((pow(a2, height) - a2) / (1.0 - a2), 0.0, 1.0);
  return vec3(sqrt(sine2) * circle, sqrt(1.0 - sine2));
}

// Where light goes on behind a facet `h`; false where it is reflected totally. `ior` as above.
bool refracted(vec3 v, vec3 h, float ior, out vec3 l) {
  float vh = dot(v, h), inverse = 1.0 / max(ior, 1.0e-6);
  float squared = 1.0 - inverse * inverse * (1.0 - vh * vh);
  l = (inverse * vh - sqrt(max(squared, 0.0))) * h - inverse * v;
  return squared > 0.0;
}
