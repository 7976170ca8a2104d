// Evaluates one material over its bin of pixels and writes the G-buffer.
#include "gpu_scene/material.glsl"
#include "generated/material.glsl"
#include "rasterize/bins.glsl"
#include "rasterize/g_buffer.glsl"

layout(local_size_x = 64) in;
layout(binding = 7) uniform usampler2D visibility;
layout(binding = 0, rgba32f) writeonly uniform image2D out_position;
layout(binding = 1, rgba32ui) writeonly uniform uimage2D out_normals;
layout(binding = 2, rgba16f) writeonly uniform image2D out_diffuse;
#if GLOSSY
layout(binding = 3, rgba16f) writeonly uniform image2D out_specular;
#endif
#if EMISSION
layout(binding = 4, rgba32f) writeonly uniform image2D out_emission;
#endif
#if TRANSMISSION
layout(binding = 5, rgba32ui) writeonly uniform uimage2D out_transmission;
#endif
#if LAYERS
layout(binding = 6, rgba32ui) writeonly uniform uimage2D out_layers;
#endif
layout(location = 2) uniform uint bin;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= bins[bin].count) return;
  ivec2 pixel = pixel_of(pixels[bins[bin].first + i]);
  uvec2 visible = texelFetch(visibility, pixel, 0).xy;
  DrawRecord record = records[visible.x - 1u];

  Hit hit = fetch_hit(view_ray(vec2(pixel) + 0.5), record.instance, visible.y);
  Surface surface = empty_surface();
  evaluate_material(hit, surface);
  finish_surface(hit, surface);

  imageStore(out_position, pixel, vec4(hit.position, hit.bulge));
  imageStore(out_normals, pixel,
             uvec4(pack_unit(surface.normal), pack_unit(surface.smooth_normal),
                   pack_unit(hit.geometric_normal),
                   pack_grazing(surface.grazing, surface.specular_ior)));
  imageStore(out_diffuse, pixel, vec4(surface.diffuse, surface.diffuse_roughness));
#if GLOSSY
  imageStore(out_specular, pixel, vec4(surface.specular, surface.roughness));
#endif
#if EMISSION
  imageStore(out_emission, pixel, vec4(surface.emission, 1.0));
#endif
#if TRANSMISSION
  imageStore(out_transmission, pixel,
             pack_transmission(surface.transmission, surface.transmission_roughness, surface.ior));
#endif
#if LAYERS
  imageStore(out_layers, pixel,
             pack_layers(surface.coat, surface.coat_roughness, surface.coat_normal, surface.sheen,
                         surface.sheen_roughness));
#endif
}
