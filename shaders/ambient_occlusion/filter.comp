// Joint bilateral filter along one axis: a mean over pixels of nearly the same plane and direction.
#define G_BUFFER_READ 1
#include "rasterize/bins.glsl"
#include "rasterize/g_buffer.glsl"

layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler2D combined;
layout(binding = 1) uniform sampler2D depths;
layout(binding = 0, rgba16f) writeonly uniform image2D filtered;
layout(location = 2) uniform ivec2 axis;  // from tap to tap, pixels
layout(location = 3) uniform float reach;         // r_max, metres

const int TAPS = 4;  // on each side

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= bins[material_count + 1u].count) return;
  ivec2 pixel = pixel_of(pixels[i]);
  vec3 position = texelFetch(g_position, pixel, 0).xyz;
  vec3 normal = unpack_unit(texelFetch(g_normals, pixel, 0).x);
  vec4 sum = texelFetch(combined, pixel, 0);
  float weights = 1.0;
  for (int k = -TAPS; k <= TAPS; ++k) {
    ivec2 at = pixel + k * axis;
    bool there = k != 0 && all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, view.size.xy));
    at = clamp(at, ivec2(0), view.size.xy - 1);
    there = there && texelFetch(depths, at, 0).r > 0.0;
    vec3 between = texelFetch(g_position, at, 0).xyz - position;
    float apart = length(between);
    float facing = max(dot(normal, unpack_unit(texelFetch(g_normals, at, 0).x)), 0.0);
    facing *= facing;
    facing *= facing;
    float off_plane = abs(dot(between, normal)) / max(apart, 1.0e-30);
    // As far as occlusion is looked for it may change, so nothing is blurred by more than half of it.
    float near = float(k) / float(TAPS + 1), far = 2.0 * apart / reach;
    float weight = facing * facing * exp(-2.0 * near * near - 50.0 * off_plane * off_plane - far * far);
    if (!there) continue;
    sum += weight * texelFetch(combined, at, 0);
    weights += weight;
  }
  sum /= weights;
  float size = length(sum.xyz);
  imageStore(filtered, pixel, vec4(size > 1.0e-3 ? sum.xyz / size : normal, sum.w));
}
