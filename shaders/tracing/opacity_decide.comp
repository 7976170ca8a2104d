// Evaluates one material where rays have met it, and lists those that pass: they go on right behind
// the primitive. By chance, or (TRANSMITTANCE) all that anything of passes.
#include "base/invocation.glsl"
#include "gpu_scene/material.glsl"
#include "generated/material.glsl"
#include "tracing/met_surface.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Hits { TracedHit hits[]; };
layout(std430, binding = 1) buffer Rays { TracedRay rays[]; };
layout(std430, binding = 2) buffer Counter { uint passing_count; };
layout(std430, binding = 3) readonly buffer Sorted { uint by_material[]; };
layout(std430, binding = 4) writeonly buffer Passing { uint passing[]; };
#if WEIGHTED
layout(std430, binding = 6) buffer Passed { vec4 passed[]; };  // colour, layers
layout(location = 2) uniform float most_layers;
#endif
#if !TRANSMITTANCE
layout(location = 3) uniform float threshold;  // below 0: by chance
#endif
layout(location = 1) uniform uvec2 range;  // of by_material: first, count

void main() {
  uint slot = invocation();
  if (slot >= range.y) return;
  uint index = by_material[range.x + slot];
  TracedRay traced = rays[index];
  uint primitive = hits[index].primitive;

  Surface surface = empty_surface();
  evaluate_material(met_hit(traced, primitive), surface);

  vec3 transparency = clamp(finite(surface.transparency), 0.0, 1.0);
#if TRANSMITTANCE
  vec4 before = passed[index];
  vec3 left = before.a < most_layers ? before.rgb * transparency : vec3(0.0);
  passed[index] = vec4(left, before.a + 1.0);
  bool passes = any(greaterThan(left, vec3(0.0)));
#else
  // As the rasteriser does it, but with a number for each ray and primitive.
  float opaque_from = threshold < 0.0 ? unit_float(hash(primitive + hash(traced.seed))) : threshold;
  float share = luminance(transparency);
  bool passes = 1.0 - share <= opaque_from && share > 0.0;
#if WEIGHTED
  vec4 before = passed[index];
  passes = passes && before.a < most_layers;
  if (passes) passed[index] = vec4(before.rgb * transparency / share, before.a + 1.0);
#endif
#endif
  if (!passes) return;
  rays[index].t_min = hits[index].t;
  rays[index].after = primitive;
  passing[atomicAdd(passing_count, 1u)] = index;
}
