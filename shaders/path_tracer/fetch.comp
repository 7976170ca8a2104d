// The surfaces that paths have met, of one material: evaluated and stored for path_tracer/shade.comp.
#define LOBES_APART 1
#include "base/invocation.glsl"
#include "gpu_scene/material.glsl"
#include "generated/material.glsl"
#include "path_tracer/path_state.glsl"
#include "tracing/met_surface.glsl"
#include "tracing/store_surface.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Rays { TracedRay rays[]; };
layout(std430, binding = 1) readonly buffer Hits { TracedHit hits[]; };
layout(std430, binding = 2) readonly buffer States { uvec4 states[]; };
layout(std430, binding = 3) readonly buffer Sorted { uint by_material[]; };
layout(location = 1) uniform uvec2 range;  // of by_material, and of records: first, count

void main() {
  uint i = invocation();
  if (i >= range.y) return;
  uint path = by_material[range.x + i];
  TracedRay traced = rays[path];
  TracedHit met = hits[path];
  Hit hit = met_hit(traced, met.primitive);
  // Only bumps ask how wide the ray is; images are read at their finest level (view.filtering).
  float way = uintBitsToFloat(states[path * uint(STATE_TEXELS) + 1u].w) + met.t;
  hit.footprint = frame.clip.w * (view.filtering.z > 0.5 ? way : 1.0);

  Surface surface = empty_surface();
  surface.seed = traced.seed;
  evaluate_material(hit, surface);
  finish_surface(hit, surface);
  store_surface(range.x + i, path, hit, surface);
}
