// What generated material code calls: parameters, images, normal maps and closures.
//
// evaluate_material(hit, surface) adds closures to a Surface. A Surface holds one lobe of each kind;
// several closures of a kind are merged, colours by sum, roughness and normal by weight, which is
// exact for a single closure and a fair approximation for a mix.
#include "base/color.glsl"
#include "gpu_scene/geometry.glsl"

layout(binding = 6) uniform samplerBuffer material_params;
#if IMAGE_COUNT > 0
layout(binding = 8) uniform sampler2D material_images[IMAGE_COUNT];
#endif
// x: first vec4 of the material's parameters; y: first word of its attribute names in `tables`;
// z: bit i is set where image i holds sRGB codes.
layout(location = 0) uniform uvec3 material_block;

#define ATTRIBUTE(n) int(table(int(material_block.y) + (n)))

vec4 param(int i) { return texelFetch(material_params, int(material_block.x) + i); }

// --- images -----------------------------------------------------------------------------------------

// The triangle's two edges in texture coordinates; false where the mesh has no UV map of that name.
bool uv_edges(Hit hit, int name, out vec2 edge1, out vec2 edge2) {
  uint word = table(hit.mesh + MESH_ATTRIBUTES + name);
  edge1 = edge2 = vec2(0.0);
  if (word == NO_ATTRIBUTE || (word & IS_COLOR) != 0u) return false;
  int i = int(word) + (hit.triangle - int(table(hit.mesh + MESH_TRIANGLE_BASE))) * 3;
  vec2 uv = texelFetch(corner_attributes, i).xy;
  edge1 = texelFetch(corner_attributes, i + 1).xy - uv;
  edge2 = texelFetch(corner_attributes, i + 2).xy - uv;
  return true;
}

// How far texture coordinates run along one metre of the surface.
float uv_per_metre(Hit hit) {
  vec2 d1, d2;
  if (!uv_edges(hit, UV_DEFAULT, d1, d2) || !(hit.area > 0.0)) return 0.0;
  return sqrt(abs(d1.x * d2.y - d1.y * d2.x) / hit.area);
}

// Codes are filtered as they are and linearised afterwards, as Cycles does with 8-bit images.
// The texture level from the pixel's footprint (ray cones, Akenine-Moller et al. 2019), along the
// narrow axis: what the wide axis needs at grazing angles comes from the samples of the pixel.
vec4 sample_image_at(sampler2D image, bool srgb, Hit hit, vec2 uv, bool unassociate) {
  vec2 extent = vec2(textureSize(image, 0));
  float texels = hit.footprint * uv_per_metre(hit) * sqrt(extent.x * extent.y);
  vec4 color = textureLod(image, uv, max(log2(max(texels, 1.0e-6)) + view.filtering.x, 0.0));
  if (unassociate && color.a > 0.0) color.rgb /= color.a;
  if (srgb) color.rgb = linear_from_srgb(color.rgb);
  return color;
}
// Images beyond what the driver allows share the last unit, which shows a missing one.
#define sample_image(hit, index, uv, unassociate)                                              \
  sample_image_at(material_images[min(index, IMAGE_COUNT - 1)],                                \
                  ((material_block.z >> min(index, IMAGE_COUNT - 1)) & 1u) != 0u, hit, uv,     \
                  unassociate)

// --- normal maps ------------------------------------------------------------------------------------

// Turns `n` towards the geometric normal until the mirrored view direction leaves the surface: no
// normal, mapped or interpolated, may reflect what is below the horizon (Cycles corrects every
// closure's normal so). In the plane of `n` and `ng`, with the angle a taken from ng, the mirrored
// direction's height is Ix sin 2a + Iz cos 2a; it is set to the threshold and solved for a.
vec3 keep_reflection_above(vec3 ng, vec3 v, vec3 n) {
  float height = dot(ng, v);
  float threshold = min(0.9 * height, 0.01);
  vec3 mirrored = 2.0 * dot(n, v) * n - v;
  if (dot(ng, mirrored) >= threshold) return n;
  vec3 x = n - dot(n, ng) * ng;
  float sine = length(x);
  if (sine < 1.0e-6) return ng;
  x /= sine;
  float ix = dot(v, x);
  float amplitude = sqrt(ix * ix + height * height);
  if (amplitude < 1.0e-12) return ng;
  float angle = 0.5 * (atan(ix, height) + acos(clamp(threshold / amplitude, -1.0, 1.0)));
  return sin(angle) * x + cos(angle) * ng;
}

