// The G-buffer: what the camera sees, one surface a pixel.
#include "base/packing.glsl"

struct GBufferPixel {
  vec3 position;  // relative to the camera, metres
  float bulge;    // Hit::bulge, metres
  vec3 normal, smooth_normal, geometric_normal;  // unit, world axes
  vec3 diffuse;
  float diffuse_roughness;
  vec3 specular, grazing;  // reflectance at normal incidence and at grazing angles
  float specular_ior;
  float roughness;
  vec3 transmission;
  float transmission_roughness, ior;
  float coat, coat_roughness;
  vec3 coat_normal;
  vec3 sheen;
  float sheen_roughness;
};

// Grazing reflectance and the index of refraction, 1 to 3, in eight bits each.
uint pack_grazing(vec3 grazing, float ior) {
  return packUnorm4x8(vec4(grazing, 0.5 * (ior - 1.0)));
}

uvec4 pack_transmission(vec3 amount, float roughness, float ior) {
  return uvec4(packHalf2x16(amount.rg), packHalf2x16(vec2(amount.b, roughness)),
               floatBitsToUint(ior), 0u);
}

uvec4 pack_layers(float coat, float coat_roughness, vec3 coat_normal, vec3 sheen,
                  float sheen_roughness) {
  return uvec4(pack_unit(coat_normal), packHalf2x16(vec2(coat, coat_roughness)),
               packHalf2x16(sheen.rg), packHalf2x16(vec2(sheen.b, sheen_roughness)));
}

#ifdef G_BUFFER_READ
layout(binding = 9) uniform sampler2D g_position;   // xyz, bulge
layout(binding = 10) uniform usampler2D g_normals;  // shading, smooth, geometric; pack_grazing()
layout(binding = 11) uniform sampler2D g_diffuse;   // albedo, roughness of the diffuse lobe
#if GLOSSY
layout(binding = 12) uniform sampler2D g_specular;  // reflectance at normal incidence, roughness
#endif
#if TRANSMISSION
layout(binding = 14) uniform usampler2D g_transmission;  // pack_transmission()
#endif
#if LAYERS
layout(binding = 15) uniform usampler2D g_layers;  // pack_layers()
#endif

GBufferPixel read_g_buffer(ivec2 pixel) {
  GBufferPixel g;
  vec4 position = texelFetch(g_position, pixel, 0);
  uvec4 normals = texelFetch(g_normals, pixel, 0);
  vec4 diffuse = texelFetch(g_diffuse, pixel, 0);
  g.position = position.xyz;
  g.bulge = position.w;
  g.normal = unpack_unit(normals.x);
  g.smooth_normal = unpack_unit(normals.y);
  g.geometric_normal = unpack_unit(normals.z);
  g.diffuse = diffuse.rgb;
  g.diffuse_roughness = diffuse.a;
#if GLOSSY
  vec4 specular = texelFetch(g_specular, pixel, 0);
  vec4 grazing = unpackUnorm4x8(normals.w);
  g.specular = specular.rgb;
  g.grazing = max(grazing.rgb, specular.rgb);
  g.specular_ior = 1.0 + 2.0 * grazing.a;
  g.roughness = specular.a;
#else
  g.specular = g.grazing = vec3(0.0);
  g.specular_ior = 1.0;
  g.roughness = 1.0;
#endif
  g.transmission = vec3(0.0);
  g.transmission_roughness = 0.0;
  g.ior = 1.0;
#if TRANSMISSION
  uvec4 transmission = texelFetch(g_transmission, pixel, 0);
  g.transmission.rg = unpackHalf2x16(transmission.x);
  vec2 rest = unpackHalf2x16(transmission.y);
  g.transmission.b = rest.x;
  g.transmission_roughness = rest.y;
  g.ior = uintBitsToFloat(transmission.z);
#endif
  g.coat = g.coat_roughness = g.sheen_roughness = 0.0;
  g.coat_normal = g.normal;
  g.sheen = vec3(0.0);
#if LAYERS
  uvec4 layers = texelFetch(g_layers, pixel, 0);
  vec2 coat = unpackHalf2x16(layers.y), sheen = unpackHalf2x16(layers.w);
  g.coat_normal = unpack_unit(layers.x);
  g.coat = coat.x;
  g.coat_roughness = coat.y;
  g.sheen = vec3(unpackHalf2x16(layers.z), sheen.x);
  g.sheen_roughness = sheen.y;
#endif
  return g;
}
#endif
