// (4.1): the views' estimates into one, and the direction from which most light comes.
#define G_BUFFER_READ 1
#include "rasterize/bins.glsl"
#include "rasterize/g_buffer.glsl"

layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler2DArray estimates;
#if BENT_NORMALS
layout(binding = 1) uniform sampler2DArray closed_directions;
#endif
layout(binding = 0, rgba16f) writeonly uniform image2D combined;  // bent normal, visibility
layout(location = 2) uniform ivec2 layers;  // first, one past the last

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= bins[material_count + 1u].count) return;
  ivec2 pixel = pixel_of(pixels[i]);
  vec4 sum = vec4(0.0);
  float weights = 0.0;
  for (int k = layers.x; k < layers.y; ++k) {
    vec2 estimate = texelFetch(estimates, ivec3(pixel, k), 0).xy;
    weights += estimate.y;
    sum.w += estimate.y * estimate.x;
#if BENT_NORMALS
    sum.xyz += estimate.y * texelFetch(closed_directions, ivec3(pixel, k), 0).xyz;
#endif
  }
  // Where no view can be trusted the first one's estimate stands: the camera's.
  if (weights > 0.0) {
    sum /= weights;
  } else {
    sum.w = texelFetch(estimates, ivec3(pixel, layers.x), 0).x;
#if BENT_NORMALS
    sum.xyz = texelFetch(closed_directions, ivec3(pixel, layers.x), 0).xyz;
#endif
  }
  vec3 normal = unpack_unit(texelFetch(g_normals, pixel, 0).x);
#if BENT_NORMALS
  // Of an open hemisphere the mean direction by the cosine is 2/3 of the normal.
  vec3 open = 2.0 / 3.0 * normal - sum.xyz;
  float size = length(open);
  normal = size > 1.0e-3 ? open / size : normal;
#endif
  imageStore(combined, pixel, vec4(normal, 1.0 - sum.w));
}