vec3 finish_normal_map(Hit hit, vec3 n, float strength) {
  if (hit.backfacing) n = -n;
  n = safe_normalize(n, hit.normal);
  return safe_normalize(mix(hit.normal, n, max(strength, 0.0)), hit.normal);
}

vec3 normal_map_tangent(Hit hit, int uv_attribute, vec3 color, float strength) {
  vec2 d1, d2;
  if (!uv_edges(hit, uv_attribute, d1, d2)) return hit.normal;
  float handedness = d1.x * d2.y - d1.y * d2.x < 0.0 ? -1.0 : 1.0;
  vec3 n = hit.normal_unflipped;
  vec3 t = (hit.edge1 * d2.y - hit.edge2 * d1.y) * handedness;
  // Coordinates without an area give no direction; Cycles then takes the object's X axis.
  if (d1.x * d2.y == d1.y * d2.x) t = fetch_transform(hit.instance, vec3(0.0)).linear[0];
  t = safe_normalize(t - n * dot(n, t), vec3(0.0));
  vec3 b = cross(n, t) * handedness * hit.handedness;
  vec3 c = color * 2.0 - 1.0;
  return finish_normal_map(hit, c.x * t + c.y * b + c.z * n, strength);
}

vec3 normal_map_object(Hit hit, vec3 color, float strength) {
  mat3 linear = fetch_transform(hit.instance, vec3(0.0)).linear;
  return finish_normal_map(hit, cofactors(linear) * (color * 2.0 - 1.0) * hit.handedness, strength);
}

vec3 normal_map_world(Hit hit, vec3 color, float strength) {
  return finish_normal_map(hit, color * 2.0 - 1.0, strength);
}

// --- closures ---------------------------------------------------------------------------------------

struct Surface {
  vec3 diffuse;             // albedo
  float diffuse_roughness;  // of Burley's lobe; LAMBERT for none
  vec3 specular;            // reflectance at normal incidence
  float roughness;          // of the specular lobe, 0..1 as artists set it
  vec3 transmission;        // what passes through with refraction
  vec3 transparency;        // what passes straight through
  vec3 emission;            // radiance
  vec3 normal;              // unit once finished
  float weight;             // of the lobes that have a normal and a roughness
};

const float LAMBERT = -1.0;

Surface empty_surface() {
  return Surface(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0.0);
}

void merge_lobe(inout Surface s, float amount, float roughness, float diffuse_roughness,
                vec3 normal) {
  s.weight += amount;
  s.roughness += amount * roughness;
  s.diffuse_roughness += amount * diffuse_roughness;
  s.normal += amount * normal;
}

// What is not finite, for whatever reason, counts as nothing.
float finite(float x) { return abs(x) <= 1.0e30 ? x : 0.0; }
vec3 finite(vec3 v) { return vec3(finite(v.x), finite(v.y), finite(v.z)); }

// Divides the merged quantities by their weights. Alpha is stochastic, so what a pixel keeps is
// what the surface does where it is not transparent.
void finish_surface(Hit hit, inout Surface s) {
  float inverse = s.weight > 0.0 ? 1.0 / s.weight : 0.0;
  s.roughness *= inverse;
  s.diffuse_roughness *= inverse;
  s.normal = keep_reflection_above(hit.geometric_normal, hit.view,
                                   safe_normalize(s.normal, hit.normal));
  s.diffuse = finite(s.diffuse);
  s.specular = finite(s.specular);
  s.transmission = finite(s.transmission);
  s.emission = finite(s.emission);
  s.roughness = clamp(finite(s.roughness), 0.0, 1.0);
  s.diffuse_roughness = clamp(finite(s.diffuse_roughness), LAMBERT, 1.0);
#if ALPHA
  float alpha = 1.0 - luminance(s.transparency);
  float scale = alpha > 0.0 ? 1.0 / alpha : 0.0;
  s.diffuse *= scale;
  s.specular *= scale;
  s.transmission *= scale;
  s.emission *= scale;
#endif
}

