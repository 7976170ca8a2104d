// What an artist multiplies bounced light by (thesis, section 5.4): everywhere, in boxes and by object.
#include "radiance_cache/encoding.glsl"
#include "radiance_cache/scales_shared.h"

layout(std140, binding = SCALES_BLOCK) uniform ScalesBlock { CacheScales scales; };
layout(binding = SCALES_UNIT) uniform samplerBuffer scaled_instances;  // as gpu_scene/geometry.glsl's

// `instance`: its place on the GPU. `position` is relative to the camera.
vec3 scaled_light(vec3 light, vec3 position, uint instance) {
  uint own = floatBitsToUint(texelFetch(scaled_instances, int(instance) * 4 + 3).w);
  vec2 scale = scales.scale.xy * unpackHalf2x16(own);
  for (int i = 0; i < scales.count.x; ++i) {
    vec3 place = (scales.regions[i].box_from_place * vec4(position, 1.0)).xyz;
    if (all(lessThanEqual(abs(place), vec3(1.0)))) scale *= scales.regions[i].scale.xy;
  }
  vec3 parts = ycocg_from_rgb(light) * scale.x;
  return max(rgb_in_gamut(vec3(parts.x, parts.yz * scale.y)), vec3(0.0));
}
