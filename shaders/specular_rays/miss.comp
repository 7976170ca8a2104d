// Paths that have met nothing: the world's light.
#include "gpu_scene/world.glsl"
#include "base/invocation.glsl"
#include "specular_rays/path.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Sorted { uint sorted[]; };
#if COLORED_ALPHA
layout(std430, binding = 1) readonly buffer Passed { vec4 passed[]; };
#endif
layout(location = 1) uniform uvec2 range;  // of `sorted`: first, count
layout(location = 2) uniform uint events;  // that paths have been through

void main() {
  uint i = invocation();
  if (i >= range.y) return;
  uint index = sorted[range.x + i];
  Path path = fetch_path(index);
#if COLORED_ALPHA
  path.throughput *= passed[index].rgb;
#endif
  vec3 light = finite_world(fetch_direction(index));
  if (events == 1u) add_direct(path, light);
  else add_indirect(path, light);
}