void closure_diffuse(inout Surface s, vec3 weight, vec3 color, float roughness, vec3 normal) {
  s.diffuse += weight * color;
  merge_lobe(s, luminance(weight), 1.0, LAMBERT, normal);
}

void closure_glossy(inout Surface s, vec3 weight, vec3 color, float roughness, vec3 normal) {
  s.specular += weight * color;
  merge_lobe(s, luminance(weight), roughness, LAMBERT, normal);
}

float reflectance_from_ior(float ior) {
  float r = (ior - 1.0) / (ior + 1.0);
  return r * r;
}

void closure_glass(inout Surface s, vec3 weight, vec3 color, float roughness, float ior,
                   vec3 normal) {
  float f0 = reflectance_from_ior(max(ior, 1.0e-3));
  s.specular += weight * color * f0;
  s.transmission += weight * color * (1.0 - f0);
  merge_lobe(s, luminance(weight), roughness, LAMBERT, normal);
}

void closure_refraction(inout Surface s, vec3 weight, vec3 color, float roughness, float ior,
                        vec3 normal) {
  s.transmission += weight * color;
  merge_lobe(s, luminance(weight), roughness, LAMBERT, normal);
}

void closure_transparent(inout Surface s, vec3 weight, vec3 color) {
  s.transparency += weight * color;
}

void closure_emission(inout Surface s, vec3 weight, vec3 radiance) {
  s.emission += weight * radiance;
}

struct Principled {
  vec3 base_color;
  float metallic, roughness, specular, specular_tint, transmission, ior, alpha;
  vec3 emission;
  float clearcoat, clearcoat_roughness, sheen;
  vec3 normal;
};

Principled principled_defaults(Hit hit) {
  return Principled(vec3(0.8), 0.0, 0.5, 0.5, 0.0, 0.0, 1.45, 1.0, vec3(0.0), 0.0, 0.03, 0.0,
                    hit.normal);
}

void closure_principled(inout Surface s, vec3 weight, Principled p, float f0,
                        float diffuse_roughness) {
  s.transparency += weight * (1.0 - p.alpha);
  weight *= p.alpha;
  s.emission += weight * p.emission;

  float dielectric = 1.0 - p.metallic;
  float transmitted = dielectric * p.transmission;
  s.diffuse += weight * p.base_color * (dielectric - transmitted);

  float brightest = luminance(p.base_color);
  vec3 tint = mix(vec3(1.0), brightest > 0.0 ? p.base_color / brightest : vec3(1.0),
                  p.specular_tint);
  s.specular += weight * (p.base_color * p.metallic + dielectric * (1.0 - p.transmission) * f0 * tint);

  float glass_f0 = reflectance_from_ior(max(p.ior, 1.0e-3));
  s.specular += weight * p.base_color * transmitted * glass_f0;
  s.transmission += weight * p.base_color * transmitted * (1.0 - glass_f0);
  merge_lobe(s, luminance(weight), p.roughness, diffuse_roughness, p.normal);
}

// Blender before 4.0: Burley's diffuse lobe, reflectance .08 * specular.
void closure_principled_v3(inout Surface s, vec3 weight, Principled p) {
  closure_principled(s, weight, p, 0.08 * p.specular, p.roughness);
}

// Blender 4.0 and later: Lambert's diffuse lobe, reflectance from the index of refraction, scaled by
// twice the specular level.
void closure_principled_v4(inout Surface s, vec3 weight, Principled p) {
  closure_principled(s, weight, p,
                     min(2.0 * p.specular * reflectance_from_ior(max(p.ior, 1.0e-3)), 1.0), LAMBERT);
}
