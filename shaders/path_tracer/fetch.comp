// The surfaces that paths have met, of one material: evaluated and stored for path_tracer/shade.comp.
#define LOBES_APART 1
#include "base/invocation.glsl"
#include "gpu_scene/material.glsl"
#include "generated/material.glsl"
#include "path_tracer/lobes.glsl"
#include "path_tracer/path_state.glsl"
#include "path_tracer/surface_record.glsl"
#include "tracing/rays_shared.h"

layout(local_size_x = 64) in;
layout(binding = 7) uniform samplerBuffer triangles;  // as TracedTriangle
layout(std430, binding = 0) readonly buffer Rays { TracedRay rays[]; };
layout(std430, binding = 1) readonly buffer Hits { TracedHit hits[]; };
layout(std430, binding = 2) readonly buffer States { uvec4 states[]; };
layout(std430, binding = 3) readonly buffer Sorted { uint by_material[]; };
layout(std430, binding = 4) writeonly buffer Records { uvec4 records[]; };
layout(location = 1) uniform uvec2 range;  // of by_material, and of records: first, count

// The largest size of a vector's components.
float reach(vec3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

void main() {
  uint i = invocation();
  if (i >= range.y) return;
  uint path = by_material[range.x + i];
  TracedRay traced = rays[path];
  TracedHit met = hits[path];
  Ray ray;
  ray.origin = vec3(traced.origin_x, traced.origin_y, traced.origin_z);
  ray.direction = vec3(traced.direction_x, traced.direction_y, traced.direction_z);
  int texel = int(met.primitive) * 3;
  uint instance = floatBitsToUint(texelFetch(triangles, texel).w);
  uint triangle = floatBitsToUint(texelFetch(triangles, texel + 1).w);
  Hit hit = fetch_hit(ray, instance, triangle);
  // Only bumps ask how wide the ray is; images are read at their finest level (view.filtering).
  float way = uintBitsToFloat(states[path * uint(STATE_TEXELS) + 1u].w) + met.t;
  hit.footprint = frame.clip.w * (view.filtering.z > 0.5 ? way : 1.0);

  Surface surface = empty_surface();
  surface.seed = traced.seed;
  evaluate_material(hit, surface);
  finish_surface(hit, surface);

  uint record = (range.x + i) * uint(SURFACE_TEXELS);
  // Wide enough for what positions on this triangle are rounded by, along the ray and in the list.
  float offset = RAY_OFFSET * (reach(hit.position) + reach(hit.edge1) + reach(hit.edge2));
  records[record] = uvec4(floatBitsToUint(hit.position), floatBitsToUint(offset));
  records[record + 1u] = uvec4(path, floatBitsToUint(hit.bulge), 0u, 0u);
#if EMISSION
  records[record + 2u] = uvec4(floatBitsToUint(surface.emission), 0u);
#endif
  uvec4 lobes[LOBES_TEXELS];
  pack_lobes(lobes_of(hit, surface), lobes);
  for (int k = 0; k < LOBES_TEXELS; ++k) records[record + uint(LOBES_AT + k)] = lobes[k];
}
