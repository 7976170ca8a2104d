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
layout(binding = 13) uniform sampler2DArrayShadow shadow_maps;
#endif
layout(binding = 0, rgba32f) uniform image2D diffuse_light;  // reflected by the diffuse lobe
#if GLOSSY
layout(binding = 1, rgba32f) uniform image2D glossy_light;
#endif
layout(location = 2) uniform uint first_light;
layout(location = 3) uniform uint light_count;
layout(location = 4) uniform uint batch_first_face;  // the one in layer 0 of shadow_maps

#if SHADOWS
uint cube_face(vec3 from_light) {
  vec3 a = abs(from_light);
  if (a.x >= a.y && a.x >= a.z) return from_light.x >= 0.0 ? 0u : 1u;
  if (a.y >= a.z) return from_light.y >= 0.0 ? 2u : 3u;
  return from_light.z >= 0.0 ? 4u : 5u;
}

// The share of the light that arrives, 0..1. The look-up is moved off the surface by what one
// filtered texel can span on a plane that is tilted by theta, sqrt(2) * texel * sin(theta), and to
// the side of the surface that the light is on.
float shadow(Light light, GBufferPixel g, vec3 to_light) {
  vec3 from_light = light.type == LIGHT_SUN ? vec3(0.0) : g.position - light.position.xyz;
  uint face = light.shadow + (light.faces == 6u ? cube_face(from_light) : 0u);
  ShadowFace f = shadow_faces[face];
  vec3 position = g.position + g.smooth_normal * g.bulge;
  float along = f.texel.y > 0.5 ? (f.clip_from_relative * vec4(position, 1.0)).w : 1.0;
  float texel = f.texel.x * along;
  float cosine = dot(g.geometric_normal, to_light);
  float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
  // Rounding of the coordinates: a few units in the last place of the largest.
  float magnitude = max(max(abs(position.x), abs(position.y)), abs(position.z)) + abs(along);
  float offset = 1.5 * texel * sine + 4.0e-7 * magnitude;
  position += g.geometric_normal * (cosine < 0.0 ? -offset : offset);

  vec4 clip = f.clip_from_relative * vec4(position, 1.0);
  if (clip.w <= 0.0) return 1.0;
  vec3 ndc = clip.xyz / clip.w;
  if (any(greaterThan(abs(ndc.xy), vec2(1.0)))) return 1.0;
  // Depth is reversed: nearer is greater.
  float depth = ndc.z * (1.0 + f.tolerance.x) + f.tolerance.y;
  return texture(shadow_maps, vec4(ndc.xy * 0.5 + 0.5, float(face - batch_first_face), depth));
}
#endif

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
      irradiance /= squared + light.position.w * light.position.w;
      float cosine = -dot(to_light, light.axis.xyz);
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
  vec4 before = imageLoad(diffuse_light, pixel);
  imageStore(diffuse_light, pixel, vec4(before.rgb + diffuse * g.diffuse, 1.0));
#if GLOSSY
  before = imageLoad(glossy_light, pixel);
  imageStore(glossy_light, pixel, vec4(before.rgb + glossy, 1.0));
#endif
}
