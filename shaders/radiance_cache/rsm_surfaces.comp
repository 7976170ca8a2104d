// One face of a lamp's reflective shadow map, where it shows one material (thesis, section 5.2, "RSM
// Sampling"): where the lamp's light meets a surface first, and the flux that the surface sends on.
#include "gpu_scene/material.glsl"
#include "generated/material.glsl"
#include "radiance_cache/reflectance.glsl"
#include "rasterize/bins.glsl"
#include "rasterize/lamp_light.glsl"

layout(local_size_x = 64) in;
layout(binding = 7) uniform usampler2D visibility;
// A texel each: position (m, relative to the list of triangles' origin) and pack_unit(normal); flux
// in watts, as pack_light().
layout(std430, binding = 4) writeonly buffer Places { uvec4 map_places[]; };
layout(std430, binding = 5) writeonly buffer Flux { uint map_flux[]; };
layout(location = 2) uniform uint bin;
layout(location = 3) uniform uint lamp;
layout(location = 4) uniform vec3 to_lamps;  // from positions in this view to those of lamps
layout(location = 5) uniform vec3 to_list;   // and to those of the list of triangles

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= bins[bin].count) return;
  uint texel = pixels[bins[bin].first + i];
  ivec2 pixel = pixel_of(texel);
  uvec2 visible = texelFetch(visibility, pixel, 0).xy;
  DrawRecord record = records[visible.x - 1u];

  Ray ray = view_ray(vec2(pixel) + 0.5);
  Hit hit = fetch_hit(ray, record.instance, visible.y);
  Surface surface = empty_surface();
  evaluate_material(hit, surface);
  finish_surface(hit, surface);

  vec3 to_light;
  vec3 irradiance = unshadowed_light(lights[lamp], hit.position + to_lamps, to_light);
  // What the texel sees of a surface that is square to its ray: the cosines of surfaces that are not
  // cancel, since of these it sees more and each part is lit less.
  float area = view.filtering.y * view.filtering.y;
  if (view.filtering.z > 0.5) {
    float cosine = inversesqrt(dot(ray.direction, ray.direction));
    area *= cosine * cosine * cosine * dot(hit.position, hit.position);
  }
  bool sends = (fetch_visibility(record.instance) & SEEN_BY_DIFFUSE) != 0u;
  vec3 flux = sends ? irradiance * area * reflectance(surface, hit.view) : vec3(0.0);
  map_places[texel] = uvec4(floatBitsToUint(hit.position + to_list), pack_unit(hit.geometric_normal));
  map_flux[texel] = pack_light(finite(flux));
}
