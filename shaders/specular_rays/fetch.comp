// The surfaces that paths have met, of one material: evaluated and stored, under the path's number.
#define LOBES_APART 1
#include "base/invocation.glsl"
#include "gpu_scene/material.glsl"
#include "generated/material.glsl"
#include "specular_rays/path_shared.h"
#include "tracing/met_surface.glsl"
#include "tracing/store_surface.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Rays { TracedRay rays[]; };
layout(std430, binding = 1) readonly buffer Hits { TracedHit hits[]; };
layout(std430, binding = 2) readonly buffer Paths { SpecularPath paths[]; };
layout(std430, binding = 3) readonly buffer Sorted { uint by_material[]; };
layout(location = 1) uniform uvec2 range;  // of by_material: first, count

void main() {
  uint i = invocation();
  if (i >= range.y) return;
  uint path = by_material[range.x + i];
  TracedRay traced = rays[path];
  Hit hit = met_hit(traced, hits[path].primitive);
  // The pixel's cone, which flat mirrors neither widen nor narrow.
  vec3 origin = vec3(traced.origin_x, traced.origin_y, traced.origin_z);
  float way = paths[path].way + distance(origin, hit.position);
  hit.footprint = view.filtering.y * (view.filtering.z > 0.5 ? way : 1.0);

  Surface surface = empty_surface();
  surface.seed = traced.seed;
  evaluate_material(hit, surface);
  finish_surface(hit, surface);
  store_surface(path, path, hit, surface);
}
