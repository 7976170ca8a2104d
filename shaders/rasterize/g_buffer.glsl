// The G-buffer: what the camera sees, one surface a pixel.
#include "base/packing.glsl"

struct GBufferPixel {
  vec3 position;  // relative to the camera, metres
  float bulge;    // Hit::bulge, metres
  vec3 normal, smooth_normal, geometric_normal;  // unit, world axes
  vec3 diffuse;
  float diffuse_roughness;
  vec3 specular;
  float roughness;
  vec3 transmission;
};

#ifdef G_BUFFER_READ
layout(binding = 9) uniform sampler2D g_position;   // xyz, bulge
layout(binding = 10) uniform usampler2D g_normals;  // shading, smooth, geometric; packed transmission
layout(binding = 11) uniform sampler2D g_diffuse;   // albedo, roughness of the diffuse lobe
#if GLOSSY
layout(binding = 12) uniform sampler2D g_specular;  // reflectance at normal incidence, roughness
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
  g.transmission = unpackUnorm4x8(normals.w).rgb;
  g.diffuse = diffuse.rgb;
  g.diffuse_roughness = diffuse.a;
#if GLOSSY
  vec4 specular = texelFetch(g_specular, pixel, 0);
  g.specular = specular.rgb;
  g.roughness = specular.a;
#else
  g.specular = vec3(0.0);
  g.roughness = 1.0;
#endif
  return g;
}
#endif
