// One view's estimate of how occluded every pixel's surface is: the body of the loops of Algorithm 1.
#define G_BUFFER_READ 1
#include "rasterize/bins.glsl"
#include "rasterize/g_buffer.glsl"
#include "ambient_occlusion/estimate.glsl"
#if ESTIMATOR == ALCHEMY
#include "ambient_occlusion/alchemy.glsl"
#elif ESTIMATOR == SSAO
#include "ambient_occlusion/ssao.glsl"
#endif
#if ESTIMATOR == HBAO
#include "ambient_occlusion/hbao.glsl"
#elif ESTIMATOR == OBSCURANCE
#include "ambient_occlusion/obscurance.glsl"
#else
#include "ambient_occlusion/points.glsl"
#endif

layout(local_size_x = 64) in;
#if PROBES
layout(std430, binding = 3) writeonly buffer Probes { OcclusionProbe probes[]; };
layout(binding = 1) uniform sampler2D camera_depths;
#else
// x: occlusion, y: weight, z: samples relative to the most there may be; w: how much of the hemisphere
// is hidden from the view, 0..1
layout(binding = 0, rgba16f) writeonly uniform image2DArray estimates;
#if BENT_NORMALS
layout(binding = 1, rgba16f) writeonly uniform image2DArray closed_directions;
#endif
#endif

// (4.2), with two changes. The distance of a sample, clamped to r_max, stands in (4.3) for the doubt
// whether what is recorded belongs to the surface's surroundings; here a sample that the view sees, or
// sees blocked, has no distance, and any other one r_max: else what lies far behind an open sample,
// which is known to be open, would count against the view. And the direction scales the distance's
// weight in place of adding to it: else views that see nothing of the surface would say "open".
float view_weight(Sums sums, float facing) {
  float near = 1.0 - sums.unknown / max(sums.count, 1.0);
  return near * (occlusion.range.z + (1.0 - occlusion.range.z) * facing);
}

void main() {
  uint i = gl_GlobalInvocationID.x;
#if PROBES
  // One pixel of each so many, whatever it shows: the list's order is another one each time.
  uint index = i * occlusion.place.z + hash(i) % occlusion.place.z;
  ivec2 pixel = pixel_of(index);
  if (pixel.y >= view.size.y || texelFetch(camera_depths, pixel, 0).r <= 0.0) return;
#else
  if (i >= bins[material_count + 1u].count) return;
  uint index = pixels[i];
  ivec2 pixel = pixel_of(index);
#endif
  GBufferPixel g = read_g_buffer(pixel);
  Place p;
  p.position = g.position;
  p.normal = g.normal;
  uint key = hash(index + occlusion.samples.w);
  p.first = uvec3(key, hash(key + 1u), hash(key + 2u)) +
            occlusion.samples.z * uvec3(3518319153u, 2882110345u, 2360945575u);
  Face face = main_face(p.position);
  float facing = max(dot(towards_view(face), p.normal), 0.0);  // (4.4)

  Sums sums = Sums(0.0, 0.0, 0.0, vec3(0.0), 0.0);
#if IMPORTANCE
  uint initial = min(occlusion.samples.y, occlusion.samples.x);
  estimate(p, face, 0u, initial, sums);
  float more = float(occlusion.samples.x - initial) * view_weight(sums, facing) *
               0.5 * (1.0 + clamp(sums.occlusion / sums.count, 0.0, 1.0));  // (4.5)
  // Rounded by chance, so that its expectation is right, and for neighbours alike, since they run
  // together and the slowest holds the others up.
  uint block = uint(pixel.x >> 3) + (uint(pixel.y >> 3) << 16);
  float chance = unit_float(hash(block + hash(occlusion.samples.z + occlusion.samples.w)));
  estimate(p, face, initial, uint(more + chance), sums);
#else
  estimate(p, face, 0u, occlusion.samples.x, sums);
#endif
  float blocked = clamp(sums.occlusion / sums.count, 0.0, 1.0), weight = view_weight(sums, facing);
#if PROBES
  uint probe = i * occlusion.place.w + occlusion.place.x;
  probes[probe] = OcclusionProbe(blocked, weight, dot(g.position, view.axis.xyz), 1u);
#else
  ivec3 at = ivec3(pixel, occlusion.place.x);
  imageStore(estimates, at, vec4(blocked, weight, sums.count / float(occlusion.samples.x),
                                  sums.hidden / sums.count));
#if BENT_NORMALS
  imageStore(closed_directions, at, vec4(sums.closed / sums.count, 0.0));
#endif
#endif
}
