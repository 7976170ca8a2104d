// What surfels send on, to the front and to the back: light of the lamps, and with CACHE_LIGHT what
// arrives there by the cache as it is. One invocation a side of a surfel, first all fronts, then all backs, since
// neighbours are met by rays on the same side.
#include "base/invocation.glsl"
#include "radiance_cache/volume.glsl"
#include "radiance_cache/rays.glsl"
#include "radiance_cache/surfel_color.glsl"
#if CACHE_LIGHT
#include "radiance_cache/look_up.glsl"
#endif

layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer Radiosity { uint radiosity[]; };  // pack_light()
#if LAMPS
layout(std430, binding = 1) readonly buffer Direct { vec4 direct[]; };  // irradiance of the lamps
#endif
#if MET_ALONE
#include "radiance_cache/met_sides.glsl"
#endif
layout(location = 0) uniform uint count;  // of surfels

void main() {
  uint number = invocation();
  if (number >= 2u * count) return;
  bool front = number < count;
  number -= front ? 0u : count;
  uint side = 2u * number + (front ? 0u : 1u);
#if MET_ALONE
  if (!is_met(side)) return;
#endif
  Surfel surfel = fetch_surfel(number);
  vec3 arriving = vec3(0.0);
#if LAMPS
  arriving = direct[side].rgb;
#endif
#if CACHE_LIGHT
  vec3 normal = unpack_unit(surfel.surface.x) * (front ? 1.0 : -1.0);
  CacheLight light = cache_light(cache_radiance(surfel.place.xyz, normal), banded_harmonics(normal, DIFFUSE_BANDS));
  arriving += (light.world + light.bounced) * CACHE_PI;
#endif
  radiosity[side] = pack_light(arriving * unpack_color(front ? surfel.surface.y : surfel.surface.z));
}
