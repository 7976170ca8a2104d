// What surfels send on, to the front and to the back: light of the lamps, and with CACHE_LIGHT what
// arrives there by the cache as it is. One invocation a side of a surfel.
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
layout(location = 0) uniform uint count;  // of sides

void main() {
  uint side = invocation();
  if (side >= count) return;
  Surfel surfel = fetch_surfel(side / 2u);
  bool front = (side & 1u) == 0u;
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
