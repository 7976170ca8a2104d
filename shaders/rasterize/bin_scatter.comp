#include "rasterize/bins.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 7) uniform usampler2D visibility;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, view.size.xy))) return;
  uint slot = atomicAdd(bins[bin_of(texelFetch(visibility, pixel, 0).x)].cursor, 1u);
  pixels[slot] = uint(pixel.y * view.size.x + pixel.x);
}
