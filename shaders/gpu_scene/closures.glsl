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

// --- closures ---------------------------------------------------------------------------------------

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

// --- Principled -------------------------------------------------------------------------------------

struct Principled {
  vec3 base_color, subsurface_color;
  float subsurface, metallic, roughness, diffuse_roughness, specular, transmission;
  float transmission_roughness, ior, alpha;
  vec3 specular_tint;  // three times the same number before Blender 4.0
  vec3 emission;
  float sheen, sheen_roughness;
  vec3 sheen_tint;     // as specular_tint
  float coat, coat_roughness, coat_ior;
  vec3 coat_tint, coat_normal, normal;
  vec3 view;         // Hit::view
  bool backfacing;   // Hit::backfacing
};

Principled principled_defaults(Hit hit) {
  return Principled(vec3(0.8), vec3(0.8), 0.0, 0.0, 0.5, 0.0, 0.5, 0.0, 0.0, 1.45, 1.0, vec3(0.0),
                    vec3(0.0), 0.0, 0.5, vec3(0.5), 0.0, 0.03, 1.5, vec3(1.0), hit.normal,
                    hit.normal, hit.view, hit.backfacing);
}

// Alpha, emission and normal, which both generations share; returns the weight of what remains.
vec3 principled_common(inout Surface s, vec3 weight, Principled p) {
  s.transparency += weight * (1.0 - p.alpha);
  s.emission += weight * p.alpha * p.emission;
  add_normal(s, weight * p.alpha, p.normal);
  return weight * p.alpha;
}

// Blender before 4.0.
void closure_principled_v3(inout Surface s, vec3 weight, Principled p) {
  weight = principled_common(s, weight, p);
  p.metallic = clamp(p.metallic, 0.0, 1.0);
  p.roughness = clamp(p.roughness, 0.0, 1.0);
  float transmitted = clamp(p.transmission, 0.0, 1.0) * (1.0 - p.metallic);
  float dielectric = (1.0 - p.metallic) * (1.0 - clamp(p.transmission, 0.0, 1.0));

  // Burley's diffuse lobe; light that wanders below the surface leaves where it enters.
  add_burley(s, weight * dielectric * mix(p.base_color, p.subsurface_color, p.subsurface),
             p.roughness, p.normal);
  float brightness = dot(p.base_color, vec3(0.3, 0.6, 0.1));  // as Disney's BRDF has it
  vec3 hue = brightness > 0.0 ? p.base_color / brightness : vec3(1.0);
  add_sheen(s, weight * dielectric * p.sheen * mix(vec3(1.0), hue, p.sheen_tint), SHEEN_SCHLICK,
            p.normal);

  vec3 f0 = mix(0.08 * p.specular * mix(vec3(1.0), hue, p.specular_tint), p.base_color, p.metallic);
  float root = sqrt(max(0.08 * p.specular, 0.0));
  if (p.specular > 0.0 || p.metallic > 0.0)
    add_specular(s, weight * (1.0 - transmitted) * f0, weight * (1.0 - transmitted),
                 2.0 / max(1.0 - root, 1.0e-3) - 1.0, p.roughness, p.normal);

  float ior = relative_ior(p.backfacing, p.ior);
  float reflected = fresnel_dielectric(dot(p.normal, p.view), ior);
  vec3 mirrored = weight * transmitted * reflected;
  add_specular(s, mirrored * mix(vec3(1.0), p.base_color, p.specular_tint), mirrored, ior,
               p.roughness, p.normal);
  add_transmission(s, weight * transmitted * (1.0 - reflected) * p.base_color, ior,
                   1.0 - (1.0 - p.roughness) * (1.0 - clamp(p.transmission_roughness, 0.0, 1.0)),
                   p.normal);
  // Negative: the distribution of the Disney BRDF.
  add_coat(s, luminance(weight) * 0.25 * p.coat, -clamp(p.coat_roughness, 0.0, 1.0), p.coat_normal);
}

// Blender 4.0 and later: layers from the coat down, each with what the ones above let through.
void closure_principled_v4(inout Surface s, vec3 weight, Principled p) {
  weight = principled_common(s, weight, p);
  p.metallic = clamp(p.metallic, 0.0, 1.0);
  p.roughness = clamp(p.roughness, 0.0, 1.0);

  float coat = max(p.coat, 0.0);
  float coat_cosine = max(dot(p.coat_normal, p.view), 0.0);
  add_coat(s, luminance(weight) * coat, clamp(p.coat_roughness, 0.0, 1.0), p.coat_normal);
  // The way through the coat and back is longer at a slant, by the refracted direction.
  float coat_ior = max(p.coat_ior, 1.0);
  float within = sqrt(max(1.0 - (1.0 - coat_cosine * coat_cosine) / (coat_ior * coat_ior), 1.0e-4));
  weight *= mix(vec3(1.0), pow(max(p.coat_tint, vec3(0.0)), vec3(1.0 / within)), min(coat, 1.0));
  weight *= 1.0 - min(coat, 1.0) * fresnel_dielectric(coat_cosine, coat_ior);
  add_sheen(s, weight * p.sheen * p.sheen_tint, clamp(p.sheen_roughness, 0.0, 1.0), p.normal);

  float metal = p.metallic, glass = (1.0 - metal) * clamp(p.transmission, 0.0, 1.0);
  float dielectric = (1.0 - metal) * (1.0 - clamp(p.transmission, 0.0, 1.0));
  add_specular(s, weight * metal * p.base_color, weight * metal, 1.5, p.roughness, p.normal);

  float ior = relative_ior(p.backfacing, p.ior);
  float reflected = fresnel_dielectric(dot(p.normal, p.view), ior);
  vec3 mirrored = weight * glass * reflected * p.specular_tint;
  add_specular(s, mirrored, mirrored, 1.0, p.roughness, p.normal);
  add_transmission(s, weight * glass * (1.0 - reflected) * p.base_color, ior, p.roughness, p.normal);

  float f0 = min(2.0 * p.specular * reflectance_from_ior(max(p.ior, 1.0e-3)), 0.99);
  float root = sqrt(max(f0, 0.0));
  add_specular(s, weight * dielectric * f0 * p.specular_tint, weight * dielectric * (f0 > 0.0 ? 1.0 : 0.0),
               (1.0 + root) / (1.0 - root), p.roughness, p.normal);
  // The base gets what the reflection on it leaves.
  vec3 reflected_above = environment_reflectance(f0 * p.specular_tint, vec3(f0 > 0.0 ? 1.0 : 0.0),
                                                 p.roughness, max(dot(p.normal, p.view), 0.0));
  float below = 1.0 - max(max(reflected_above.r, reflected_above.g), reflected_above.b);
  add_oren_nayar(s, weight * dielectric * max(below, 0.0) * p.base_color, p.diffuse_roughness,
                 p.normal);
}
