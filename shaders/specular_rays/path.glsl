// Reading a path, and adding the light that it brings to its pixel.
#include "base/packing.glsl"
#include "gpu_scene/view_shared.h"
#include "specular_rays/path_shared.h"

layout(binding = 5) uniform samplerBuffer rays_in;    // as TracedRay
layout(binding = 7) uniform usamplerBuffer paths_in;  // as SpecularPath
// Light that was scattered once on its way to the camera (a: lobes that the ray stands for, and how
// it left the surface), and all other. Earlier programs have left what they read.
layout(binding = 0, rgba32f) writeonly uniform image2D direct_light;
layout(binding = 1, rgba32f) writeonly uniform image2D indirect_light;
layout(binding = 0) uniform sampler2D direct_before;
layout(binding = 1) uniform sampler2D indirect_before;

struct Path {
  vec3 throughput;
  float way;
  uint pixel, lobes;
};

Path fetch_path(uint i) {
  uvec4 texel0 = texelFetch(paths_in, int(i) * 2), texel1 = texelFetch(paths_in, int(i) * 2 + 1);
  return Path(uintBitsToFloat(texel0.xyz), uintBitsToFloat(texel0.w), texel1.x, texel1.y);
}

vec3 fetch_direction(uint i) { return texelFetch(rays_in, int(i) * 3 + 1).xyz; }

ivec2 pixel_of(Path path) {
  return ivec2(int(path.pixel) % view.size.x, int(path.pixel) / view.size.x);
}

// Call once a program.
void add_direct(Path path, vec3 light) {
  ivec2 pixel = pixel_of(path);
  imageStore(direct_light, pixel,
             texelFetch(direct_before, pixel, 0) + vec4(path.throughput * light, 0.0));
}

void add_indirect(Path path, vec3 light) {
  ivec2 pixel = pixel_of(path);
  imageStore(indirect_light, pixel,
             texelFetch(indirect_before, pixel, 0) + vec4(path.throughput * light, 0.0));
}

// The key of a path's random numbers: the same wherever the path stands in lists.
uint path_key(uint pixel) { return hash(frame.sampling.y ^ hash(pixel)); }
