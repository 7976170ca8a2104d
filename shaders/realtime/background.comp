// The world where no surface is seen.
#include "gpu_scene/world.glsl"
#include "rasterize/bins.glsl"

layout(local_size_x = 64) in;
layout(binding = 0, rgba32f) writeonly uniform image2D environment;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= bins[material_count].count) return;
  ivec2 pixel = pixel_of(pixels[bins[material_count].first + i]);
  imageStore(environment, pixel, vec4(finite_world(view_direction(vec2(pixel) + 0.5)), 1.0));
}
