// How a surface scatters light, as those who follow rays keep it between the programs of materials and
// the one that scatters: one lobe of each kind, each with its own normal. GLOSSY, TRANSMISSION and
// LAYERS say which kinds there are; others take no room.
//
// With LOBES_APART, which programs of materials define, lobes_of() makes them of a Surface.
#include "base/color.glsl"
#include "base/fresnel.glsl"
#include "base/packing.glsl"

// Shares of the directions that each lobe chooses; their sum is 1, or 0 where nothing reflects.
struct LobeChances {
  float diffuse, specular, transmission, sheen, coat;
};

struct Lobes {
  vec3 view;                             // unit, towards the viewer
  vec3 geometric_normal, smooth_normal;  // unit, on the viewer's side, as all normals here
  vec3 diffuse;                          // albedo
  float diffuse_roughness;               // as in Surface
  vec3 normal;                           // of the diffuse lobe
#if GLOSSY
  vec3 specular, grazing;  // reflectance at normal incidence and at grazing angles
  float specular_ior;      // by whose Fresnel term it rises from one to the other
  float alpha;             // of GGX
  vec3 specular_normal;
#endif
#if TRANSMISSION
  vec3 transmission;       // what passes through with refraction
  float ior;               // far side over near side
  float transmission_alpha;
  vec3 transmission_normal;
#endif
#if LAYERS
  vec3 sheen;
  float sheen_roughness;   // as in Surface
  vec3 sheen_normal;
#if GLOSSY
  float coat;              // times a dielectric's reflectance
  float coat_alpha;        // of GGX; negative: of the coat of Disney's BRDF
  vec3 coat_normal;
#endif
#endif
  LobeChances chances;     // unpack_lobes() finds them
};

#if defined(LOBES_APART)
Lobes lobes_of(Hit hit, Surface surface) {
  Lobes l;
  l.view = hit.view;
  l.geometric_normal = hit.geometric_normal;
  l.smooth_normal = surface.smooth_normal;
  l.diffuse = surface.diffuse;
  l.diffuse_roughness = surface.diffuse_roughness;
  l.normal = surface.diffuse_normal;
#if GLOSSY
  l.specular = surface.specular;
  l.grazing = surface.grazing;
  l.specular_ior = surface.specular_ior;
  l.alpha = surface.roughness * surface.roughness;
  l.specular_normal = surface.specular_normal;
#endif
#if TRANSMISSION
  l.transmission = surface.transmission;
  l.ior = surface.ior;
  l.transmission_alpha = surface.transmission_roughness * surface.transmission_roughness;
  l.transmission_normal = surface.transmission_normal;
#endif
#if LAYERS
  l.sheen = surface.sheen;
  l.sheen_roughness = surface.sheen_roughness;
  l.sheen_normal = surface.sheen_normal;
#if GLOSSY
  l.coat = surface.coat;
  l.coat_alpha = surface.coat_roughness * abs(surface.coat_roughness);
  l.coat_normal = surface.coat_normal;
#endif
#endif
  return l;
}
#endif

// --- in memory --------------------------------------------------------------------------------------

const int LOBES_TEXELS = 2 + 2 * (GLOSSY + TRANSMISSION + LAYERS);

// Normals in 2 x 16 bits, all else as it is. The view is not kept: the ray has it.
void pack_lobes(Lobes l, out uvec4 texels[LOBES_TEXELS]) {
  uint specular_normal = 0u;
  int i = 2;
#if GLOSSY
  specular_normal = pack_unit(l.specular_normal);
  texels[i++] = floatBitsToUint(vec4(l.specular, l.alpha));
  texels[i++] = floatBitsToUint(vec4(l.grazing, l.specular_ior));
#endif
#if TRANSMISSION
  texels[i++] = floatBitsToUint(vec4(l.transmission, l.ior));
  texels[i++] = uvec4(pack_unit(l.transmission_normal), floatBitsToUint(l.transmission_alpha), 0u, 0u);
#endif
#if LAYERS
  texels[i++] = floatBitsToUint(vec4(l.sheen, l.sheen_roughness));
  texels[i] = uvec4(pack_unit(l.sheen_normal), 0u, 0u, 0u);
#if GLOSSY
  texels[i].yzw = uvec3(pack_unit(l.coat_normal), floatBitsToUint(vec2(l.coat, l.coat_alpha)));
#endif
#endif
  texels[0] = floatBitsToUint(vec4(l.diffuse, l.diffuse_roughness));
  texels[1] = uvec4(pack_unit(l.geometric_normal), pack_unit(l.smooth_normal), pack_unit(l.normal),
                    specular_normal);
}

