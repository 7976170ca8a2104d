// What the rasteriser has found at the pixels' places, as hits of the camera's rays.
#include "base/invocation.glsl"
#include "gpu_scene/geometry.glsl"
#include "path_tracer/path_shared.h"
#include "tracing/rays_shared.h"

layout(local_size_x = 64) in;
layout(binding = 7) uniform usampler2D visibility;  // record + 1, triangle of the mesh
layout(std430, binding = 0) readonly buffer Records { DrawRecord records[]; };
layout(std430, binding = 1) readonly buffer Rays { TracedRay rays[]; };
layout(std430, binding = 2) writeonly buffer Hits { TracedHit hits[]; };
layout(std430, binding = 3) readonly buffer Firsts { uint first_primitives[]; };  // of instances

void main() {
  uint path = invocation();
  if (path >= frame.range.w) return;
  TracedRay traced = rays[path];
  ivec2 pixel = ivec2(traced.tag % frame.size.x, traced.tag / frame.size.x);
  uvec2 visible = texelFetch(visibility, pixel, 0).xy;
  hits[path] = TracedHit(traced.t_max, NO_PRIMITIVE, 0.0, 0.0);
  if (visible.x == 0u) return;
  uint instance = records[visible.x - 1u].instance;
  Ray ray;
  ray.origin = vec3(traced.origin_x, traced.origin_y, traced.origin_z);
  ray.direction = vec3(traced.direction_x, traced.direction_y, traced.direction_z);
  Hit hit = fetch_hit(ray, instance, visible.y);
  hits[path] = TracedHit(dot(hit.position - ray.origin, ray.direction),
                         first_primitives[instance] + visible.y, hit.barycentrics.y,
                         hit.barycentrics.z);
}
