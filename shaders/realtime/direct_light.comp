// Light from one batch of lamps, through their shadow maps, on every pixel that shows a surface.
// Adds to what earlier batches left.
#define G_BUFFER_READ 1
#include "rasterize/bins.glsl"
#include "rasterize/g_buffer.glsl"
#include "gpu_scene/lights_shared.h"
#include "realtime/brdf.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 3) readonly buffer Lights { Light lights[]; };
#if SHADOWS
layout(std430, binding = 4) readonly buffer ShadowFaces { ShadowFace shadow_faces[]; };
layout(binding = 13) uniform sampler2DArray shadow_maps;  // reversed depth
#endif
layout(binding = 0, rgba32f) writeonly uniform image2D diffuse_light;  // by the diffuse lobe
#if GLOSSY
layout(binding = 1, rgba32f) writeonly uniform image2D glossy_light;
#endif
// What earlier batches left.
layout(binding = 0) uniform sampler2D diffuse_before;
layout(binding = 1) uniform sampler2D glossy_before;
layout(location = 2) uniform uint first_light;
layout(location = 3) uniform uint light_count;

#if SHADOWS
uint cube_face(vec3 from_light) {
  vec3 a = abs(from_light);
  if (a.x >= a.y && a.x >= a.z) return from_light.x >= 0.0 ? 0u : 1u;
  if (a.y >= a.z) return from_light.y >= 0.0 ? 2u : 3u;
  return from_light.z >= 0.0 ? 4u : 5u;
}

// How far a surface may rise from texel to texel, in texels, before its slope counts no further.
const float STEEPEST = 256.0;

// The share of the light that arrives, 0..1: the mean of the four nearest texels, each compared with
// the depth at which its own ray meets the receiver's plane. So a tilted plane neither shades itself
// nor shifts the edges that others cast on it; what remains, the surface's curvature and the
// texel's own tilt, is covered by moving the receiver towards the light by a part of a texel.
float shadow(Light light, GBufferPixel g, vec3 to_light) {
  vec3 from_light = light.type == LIGHT_SUN ? vec3(0.0) : g.position - light.position.xyz;
  uint face = light.shadow + (light.faces == 6u ? cube_face(from_light) : 0u);
  ShadowFace f = shadow_faces[face];
  float layer = f.half_extent.z;
  if (layer < 0.0) return 1.0;  // nothing stands there that could cast or catch a shadow
  bool perspective = f.axis.w > 0.5;
  vec3 n = g.geometric_normal;
  float cosine = dot(n, to_light);
  // Near the terminator the look-up moves to the smooth surface that the normals describe; the
  // range over which it does is Cycles'.
  float smooth_cosine = dot(g.smooth_normal, to_light);
  float amount = smooth_cosine < 0.1 ? 2.0 - (cosine + smooth_cosine) / 0.1 : 1.0 - cosine / 0.1;
  vec3 p = g.position + g.smooth_normal * (g.bulge * clamp(amount, 0.0, 1.0)) - f.origin.xyz;
  // Facets that see the light edge-on stand in each other's way: lift them off by a texel.
  float distance_along = perspective ? dot(p, f.axis.xyz) : 1.0;
  p += g.smooth_normal * (f.origin.w * distance_along * clamp(1.0 - 50.0 * cosine, 0.0, 1.0));
  float depth = dot(p, f.axis.xyz);
  float spread = perspective ? depth : 1.0;
  if (spread <= 0.0) return 1.0;
  vec2 shift = vec2(f.x.w, f.y.w);
  vec2 ndc = vec2(dot(p, f.x.xyz), dot(p, f.y.xyz)) / spread - shift;
  if (any(greaterThan(abs(ndc), vec2(1.0)))) return 1.0;

  float resolution = f.half_extent.w;
  vec2 place = (ndc * 0.5 + 0.5) * resolution - 0.5;
  vec2 corner = floor(place), fraction = place - corner;
  vec4 stored = textureGather(shadow_maps, vec3((corner + 1.0) / float(textureSize(shadow_maps, 0).x), layer));

  // The plane in the map's frame, per unit of the map's coordinates; depths are taken relative to
  // the receiver's, since the normal is not exact enough for the plane's distance from the lamp.
  float along = perspective ? dot(n, p) / depth : dot(n, f.axis.xyz);
  vec2 slope = vec2(dot(n, f.x.xyz) * f.half_extent.x * f.half_extent.x,
                    dot(n, f.y.xyz) * f.half_extent.y * f.half_extent.y);
  float texel = f.origin.w * spread;
  float tangent = sqrt(max(1.0 - cosine * cosine, 0.0)) / max(abs(cosine), 1.0e-6);
  float magnitude = max(max(abs(p.x), abs(p.y)), abs(p.z));
  float bias = texel * (0.5 + 0.25 * min(tangent, 2.0)) + 1.0e-6 * magnitude;
  float reach = STEEPEST * texel;

  const vec2 taps[4] = vec2[4](vec2(0.0, 1.0), vec2(1.0, 1.0), vec2(1.0, 0.0), vec2(0.0, 0.0));
  float lit = 0.0;
  for (int i = 0; i < 4; ++i) {
    float across = dot((taps[i] - fraction) * (2.0 / resolution), slope);
    float met = perspective ? depth * along / (along + across) : depth - across / along;
    // A plane seen edge-on is met nowhere.
    if (!(abs(met - depth) <= reach)) met = met > depth ? depth + reach : depth - reach;
    met = max(met - bias, f.depth.z);
    // The plane may go on behind the far end, where the map says that nothing is.
    float z = max(perspective ? f.depth.x / met + f.depth.y : f.depth.x * met + f.depth.y, 0.0);
    vec2 weight = mix(1.0 - fraction, fraction, taps[i]);
    lit += weight.x * weight.y * (z >= stored[i] ? 1.0 : 0.0);
  }
  return lit;
}
#endif

