// Light from all around on the surfaces where paths have ended.
#include "base/albedo.glsl"
#include "base/invocation.glsl"
#include "radiance_cache/ambient.glsl"
#include "specular_rays/end_surface.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Ended { uint ended[]; };
layout(location = 0) uniform uint count;

// World and bounced light together: both have been scattered more than once when they arrive.
vec3 all_of(Ambient light) { return light.world + light.bounced; }

void main() {
  uint i = invocation();
  if (i >= count) return;
  uint index = ended[i];
  Path path = fetch_path(index);
  EndSurface end = fetch_end(index);
  Lobes l = end.lobes;
  remove_lobes(l, path.lobes);
  vec3 position = end.position - frame.camera.xyz;
  Around here = look_around(position, l.geometric_normal);
  vec3 over = all_of(ambient_diffuse(here, l.normal));
  vec3 light = l.diffuse * diffuse_albedo(l.diffuse_roughness, dot(l.normal, l.view)) * over;
#if LAYERS
  light += l.sheen * sheen_albedo(l.sheen_roughness, dot(l.sheen_normal, l.view)) * over;
#endif
#if GLOSSY
  light += environment_reflectance(l.specular, l.grazing, sqrt(l.alpha),
                                   max(dot(l.specular_normal, l.view), 0.0)) *
           all_of(ambient_radiance(here, reflect(-l.view, l.specular_normal), sqrt(l.alpha)));
#if LAYERS
  light += environment_reflectance(vec3(l.coat * reflectance_from_ior(COAT_IOR)), vec3(l.coat),
                                   sqrt(abs(l.coat_alpha)), max(dot(l.coat_normal, l.view), 0.0)) *
           all_of(ambient_radiance(here, reflect(-l.view, l.coat_normal), sqrt(abs(l.coat_alpha))));
#endif
#endif
#if TRANSMISSION
  light += l.transmission * all_of(ambient_radiance(look_around(position, -l.geometric_normal), -l.view, 0.0));
#endif
  add_indirect(path, light);
}
