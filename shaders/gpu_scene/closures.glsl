// Closures: evaluate_material(hit, surface) adds them to a Surface.
//
// A Surface holds one lobe of each kind. What becomes of several closures of a kind is said in
// lobes_merged.glsl, or in lobes_apart.glsl where LOBES_APART is defined (the path tracer). The
// formulas are Cycles' (of 3.4 and, where they differ, of 4.0 and later).

struct Surface {
  vec3 diffuse;              // albedo
  float diffuse_roughness;   // of Burley's lobe, 0..1; or -1 - that of Oren and Nayar's; LAMBERT
  vec3 specular;             // reflectance at normal incidence
  vec3 grazing;              // reflectance at grazing angles
  float specular_ior;        // by whose Fresnel term it rises from one to the other
  float roughness;           // of the specular lobe, 0..1 as artists set it
  vec3 transmission;         // what passes through with refraction
  float transmission_roughness;
  float ior;                 // far side over near side
  vec3 transparency;         // what passes straight through
  vec3 emission;             // radiance
  vec3 normal;               // of all closures, by weight; unit once finished
  vec3 smooth_normal;        // the interpolated one, as displacement leaves it
  float coat, coat_roughness;  // a second, clear specular lobe; negative: as of Disney's BRDF
  vec3 coat_normal;
  vec3 sheen;
  float sheen_roughness;     // of Ashikhmin's velvet; SHEEN_SCHLICK for the lobe of Cycles 3.4
  float weight;              // sum of the closures' weights
#ifdef LOBES_APART
  uint seed;                 // of the choice among closures
  vec3 diffuse_normal, specular_normal, transmission_normal, sheen_normal;
#else
  // Sums of weights, until finish_surface() divides by them.
  float burley_weight, oren_nayar_weight, oren_nayar_roughness;
  float specular_weight, transmission_weight, coat_weight, sheen_weight;
#endif
};

const float LAMBERT = -1.0;
const float SHEEN_SCHLICK = -1.0;

// What is not finite, for whatever reason, counts as nothing.
float finite(float x) { return abs(x) <= 1.0e30 ? x : 0.0; }
vec3 finite(vec3 v) { return vec3(finite(v.x), finite(v.y), finite(v.z)); }

// Reflections at grazing angles are seen over a twentieth of the sphere.
float specular_amount(vec3 normal_incidence, vec3 grazing) {
  return luminance(abs(normal_incidence) + 0.05 * abs(grazing));
}

#ifdef LOBES_APART
#include "gpu_scene/lobes_apart.glsl"
#include "gpu_scene/multiscatter.glsl"
#else
#include "gpu_scene/lobes_merged.glsl"
#endif

Surface empty_surface() {
  Surface s;
  s.diffuse = s.specular = s.grazing = s.transmission = s.transparency = s.emission = vec3(0.0);
  s.normal = s.smooth_normal = s.coat_normal = s.sheen = vec3(0.0);
  s.diffuse_roughness = s.specular_ior = s.roughness = s.transmission_roughness = s.ior = 0.0;
  s.coat = s.coat_roughness = s.sheen_roughness = s.weight = 0.0;
  empty_lobes(s);
  return s;
}

// Alpha is stochastic, so what a pixel keeps is what the surface does where it is not transparent.
void finish_surface(Hit hit, inout Surface s) {
  s.smooth_normal = safe_normalize(s.smooth_normal, hit.normal);
  s.normal = keep_reflection_above(hit.geometric_normal, hit.view,
                                   safe_normalize(s.normal, s.smooth_normal));
  finish_lobes(hit, s);
  s.diffuse = finite(s.diffuse);
  s.specular = finite(s.specular);
  s.grazing = finite(s.grazing);
  s.transmission = finite(s.transmission);
  s.emission = finite(s.emission);
  s.coat = finite(s.coat);
  s.sheen = finite(s.sheen);
#if ALPHA
  float alpha = 1.0 - luminance(s.transparency);
  float scale = alpha > 0.0 ? 1.0 / alpha : 0.0;
  s.diffuse *= scale;
  s.specular *= scale;
  s.grazing *= scale;
  s.transmission *= scale;
  s.emission *= scale;
  s.coat *= scale;
  s.sheen *= scale;
#endif
}