vec3 safe_unit(vec3 v, vec3 otherwise) {
  float squared = dot(v, v);
  return squared > 0.0 ? v * inversesqrt(squared) : otherwise;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= bins[material_count + 1u].count) return;
  ivec2 pixel = pixel_of(pixels[i]);
  GBufferPixel g = read_g_buffer(pixel);
  vec3 v = -view_direction(vec2(pixel) + 0.5);

  vec3 diffuse = vec3(0.0), glossy = vec3(0.0);
  for (uint k = first_light; k < first_light + light_count; ++k) {
    Light light = lights[k];
    vec3 to_light = -light.axis.xyz;
    vec3 irradiance = light.power.xyz;
    if (light.type != LIGHT_SUN) {
      vec3 d = light.position.xyz - g.position;
      float squared = max(dot(d, d), 1.0e-20);
      to_light = d * inversesqrt(squared);
      float least = light.position.w * light.position.w;
      float cosine = -dot(to_light, light.axis.xyz);
      if (light.type == LIGHT_MESH)
        irradiance = (cosine > 0.0 ? irradiance : light.center.xyz) * abs(cosine) /
                     max(squared, least);
      else
        irradiance /= squared + least;
      // Points with a radius are disks that face whatever they light.
      if (light.type == LIGHT_POINT)
        irradiance *= max(dot(safe_unit(light.center.xyz - g.position, to_light), to_light), 0.0);
      if (light.type == LIGHT_SPOT) irradiance *= spot_falloff(light.cone.xy, cosine);
      if (light.type == LIGHT_AREA) irradiance *= area_falloff(light.cone.xy, cosine);
    }
    // Zero-length directions and absurd energies must not become NaN.
    irradiance = clamp(irradiance, vec3(-1.0e30), vec3(1.0e30));
    float lit = bump_shadowing(g.smooth_normal, g.normal, to_light) *
                max(dot(g.normal, to_light), 0.0);
#if SHADOWS
    if (light.shadow != NO_SHADOW) lit *= shadow(light, g, to_light);
#endif
    vec3 arriving = irradiance * lit;
    diffuse += arriving * diffuse_lobe(g.diffuse_roughness, g.normal, v, to_light);
#if GLOSSY
    glossy += arriving * glossy_lobe(g.specular, g.roughness, g.normal, v, to_light);
#endif
  }
  vec4 before = texelFetch(diffuse_before, pixel, 0);
  imageStore(diffuse_light, pixel, vec4(before.rgb + diffuse * g.diffuse, 1.0));
#if GLOSSY
  before = texelFetch(glossy_before, pixel, 0);
  imageStore(glossy_light, pixel, vec4(before.rgb + glossy, 1.0));
#endif
}
