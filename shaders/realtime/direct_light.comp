// Light from one batch of lamps, through their shadow maps, on every pixel that shows a surface.
// Adds to what earlier batches left.
#define G_BUFFER_READ 1
#include "rasterize/bins.glsl"
#include "rasterize/g_buffer.glsl"
#include "gpu_scene/lights_shared.h"
#include "realtime/brdf.glsl"
#if SHADOWS
#include "rasterize/shadow_lookup.glsl"
#endif

layout(local_size_x = 64) in;
layout(std430, binding = 3) readonly buffer Lights { Light lights[]; };
layout(binding = 0, rgba32f) writeonly uniform image2D diffuse_light;  // by the diffuse lobe
#if GLOSSY
layout(binding = 1, rgba32f) writeonly uniform image2D glossy_light;
#endif
// What earlier batches left.
layout(binding = 0) uniform sampler2D diffuse_before;
layout(binding = 1) uniform sampler2D glossy_before;
layout(location = 2) uniform uint first_light;
layout(location = 3) uniform uint light_count;

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

#if SHADOWS
  float random = unit_float(hash(pixels[i] + hash(uint(view.size.z) + hash(uint(view.size.w)))));
  Receiver receiver = Receiver(g.position, g.geometric_normal, g.smooth_normal, g.bulge, random);
#endif
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
#if SHADOWS
    if (light.shadow != NO_SHADOW) irradiance *= shadow(light, receiver, to_light);
#endif
    vec3 arriving = irradiance * incidence(g.smooth_normal, g.normal, to_light);
    diffuse += arriving * g.diffuse * diffuse_lobe(g.diffuse_roughness, g.normal, v, to_light);
#if GLOSSY
    glossy += arriving * glossy_lobe(g.specular, g.grazing, g.specular_ior, g.roughness, g.normal, v,
                                     to_light);
#endif
#if LAYERS
    diffuse += arriving * g.sheen * sheen_lobe(g.sheen_roughness, g.normal, v, to_light);
#if GLOSSY
    glossy += irradiance * incidence(g.smooth_normal, g.coat_normal, to_light) * g.coat *
              coat_lobe(g.coat_roughness, g.coat_normal, v, to_light);
#endif
#endif
  }
  vec4 before = texelFetch(diffuse_before, pixel, 0);
  imageStore(diffuse_light, pixel, vec4(before.rgb + diffuse, 1.0));
#if GLOSSY
  before = texelFetch(glossy_before, pixel, 0);
  imageStore(glossy_light, pixel, vec4(before.rgb + glossy, 1.0));
#endif
}