void add_normal(inout Surface s, vec3 weight, vec3 normal) {
  float amount = luminance(abs(weight));
  s.weight += amount;
  s.normal += amount * normal;
}

void closure_diffuse(inout Surface s, vec3 weight, vec3 color, float roughness, vec3 normal) {
  add_oren_nayar(s, weight * color, roughness, normal);
  add_normal(s, weight, normal);
}

void closure_glossy(inout Surface s, vec3 weight, vec3 color, float roughness, vec3 normal) {
  add_specular(s, weight * color, weight * color, 1.0, clamp(roughness, 0.0, 1.0), normal);
  add_normal(s, weight, normal);
}

// Several bounces between facets; Real-time has the first alone.
vec3 more_bounces(vec3 f0, vec3 f90, float roughness, float cosine) {
#ifdef LOBES_APART
  return reflected_bounces(f0, f90, roughness, cosine);
#else
  return vec3(1.0);
#endif
}

float more_bounces_of_glass(inout Surface s, float reflected, float roughness, float ior,
                            float cosine) {
#ifdef LOBES_APART
  return glass_bounces(reflected, roughness, ior, cosine, s.seed);
#else
  return 1.0;
#endif
}

void closure_glossy_multiscatter(Hit hit, inout Surface s, vec3 weight, vec3 color, float roughness,
                                 vec3 normal) {
  roughness = clamp(roughness, 0.0, 1.0);
  color *= more_bounces(color, color, roughness, dot(normal, hit.view));
  closure_glossy(s, weight, color, roughness, normal);
}

void closure_velvet(inout Surface s, vec3 weight, vec3 color, float sigma, vec3 normal) {
  add_sheen(s, weight * color, clamp(sigma, 0.0, 1.0), normal);
  add_normal(s, weight, normal);
}

float relative_ior(bool backfacing, float ior) {
  ior = max(ior, 1.0e-5);
  return backfacing ? 1.0 / ior : ior;
}

// Cycles decides between reflection and refraction by the macroscopic normal.
void closure_glass(Hit hit, inout Surface s, vec3 weight, vec3 color, float roughness, float ior,
                   vec3 normal) {
  ior = relative_ior(hit.backfacing, ior);
  float reflected = fresnel_dielectric(dot(normal, hit.view), ior);
  roughness = clamp(roughness, 0.0, 1.0);
  vec3 mirrored = weight * color * reflected;
  add_specular(s, mirrored, mirrored, 1.0, roughness, normal);
  add_transmission(s, weight * color * (1.0 - reflected), ior, roughness, normal);
  add_normal(s, weight, normal);
}

void closure_glass_multiscatter(Hit hit, inout Surface s, vec3 weight, vec3 color, float roughness,
                                float ior, vec3 normal) {
  float cosine = dot(normal, hit.view), relative = relative_ior(hit.backfacing, ior);
  color *= more_bounces_of_glass(s, fresnel_dielectric(cosine, relative), clamp(roughness, 0.0, 1.0),
                                 relative, cosine);
  closure_glass(hit, s, weight, color, roughness, ior, normal);
}

void closure_refraction(Hit hit, inout Surface s, vec3 weight, vec3 color, float roughness, float ior,
                        vec3 normal) {
  add_transmission(s, weight * color, relative_ior(hit.backfacing, ior), clamp(roughness, 0.0, 1.0),
                   normal);
  add_normal(s, weight, normal);
}

void closure_transparent(inout Surface s, vec3 weight, vec3 color) {
  s.transparency += weight * color;
}

void closure_emission(inout Surface s, vec3 weight, vec3 radiance) {
  s.emission += weight * radiance;
}
