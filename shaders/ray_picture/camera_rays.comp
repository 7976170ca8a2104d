// Rays through the centres of a run of pixels, from the near to the far plane, about the origin of
// the list of triangles.
#include "base/invocation.glsl"
#include "gpu_scene/geometry.glsl"
#include "tracing/rays_shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer Rays { TracedRay rays[]; };
layout(location = 0) uniform uvec2 range;  // of pixels, in rows: first, count
layout(location = 1) uniform vec3 list_origin;
layout(location = 2) uniform vec2 depths;  // of the planes; directions are 1 along the view's axis

void main() {
  uint slot = invocation();
  if (slot >= range.y) return;
  uint pixel = range.x + slot;
  uint width = uint(view.size.x);
  Ray ray = view_ray(vec2(pixel % width, pixel / width) + 0.5);
  vec3 origin = ray.origin + (view.world_origin.xyz - list_origin);
  rays[slot] = TracedRay(origin.x, origin.y, origin.z, depths.x, ray.direction.x, ray.direction.y,
                         ray.direction.z, depths.y, NO_PRIMITIVE, SEEN_BY_CAMERA, 0u, pixel);
}