// By about how much light each lobe sends to the viewer. No lobe of facets is chosen where its
// normal faces away from the viewer: there it is black.
LobeChances chances_of(Lobes l) {
  LobeChances c = LobeChances(luminance(abs(l.diffuse)), 0.0, 0.0, 0.0, 0.0);
#if GLOSSY
  // Rough facets stand at a slant to the viewer even where the surface does not.
  float cosine = dot(l.specular_normal, l.view);
  float rise = min(fresnel_rise(cosine, l.specular_ior) + 0.05, 1.0);
  if (cosine > 0.0) c.specular = luminance(abs(mix(l.specular, l.grazing, rise)));
#endif
#if TRANSMISSION
  if (dot(l.transmission_normal, l.view) > 0.0) c.transmission = luminance(abs(l.transmission));
#endif
#if LAYERS
  // The albedo of Disney's sheen is a tenth at most.
  c.sheen = luminance(abs(l.sheen)) * (l.sheen_roughness < 0.0 ? 0.1 : 1.0);
#if GLOSSY
  cosine = dot(l.coat_normal, l.view);
  if (cosine > 0.0) c.coat = abs(l.coat) * fresnel_dielectric(cosine, COAT_IOR);
#endif
#endif
  float sum = c.diffuse + c.specular + c.transmission + c.sheen + c.coat;
  float scale = sum > 0.0 ? 1.0 / sum : 0.0;
  return LobeChances(c.diffuse * scale, c.specular * scale, c.transmission * scale, c.sheen * scale,
                     c.coat * scale);
}

Lobes unpack_lobes(uvec4 texels[LOBES_TEXELS], vec3 view) {
  Lobes l;
  l.view = view;
  vec4 floats = uintBitsToFloat(texels[0]);
  l.diffuse = floats.rgb;
  l.diffuse_roughness = floats.a;
  l.geometric_normal = unpack_unit(texels[1].x);
  l.smooth_normal = unpack_unit(texels[1].y);
  l.normal = unpack_unit(texels[1].z);
  int i = 2;
#if GLOSSY
  floats = uintBitsToFloat(texels[i++]);
  l.specular = floats.rgb;
  l.alpha = floats.a;
  floats = uintBitsToFloat(texels[i++]);
  l.grazing = floats.rgb;
  l.specular_ior = floats.a;
  l.specular_normal = unpack_unit(texels[1].w);
#endif
#if TRANSMISSION
  floats = uintBitsToFloat(texels[i++]);
  l.transmission = floats.rgb;
  l.ior = floats.a;
  l.transmission_normal = unpack_unit(texels[i].x);
  l.transmission_alpha = uintBitsToFloat(texels[i++].y);
#endif
#if LAYERS
  floats = uintBitsToFloat(texels[i++]);
  l.sheen = floats.rgb;
  l.sheen_roughness = floats.a;
  l.sheen_normal = unpack_unit(texels[i].x);
#if GLOSSY
  l.coat_normal = unpack_unit(texels[i].y);
  l.coat = uintBitsToFloat(texels[i].z);
  l.coat_alpha = uintBitsToFloat(texels[i].w);
#endif
#endif
  l.chances = chances_of(l);
  return l;
}

// --- colours of the passes, and filtering -----------------------------------------------------------

vec3 lobes_color_diffuse(Lobes l) {
  vec3 color = l.diffuse;
#if LAYERS
  color += l.sheen;
#endif
  return color;
}

// Fresnel's factor is left out, as Cycles 3.4 does.
vec3 lobes_color_glossy(Lobes l) {
  vec3 color = vec3(0.0);
#if GLOSSY
  color = l.grazing;
#if LAYERS
  color += l.coat;
#endif
#endif
  return color;
}

// The mean of the lobes' normals, by how much each reflects.
vec3 lobes_normal(Lobes l) {
  vec3 sum = l.chances.diffuse * l.normal;
#if GLOSSY
  sum += l.chances.specular * l.specular_normal;
#endif
#if TRANSMISSION
  sum += l.chances.transmission * l.transmission_normal;
#endif
  return dot(sum, sum) > 0.0 ? normalize(sum) : l.smooth_normal;
}

// Whether light from behind the surface passes on to the viewer.
bool transmits(Lobes l) { return l.chances.transmission > 0.0; }

vec3 lobes_color_transmission(Lobes l) {
#if TRANSMISSION
  return l.transmission;
#else
  return vec3(0.0);
#endif
}

// Makes lobes as rough as `alpha` at least, which tames what is seen after a rough bounce (the
// filter of Cycles' Filter Glossy).
void blur_lobes(inout Lobes l, float alpha) {
#if GLOSSY
  l.alpha = max(l.alpha, alpha);
#if LAYERS
  l.coat_alpha = l.coat_alpha < 0.0 ? min(l.coat_alpha, -alpha) : max(l.coat_alpha, alpha);
#endif
#endif
#if TRANSMISSION
  l.transmission_alpha = max(l.transmission_alpha, alpha);
#endif
}
