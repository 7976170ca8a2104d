// One view's estimate of how occluded every pixel's surface is: the body of the loops of Algorithm 1.
#define G_BUFFER_READ 1
#include "gpu_scene/view_shared.h"
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

// Large groups: on llvmpipe a group costs about as much as a sample of 64 pixels.
const uint TILE = 16u;
layout(local_size_x = 16, local_size_y = 16) in;
layout(binding = 1) uniform sampler2D camera_depths;
#if PROBES
layout(std430, binding = 3) writeonly buffer Probes { OcclusionProbe probes[]; };
#else
// x: occlusion, y: weight, z: samples relative to the most there may be; w: how much of the hemisphere
// is hidden from the view, 0..1
layout(binding = 0, rgba16f) writeonly uniform image2DArray estimates;
#if BENT_NORMALS
layout(binding = 1, rgba16f) writeonly uniform image2DArray closed_directions;
#endif
#if PHANTOM
layout(binding = 2) uniform sampler2DArray earlier_estimates;
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

// What hides a surface from a view may stand over it, as a table's top does, or be the wall of the
// lamp's own room: the view cannot tell, and takes it for an occluder. A quarter of the weight keeps
// most of what is gained in the first case and of what is lost in the second. What hides a surface from
// a phantom view stands in the camera's own room.
float trust(Place p, Face face) {
#if CAMERA_VIEW || PHANTOM || ESTIMATOR == OBSCURANCE
  return 1.0;
#else
  Look own = look(face, p.position, vec3(0.0));
  // By two texels at least: nearer, it is recorded beside the surface.
  bool apart = length(own.surface) > 2.0 / TEXEL_ERROR * own.error;
  return own.seen && own.hidden && apart && elevation(own, p.normal) > 0.0 ? 0.25 : 1.0;
#endif
}

// How much a pixel needs further views, 0..1: not at all where one has seen the whole hemisphere open.
float need(ivec2 pixel) {
#if PHANTOM && !PROBES
  float hidden = 1.0;
  for (int k = 0; k < int(occlusion.place.w); ++k)
    hidden = min(hidden, texelFetch(earlier_estimates, ivec3(pixel, k), 0).w);
  return clamp(8.0 * hidden, 0.0, 1.0);
#else
  return 1.0;
#endif
}

#if IMPORTANCE
// (4.5). It takes the paper's own weight: where everything is far there is little to find. Rounded by
// chance, so that its expectation is right, and for a group of pixels alike, since they run together
// and wait for the one with the most.
uint further_samples(Sums sums, float facing, uint initial) {
  float count = max(sums.count, 1.0), b = occlusion.range.z;
  float weight = b * (1.0 - sums.distances / count) + (1.0 - b) * facing;
  float more = float(occlusion.samples.x - initial) * weight *
               0.5 * (1.0 + clamp(sums.occlusion / count, 0.0, 1.0));
  uint tile = gl_WorkGroupID.x + (gl_WorkGroupID.y << 16);
  return uint(more + unit_float(hash(tile + hash(occlusion.samples.z + occlusion.samples.w))));
}
#endif

void main() {
#if PROBES
  // One pixel of each so many.
  uint probe = gl_WorkGroupID.x * TILE * TILE + gl_LocalInvocationIndex;
  uint index = probe * occlusion.place.z + hash(probe) % occlusion.place.z;
#else
  uint index = gl_GlobalInvocationID.y * uint(view.size.x) + gl_GlobalInvocationID.x;
  if (gl_GlobalInvocationID.x >= uint(view.size.x)) index = 0xffffffffu;
#endif
  ivec2 pixel = ivec2(index % uint(view.size.x), index / uint(view.size.x));
  bool covered = index / uint(view.size.x) < uint(view.size.y);
  pixel = covered ? pixel : ivec2(0);
  covered = covered && texelFetch(camera_depths, pixel, 0).r > 0.0;
  float needed = covered ? need(pixel) : 0.0;
  bool asked = needed > 0.0;

  GBufferPixel g = read_g_buffer(pixel);
  Place p;
  p.position = g.position;
  p.normal = g.normal;
  uint key = hash(index + occlusion.samples.w);
  p.first = uvec3(key, hash(key + 1u), hash(key + 2u)) +
            occlusion.samples.z * uvec3(3518319153u, 2882110345u, 2360945575u);

  Face face = main_face(p.position);
  float facing = max(dot(towards_view(face), p.normal), 0.0);  // (4.4)
  Sums sums = no_samples();
#if IMPORTANCE
  uint initial = min(occlusion.samples.y, occlusion.samples.x);
  estimate(p, face, 0u, asked ? initial : 0u, sums);
  estimate(p, face, initial, asked ? further_samples(sums, facing, initial) : 0u, sums);
#else
  estimate(p, face, 0u, asked ? occlusion.samples.x : 0u, sums);
#endif
  if (!covered) return;
  float count = max(sums.count, 1.0);
  float blocked = clamp(sums.occlusion / count, 0.0, 1.0);
  float weight = asked ? needed * trust(p, face) * view_weight(sums, facing) : 0.0;
#if PROBES
  probes[probe * occlusion.place.w + occlusion.place.x] =
      OcclusionProbe(blocked, weight, dot(g.position, view.axis.xyz), 1u);
#else
  ivec3 at = ivec3(pixel, occlusion.place.x);
  imageStore(estimates, at, vec4(blocked, weight, sums.count / float(occlusion.samples.x),
                                 sums.hidden / count));
#if BENT_NORMALS
  imageStore(closed_directions, at, vec4(sums.closed / count, 0.0));
#endif
#endif
}
