// Light from all around on the surfaces where paths have ended: the world's.
#include "base/albedo.glsl"
#include "base/invocation.glsl"
#include "rasterize/world_light.glsl"
#include "specular_rays/end_surface.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Ended { uint ended[]; };
layout(location = 0) uniform uint count;

// What a white diffuse surface at `position`, about the camera, sends back of the light around it.
vec3 surrounding_light(vec3 position, vec3 normal) { return world_diffuse(normal); }

void main() {
  uint i = invocation();
  if (i >= count) return;
  uint index = ended[i];
  Path path = fetch_path(index);
  EndSurface end = fetch_end(index, path);
  Lobes l = end.lobes;
  vec3 position = end.position - frame.camera.xyz;
  vec3 over = surrounding_light(position, l.normal);
  vec3 light = l.diffuse * diffuse_albedo(l.diffuse_roughness, dot(l.normal, l.view)) * over;
#if LAYERS
  light += l.sheen * sheen_albedo(l.sheen_roughness, dot(l.sheen_normal, l.view)) * over;
#endif
#if GLOSSY
  light += environment_reflectance(l.specular, l.grazing, sqrt(l.alpha),
                                   max(dot(l.specular_normal, l.view), 0.0)) *
           surrounding_light(position, reflect(-l.view, l.specular_normal));
#if LAYERS
  light += environment_reflectance(vec3(l.coat * reflectance_from_ior(COAT_IOR)), vec3(l.coat),
                                   sqrt(abs(l.coat_alpha)), max(dot(l.coat_normal, l.view), 0.0)) *
           surrounding_light(position, reflect(-l.view, l.coat_normal));
#endif
#endif
#if TRANSMISSION
  light += l.transmission * surrounding_light(position, -l.view);
#endif
  add_indirect(path, light);
}
