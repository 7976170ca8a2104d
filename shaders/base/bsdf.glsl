// Scattering by the lobes of a surface: what they send from a direction to the viewer, with which
// density directions are chosen, and the choice.
//
// A direction is chosen by one lobe, which is picked in proportion to about what it reflects; its
// density is that of all lobes together. Reflection never leaves below the geometric surface, and
// refraction never above it: the density there is 0. Light that comes from there is shaded all the
// same, for it is by the smooth normals that a mesh looks smooth.
#include "base/lobes.glsl"
#include "base/microfacet.glsl"

const uint BOUNCE_DIFFUSE = 0u;
const uint BOUNCE_GLOSSY = 1u;        // reflected
const uint BOUNCE_TRANSMISSION = 2u;  // refracted

struct BsdfValue {
  vec3 diffuse, glossy, transmission;  // each times its cosine; sheen is diffuse, a coat glossy
  float pdf;                           // of bsdf_sample(), per solid angle
};

struct BsdfSample {
  vec3 direction;   // unit
  BsdfValue value;
  bool singular;    // value and pdf are those of the choice alone: there is no other direction
  uint kind;        // BOUNCE_..., the lobe that was chosen
  float pdf;        // 0: no direction
};

// Near 1, the far side bends light by less than any other error here.
bool bends(float ior) { return abs(ior - 1.0) > 1.0e-3; }

#if TRANSMISSION
bool smooth_transmission(Lobes l) { return is_smooth(l.transmission_alpha) || !bends(l.ior); }
#endif

#if GLOSSY
// `cosine` is that between the directions and the facet.
vec3 specular_color(Lobes l, float cosine) {
  return mix(l.specular, l.grazing, fresnel_rise(cosine, l.specular_ior));
}
#endif

BsdfValue bsdf_evaluate(Lobes l, vec3 direction) {
  BsdfValue value = BsdfValue(vec3(0.0), vec3(0.0), vec3(0.0), 0.0);
  vec3 v = l.view;
  float side = dot(l.geometric_normal, direction);
  float reflected = side > 0.0 ? 1.0 : 0.0;
  // Where a normal is mapped, light fades out on diffuse surfaces before the horizon of the
  // interpolated one, and is cut off there on others: so it is in Cycles, measured.
  float above_horizon = dot(l.smooth_normal, direction) > 0.0 ? 1.0 : 0.0;
  vec3 h = direction + v;
  float squared = dot(h, h);
  h = squared > 1.0e-20 ? h * inversesqrt(squared) : l.normal;
  float lv = dot(direction, v), lh = dot(direction, h);
  float pdf;

  float nl = clamp(dot(l.normal, direction), 0.0, 1.0);
  value.diffuse = l.diffuse * (diffuse_lobe(l.diffuse_roughness, nl,
                                            clamp(dot(l.normal, v), 0.0, 1.0), lv, lh) *
                               incidence(l.smooth_normal, l.normal, direction));
  value.pdf = l.chances.diffuse * reflected * nl * (1.0 / PI);

#if LAYERS
  nl = clamp(dot(l.sheen_normal, direction), 0.0, 1.0);
  float arriving = l.sheen_roughness < 0.0
                       ? bump_shadowing(l.smooth_normal, l.sheen_normal, direction)
                       : above_horizon;
  value.diffuse += l.sheen * (sheen_lobe(l.sheen_roughness, nl, dot(l.sheen_normal, v),
                                         dot(l.sheen_normal, h), lh) * nl * arriving);
  value.pdf += nl > 0.0 ? l.chances.sheen * reflected * (0.5 / PI) : 0.0;
#endif

#if GLOSSY
  nl = dot(l.specular_normal, direction);
  float nv = dot(l.specular_normal, v);
  if (nl > 0.0 && nv > 0.0 && !is_smooth(l.alpha)) {
    float lobe = ggx_reflection(l.alpha * l.alpha, l.specular_normal, h, nl, nv, pdf);
    value.glossy = specular_color(l, lh) * (lobe * above_horizon);
    value.pdf += l.chances.specular * reflected * pdf;
  }
#endif

#if LAYERS && GLOSSY
  nl = dot(l.coat_normal, direction);
  nv = dot(l.coat_normal, v);
  if (nl > 0.0 && nv > 0.0 && !is_smooth(l.coat_alpha)) {
    float a2 = l.coat_alpha * l.coat_alpha;
    float lobe = l.coat_alpha < 0.0 ? coat_reflection(a2, l.coat_normal, h, nl, nv, lh, pdf)
                                    : ggx_reflection(a2, l.coat_normal, h, nl, nv, pdf);
    value.glossy += l.coat * fresnel_dielectric(lh, COAT_IOR) * lobe * above_horizon;
    value.pdf += l.chances.coat * reflected * pdf;
  }
#endif

#if TRANSMISSION
  float below = dot(l.transmission_normal, direction);
  float above = dot(l.transmission_normal, v);
  if (below < 0.0 && above > 0.0 && !smooth_transmission(l)) {
    value.transmission =
        l.transmission * ggx_refraction(l.transmission_alpha * l.transmission_alpha, l.ior,
                                        l.transmission_normal, v, direction, below, above, pdf);
    value.pdf += side < 0.0 ? l.chances.transmission * pdf : 0.0;
  }
#endif
  return value;
}

