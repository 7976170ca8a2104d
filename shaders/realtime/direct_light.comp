// Light from one batch of lamps, through their shadow maps, on every pixel that shows a surface.
// Adds to what earlier batches left.
#define G_BUFFER_READ 1
#include "rasterize/bins.glsl"
#include "rasterize/g_buffer.glsl"
#include "rasterize/lamp_light.glsl"
#include "realtime/brdf.glsl"
#include "specular_rays/path_shared.h"

layout(local_size_x = 64) in;
layout(binding = 0, rgba32f) writeonly uniform image2D diffuse_light;  // by the diffuse lobe
#if GLOSSY
layout(binding = 1, rgba32f) writeonly uniform image2D glossy_light;
#endif
// What earlier batches left.
layout(binding = 0) uniform sampler2D diffuse_before;
layout(binding = 1) uniform sampler2D glossy_before;
#if SPECULAR_RAYS
layout(binding = 6) uniform sampler2D traced;  // a: FOLLOWS bits
#endif
layout(location = 2) uniform uint first_light;
layout(location = 3) uniform uint light_count;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= bins[material_count + 1u].count) return;
  ivec2 pixel = pixel_of(pixels[i]);
  GBufferPixel g = read_g_buffer(pixel);
  vec3 v = -view_direction(vec2(pixel) + 0.5);

  float random = unit_float(hash(pixels[i] + hash(uint(view.size.z) + hash(uint(view.size.w)))));
  Receiver receiver = Receiver(g.position, g.geometric_normal, g.smooth_normal, g.bulge, random);
  uint followed = 0u;
#if SPECULAR_RAYS
  followed = uint(texelFetch(traced, pixel, 0).a);
#endif
  vec3 diffuse = vec3(0.0), glossy = vec3(0.0);
  for (uint k = first_light; k < first_light + light_count; ++k) {
    vec3 to_light;
    Light light = lights[k];
    vec3 irradiance = unshadowed_light(light, g.position, to_light);
    float incident = incidence(g.smooth_normal, g.normal, to_light);
    float lit = incident;
#if LAYERS && GLOSSY
    float incident_coat = incidence(g.smooth_normal, g.coat_normal, to_light);
    lit += incident_coat;
#endif
    // Half of most surfaces turns away from a lamp: no need to look who else stands in its light.
    if (lit == 0.0 || irradiance == vec3(0.0)) continue;
    irradiance *= arriving_share(light, receiver, to_light);
    vec3 arriving = irradiance * incident;
    diffuse += arriving * g.diffuse * diffuse_lobe(g.diffuse_roughness, g.normal, v, to_light);
#if GLOSSY
    // Rays meet glowing surfaces themselves.
    uint met = light.type == LIGHT_MESH ? followed : 0u;
    if ((met & FOLLOWS_SPECULAR) == 0u)
      glossy += arriving * glossy_lobe(g.specular, g.grazing, g.specular_ior, g.roughness, g.normal,
                                       v, to_light);
#endif
#if LAYERS
    diffuse += arriving * g.sheen * sheen_lobe(g.sheen_roughness, g.normal, v, to_light);
#if GLOSSY
    if ((met & FOLLOWS_COAT) == 0u)
      glossy += irradiance * incident_coat * g.coat *
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
