// Light of one lamp at a point, past what its shadow map shows (SHADOWS 1). The maps of one batch of
// lamps are there at a time, so whoever adds up lamps asks for those of a batch only.
#include "base/falloff.glsl"
#include "gpu_scene/lights_shared.h"
#include "rasterize/receiver.glsl"
#if SHADOWS
#include "rasterize/shadow_lookup.glsl"
#endif

layout(std430, binding = 3) readonly buffer Lights { Light lights[]; };

// Irradiance from a lamp on a surface at `position` that is square to it, W/m2, if nothing stands
// between. `to_light` is unit.
vec3 unshadowed_light(Light light, vec3 position, out vec3 to_light) {
  to_light = -light.axis.xyz;
  vec3 irradiance = light.power.xyz;
  if (light.type != LIGHT_SUN) {
    vec3 d = light.position.xyz - position;
    float squared = max(dot(d, d), 1.0e-20);
    to_light = d * inversesqrt(squared);
    float least = light.position.w * light.position.w;
    float cosine = -dot(to_light, light.axis.xyz);
    if (light.type == LIGHT_MESH)
      irradiance = (cosine > 0.0 ? irradiance : light.center.xyz) * abs(cosine) /
                   max(squared, least);
    else
      irradiance /= squared + least;
    // Points with a radius are disks that face whatever they light.
    if (light.type == LIGHT_POINT) {
      vec3 to_center = light.center.xyz - position;
      float squared_center = dot(to_center, to_center);
      vec3 facing = squared_center > 0.0 ? to_center * inversesqrt(squared_center) : to_light;
      irradiance *= max(dot(facing, to_light), 0.0);
    }
    if (light.type == LIGHT_SPOT) irradiance *= spot_falloff(light.cone.xy, cosine);
    if (light.type == LIGHT_AREA) irradiance *= area_falloff(light.cone.xy, cosine);
  }
  // Zero-length directions and absurd energies must not become NaN.
  return clamp(irradiance, vec3(-1.0e30), vec3(1.0e30));
}

// The share of it that arrives past what stands between, 0..1; only the receiver's position matters where the lamp
// casts no shadow.
float arriving_share(Light light, Receiver receiver, vec3 to_light) {
#if SHADOWS
  if (light.shadow != NO_SHADOW) return shadow(light, receiver, to_light);
#endif
  return 1.0;
}

// Both together, from lamp `k`.
vec3 lamp_light(uint k, Receiver receiver, out vec3 to_light) {
  Light light = lights[k];
  vec3 irradiance = unshadowed_light(light, receiver.position, to_light);
  return irradiance == vec3(0.0) ? irradiance : irradiance * arriving_share(light, receiver, to_light);
}