// What the lobe that was picked asks of a direction.
struct Picked {
  vec3 normal;
  float chance, alpha;
  bool sheen, coat, facet, singular;
  uint kind;
};

Picked pick_lobe(Lobes l, float random) {
  Picked p = Picked(l.normal, l.chances.diffuse, 1.0, false, false, false, false, BOUNCE_DIFFUSE);
  float threshold = l.chances.diffuse;
#if LAYERS
  if (random >= threshold && l.chances.sheen > 0.0)
    p = Picked(l.sheen_normal, l.chances.sheen, 1.0, true, false, false, false, BOUNCE_DIFFUSE);
  threshold += l.chances.sheen;
#endif
#if GLOSSY
  if (random >= threshold && l.chances.specular > 0.0)
    p = Picked(l.specular_normal, l.chances.specular, l.alpha, false, false, true,
               is_smooth(l.alpha), BOUNCE_GLOSSY);
  threshold += l.chances.specular;
#if LAYERS
  if (random >= threshold && l.chances.coat > 0.0)
    p = Picked(l.coat_normal, l.chances.coat, l.coat_alpha, false, true, true,
               is_smooth(l.coat_alpha), BOUNCE_GLOSSY);
  threshold += l.chances.coat;
#endif
#endif
#if TRANSMISSION
  if (random >= threshold && l.chances.transmission > 0.0)
    p = Picked(l.transmission_normal, l.chances.transmission, l.transmission_alpha, false, false, true,
               smooth_transmission(l), BOUNCE_TRANSMISSION);
#endif
  return p;
}

// Of the lobe that was picked, if it is smooth.
BsdfValue singular_value(Lobes l, Picked p) {
  BsdfValue value = BsdfValue(vec3(0.0), vec3(0.0), vec3(0.0), p.chance);
#if GLOSSY
  float nv = dot(p.normal, l.view);
  value.glossy = specular_color(l, nv);
#if LAYERS
  if (p.coat) value.glossy = vec3(l.coat * fresnel_dielectric(nv, COAT_IOR));
#endif
#endif
#if TRANSMISSION
  if (p.kind == BOUNCE_TRANSMISSION) {
    value.glossy = vec3(0.0);
    value.transmission = l.transmission;
  }
#endif
  return value;
}

// random.xy choose a direction of the lobe that random.z, each in [0, 1), picks.
BsdfSample bsdf_sample(Lobes l, vec3 random) {
  Picked p = pick_lobe(l, random.z);
  mat3 frame = frame_around(p.normal);
  vec2 circle = vec2(cos(2.0 * PI * random.x), sin(2.0 * PI * random.x));
  vec3 local = vec3(sqrt(random.y) * circle, sqrt(1.0 - random.y));
#if LAYERS
  if (p.sheen) local = vec3(sqrt(max(1.0 - random.y * random.y, 0.0)) * circle, random.y);
#endif
  bool possible = p.chance > 0.0;
#if GLOSSY || TRANSMISSION
  if (p.facet) local = sample_ggx(abs(p.alpha), l.view * frame, circle, random.y);
#if GLOSSY && LAYERS
  if (p.coat && p.alpha < 0.0) local = sample_coat(p.alpha, circle, random.y);
#endif
  vec3 facet = p.singular ? p.normal : frame * local;
#endif
  BsdfSample s;
  s.direction = frame * local;
#if GLOSSY
  if (p.kind == BOUNCE_GLOSSY) {
    s.direction = 2.0 * dot(l.view, facet) * facet - l.view;
    possible = possible && dot(l.view, facet) > 0.0;
  }
#endif
#if TRANSMISSION
  if (p.kind == BOUNCE_TRANSMISSION)
    possible = refracted(l.view, facet, bends(l.ior) ? l.ior : 1.0, s.direction) && possible;
#endif
  s.direction = normalize(s.direction);
  s.kind = p.kind;
  s.singular = p.singular;

  // On which side light goes on, by the geometry and by the lobe's normal.
  float side = p.kind == BOUNCE_TRANSMISSION ? -1.0 : 1.0;
  possible = possible && side * dot(l.geometric_normal, s.direction) > 0.0 &&
             side * dot(p.normal, s.direction) > 0.0;
  s.value = bsdf_evaluate(l, s.direction);
  if (p.singular) s.value = singular_value(l, p);
  s.pdf = possible ? s.value.pdf : 0.0;
  return s;
}
