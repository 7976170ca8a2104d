// What surfaces send on of the light that falls on them. After gpu_scene/material.glsl.
#include "base/scattering.glsl"

// The share that all lobes but transmission reflect of light from the unit direction `way`, or towards
// it of light from all around.
vec3 reflectance(Surface surface, vec3 way) {
  float cosine = clamp(dot(surface.normal, way), 0.0, 1.0);
  return surface.diffuse * diffuse_albedo(surface.diffuse_roughness, cosine) +
         environment_reflectance(surface.specular, max(surface.grazing, surface.specular),
                                 surface.roughness, cosine) +
         surface.sheen * sheen_albedo(surface.sheen_roughness, cosine) +
         surface.coat * fresnel_dielectric(cosine, 1.5);
}
