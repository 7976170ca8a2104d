// The Principled BSDF, both generations, as closures of its parts.
#include "gpu_scene/closures.glsl"

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
  bool multiscatter; // distribution Multiscatter GGX
};

Principled principled_defaults(Hit hit) {
  return Principled(vec3(0.8), vec3(0.8), 0.0, 0.0, 0.5, 0.0, 0.5, 0.0, 0.0, 1.45, 1.0, vec3(0.0),
                    vec3(0.0), 0.0, 0.5, vec3(0.5), 0.0, 0.03, 1.5, vec3(1.0), hit.normal,
                    hit.normal, hit.view, hit.backfacing, false);
}

// Alpha, emission and normal, which both generations share; returns the weight of what remains.
vec3 principled_common(inout Surface s, vec3 weight, Principled p) {
  s.transparency += weight * (1.0 - p.alpha);
  s.emission += weight * p.alpha * p.emission;
  add_normal(s, weight * p.alpha, p.normal);
  return weight * p.alpha;
}

float principled_glass_bounces(inout Surface s, Principled p, float reflected, float ior) {
  if (!p.multiscatter) return 1.0;
  return more_bounces_of_glass(s, reflected, p.roughness, ior, dot(p.normal, p.view));
}

vec3 principled_bounces(Principled p, vec3 f0, vec3 f90) {
  if (!p.multiscatter) return vec3(1.0);
  return more_bounces(f0, f90, p.roughness, dot(p.normal, p.view));
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
  if (p.specular > 0.0 || p.metallic > 0.0) {
    vec3 reflecting = weight * (1.0 - transmitted) * principled_bounces(p, f0, vec3(1.0));
    add_specular(s, reflecting * f0, reflecting, 2.0 / max(1.0 - root, 1.0e-3) - 1.0, p.roughness,
                 p.normal);
  }

  float ior = relative_ior(p.backfacing, p.ior);
  float reflected = fresnel_dielectric(dot(p.normal, p.view), ior);
  vec3 passing = weight * transmitted * principled_glass_bounces(s, p, reflected, ior);
  vec3 mirrored = passing * reflected;
  add_specular(s, mirrored * mix(vec3(1.0), p.base_color, p.specular_tint), mirrored, ior,
               p.roughness, p.normal);
  // Several bounces know one roughness only.
  float blurred = p.multiscatter ? 0.0 : clamp(p.transmission_roughness, 0.0, 1.0);
  add_transmission(s, passing * (1.0 - reflected) * p.base_color, ior,
                   1.0 - (1.0 - p.roughness) * (1.0 - blurred), p.normal);
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
#ifdef LOBES_APART
  float coat_f0 = reflectance_from_ior(coat_ior);
  float coat_albedo = reflected_albedo(vec3(coat_f0), vec3(1.0), coat_ior,
                                       clamp(p.coat_roughness, 0.0, 1.0), coat_cosine, s.seed).x;
#else
  float coat_albedo = fresnel_dielectric(coat_cosine, coat_ior);
#endif
  weight *= 1.0 - min(coat, 1.0) * coat_albedo;
  p.sheen_roughness = clamp(p.sheen_roughness, 0.0, 1.0);
  vec3 sheen = p.sheen * p.sheen_tint;
  add_sheen(s, weight * sheen, p.sheen_roughness, p.normal);
#ifdef LOBES_APART
  // What the sheen sends back does not reach what lies below.
  float taken = max(max(sheen.r, sheen.g), sheen.b) *
                sheen_albedo(p.sheen_roughness, dot(p.normal, p.view));
  weight *= 1.0 - clamp(taken, 0.0, 1.0);
#endif

  float metal = p.metallic, glass = (1.0 - metal) * clamp(p.transmission, 0.0, 1.0);
  float dielectric = (1.0 - metal) * (1.0 - clamp(p.transmission, 0.0, 1.0));
  vec3 reflecting = weight * metal * principled_bounces(p, p.base_color, vec3(1.0));
  add_specular(s, reflecting * p.base_color, reflecting, 1.5, p.roughness, p.normal);

  float ior = relative_ior(p.backfacing, p.ior);
  float reflected = fresnel_dielectric(dot(p.normal, p.view), ior);
  vec3 passing = weight * glass * principled_glass_bounces(s, p, reflected, ior);
  vec3 mirrored = passing * reflected * p.specular_tint;
  add_specular(s, mirrored, mirrored, 1.0, p.roughness, p.normal);
  add_transmission(s, passing * (1.0 - reflected) * p.base_color, ior, p.roughness, p.normal);

  float f0 = min(2.0 * p.specular * reflectance_from_ior(max(p.ior, 1.0e-3)), 0.99);
  float root = sqrt(max(f0, 0.0));
  vec3 tinted = f0 * p.specular_tint, grazing = vec3(f0 > 0.0 ? 1.0 : 0.0);
  vec3 bounces = principled_bounces(p, tinted, grazing);
  reflecting = weight * dielectric * bounces;
  float rising_ior = (1.0 + root) / (1.0 - root);
  add_specular(s, reflecting * tinted, reflecting * grazing, rising_ior, p.roughness, p.normal);
  // The base gets what the reflection on it leaves.
  float cosine = max(dot(p.normal, p.view), 0.0);
#ifdef LOBES_APART
  vec3 reflected_above = reflected_albedo(tinted, grazing, rising_ior, p.roughness, cosine, s.seed);
#else
  vec3 reflected_above = environment_reflectance(tinted, grazing, p.roughness, cosine);
#endif
  reflected_above *= bounces;
  float below = 1.0 - max(max(reflected_above.r, reflected_above.g), reflected_above.b);
  add_oren_nayar(s, weight * dielectric * max(below, 0.0) * p.base_color, p.diffuse_roughness,
                 p.normal);
}
