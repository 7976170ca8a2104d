// Light from one batch of lamps, through their shadow maps, on the surfaces where paths have ended.
#include "base/invocation.glsl"
#include "rasterize/lamp_light.glsl"
#include "specular_rays/end_surface.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Ended { uint ended[]; };
layout(location = 0) uniform uint count;
layout(location = 1) uniform uvec2 range;  // of lamps: first, count

void main() {
  uint i = invocation();
  if (i >= count) return;
  uint index = ended[i];
  Path path = fetch_path(index);
  EndSurface end = fetch_end(index);
  // Glowing surfaces are met by the paths that follow the others.
  Lobes unfollowed = end.lobes;
  remove_lobes(unfollowed, path.lobes);
  float random = unit_float(hash(path_key(path.pixel) + hash(frame.sampling.x)));
  Receiver receiver = Receiver(end.position - frame.camera.xyz, end.lobes.geometric_normal,
                               end.lobes.smooth_normal, end.bulge, random);
  vec3 light = vec3(0.0);
  for (uint k = range.x; k < range.x + range.y; ++k) {
    vec3 to_light;
    vec3 irradiance = lamp_light(k, receiver, to_light);
    BsdfValue value = bsdf_evaluate(end.lobes, to_light);
    if (lights[k].type == LIGHT_MESH) value = bsdf_evaluate(unfollowed, to_light);
    light += irradiance * (value.diffuse + value.glossy);
  }
  add_indirect(path, light);
}
