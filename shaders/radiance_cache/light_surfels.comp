// Light of one batch of lamps, through their shadow maps, on both sides of surfels. Adds to what
// earlier batches left. One invocation a surfel.
//
// A voxel may hold both faces of a thin wall, or what lies on a floor: rays that meet it come from before
// all that is in it. So a surfel's shadow is that of a place before its voxel, or the other face's would
// lie on its back.
#include "base/invocation.glsl"
#include "radiance_cache/volume.glsl"
#include "rasterize/lamp_light.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 1) buffer Direct { vec4 direct[]; };  // irradiance, front and back
#if MET_ALONE
#include "radiance_cache/met_sides.glsl"
#endif
layout(location = 0) uniform uint count;
layout(location = 2) uniform uint first_light;
layout(location = 3) uniform uint light_count;
layout(location = 4) uniform vec3 offset;  // from positions of surfels to those of lamps
layout(location = 5) uniform float before; // how far before a surface its shadow is looked up, m
layout(location = 6) uniform float share;  // of their light

void main() {
  uint number = invocation();
  if (number >= count) return;
#if MET_ALONE
  if (!is_met(2u * number) && !is_met(2u * number + 1u)) return;
#endif
  Surfel surfel = fetch_surfel(number);
  vec3 position = surfel.place.xyz + offset, normal = unpack_unit(surfel.surface.x);
  vec3 front = vec3(0.0), back = vec3(0.0);
  for (uint k = first_light; k < first_light + light_count; ++k) {
    Light light = lights[k];
    vec3 to_light;
    vec3 irradiance = unshadowed_light(light, position, to_light);
    float cosine = dot(normal, to_light);
    irradiance *= abs(cosine);
#if SHADOWS
    vec3 lit = cosine > 0.0 ? normal : -normal;
    Receiver receiver = Receiver(position + lit * before, lit, lit, 0.0, unit_float(hash(number)));
    if (light.shadow != NO_SHADOW) irradiance *= shadow(light, receiver, to_light);
#endif
    front += cosine > 0.0 ? irradiance : vec3(0.0);
    back += cosine > 0.0 ? vec3(0.0) : irradiance;
  }
  direct[2u * number].rgb += share * front;
  direct[2u * number + 1u].rgb += share * back;
}
