// What passed along the rays of path_tracer/occlusion_rays.comp, into the AO pass.
#include "base/invocation.glsl"
#include "path_tracer/path_shared.h"
#include "path_tracer/light_sums.glsl"
#include "tracing/rays_shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Hits { TracedHit hits[]; };
layout(std430, binding = 1) readonly buffer Passed { vec4 passed[]; };
layout(std430, binding = 2) readonly buffer List { uint list[]; };
layout(location = 0) uniform uint count;

void main() {
  uint i = invocation();
  if (i >= count) return;
  uint index = list[i];
  bool open = hits[index].primitive == NO_PRIMITIVE;
  set_pass(index, PASS_AO, open ? passed[index].rgb : vec3(0.0));
}
