// Lists the pixels whose surfaces mirror or refract in such a way that it takes a ray to show it, and
// notes which of their lobes the ray stands for.
#define G_BUFFER_READ 1
#include "base/albedo.glsl"
#include "base/color.glsl"
#include "rasterize/bins.glsl"
#include "rasterize/g_buffer.glsl"
#include "specular_rays/path_shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 3) buffer Counter { uint listed; };
layout(std430, binding = 4) writeonly buffer List { uint list[]; };
layout(binding = 0, rgba32f) writeonly uniform image2D direct_light;
layout(binding = 1, rgba32f) writeonly uniform image2D indirect_light;

// Of white light; less is not seen beside anything else.
const float LEAST = 1.0 / 512.0;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= bins[material_count + 1u].count) return;
  ivec2 pixel = pixel_of(pixels[i]);
  GBufferPixel g = read_g_buffer(pixel);
  vec3 v = -view_direction(vec2(pixel) + 0.5);

  uint lobes = 0u;
#if GLOSSY
  vec3 mirrored = environment_reflectance(g.specular, g.grazing, g.roughness, max(dot(g.normal, v), 0.0));
  if (g.roughness <= frame.roughness.x && luminance(abs(mirrored)) > LEAST) lobes |= FOLLOWS_SPECULAR;
#if LAYERS
  float coat = g.coat * fresnel_dielectric(dot(g.coat_normal, v), COAT_IOR);
  if (abs(g.coat_roughness) <= frame.roughness.x && abs(coat) > LEAST) lobes |= FOLLOWS_COAT;
#endif
#endif
#if TRANSMISSION
  if (luminance(abs(g.transmission)) > LEAST) lobes |= FOLLOWS_TRANSMISSION;
#endif
  imageStore(direct_light, pixel, vec4(vec3(0.0), float(lobes)));
  imageStore(indirect_light, pixel, vec4(0.0));
  if (lobes != 0u) list[atomicAdd(listed, 1u)] = pixels[i];
}
