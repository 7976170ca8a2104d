// A path for each listed pixel: begins as the camera's ray, which has met what the rasteriser found.
#include "base/invocation.glsl"
#include "gpu_scene/geometry.glsl"
#include "specular_rays/path_shared.h"
#include "tracing/rays_shared.h"

layout(local_size_x = 64) in;
layout(binding = 7) uniform usampler2D visibility;  // record + 1, triangle of the mesh
layout(binding = 6) uniform sampler2D direct_light;  // a: lobes to follow
layout(std430, binding = 0) writeonly buffer Rays { TracedRay rays[]; };
layout(std430, binding = 1) writeonly buffer Hits { TracedHit hits[]; };
layout(std430, binding = 2) writeonly buffer Paths { SpecularPath paths[]; };
layout(std430, binding = 3) readonly buffer List { uint list[]; };
layout(std430, binding = 4) readonly buffer Records { DrawRecord records[]; };
layout(std430, binding = 5) readonly buffer Firsts { uint first_primitives[]; };  // of instances
layout(location = 0) uniform uint count;

void main() {
  uint i = invocation();
  if (i >= count) return;
  uint number = list[i];
  ivec2 pixel = ivec2(int(number) % view.size.x, int(number) / view.size.x);
  uvec2 visible = texelFetch(visibility, pixel, 0).xy;
  Ray ray = view_ray(vec2(pixel) + 0.5);
  vec3 origin = ray.origin + frame.camera.xyz, direction = normalize(ray.direction);
  uint seed = hash(hash(frame.sampling.y ^ hash(number)) + hash(frame.sampling.x));
  rays[i] = TracedRay(origin.x, origin.y, origin.z, 0.0, direction.x, direction.y, direction.z,
                      frame.camera.w, NO_PRIMITIVE, SEEN_BY_CAMERA, seed, number);
  hits[i] = TracedHit(0.0, first_primitives[records[visible.x - 1u].instance] + visible.y, 0.0, 0.0);
  uint lobes = uint(texelFetch(direct_light, pixel, 0).a);
  paths[i] = SpecularPath(1.0, 1.0, 1.0, 0.0, number, lobes, 0u, 0u);
}
