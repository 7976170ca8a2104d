// Light for a place on a path: one sample of all lamps, glowing triangles and the world, and the
// density with which that sample would have been what a scattered ray has met.
//
// path_tracer::Lights sets the defines and binds what these read. Positions are relative to the list
// of triangles' origin, metres. `normal` is unit and on the side that light is wanted from; 0 where it
// is wanted from all sides. `random` is uniform in [0, 1)^3.
#include "path_tracer/lights_shared.h"

layout(std140, binding = 3) uniform LightBlock { LightConstants light_constants; };

struct LightSample {
  vec3 direction;  // unit, towards the light
  float t_max;     // where a shadow ray ends: before the light's surface, or FAR; 0: needs none
  vec3 value;      // radiance; of singular lights irradiance at normal incidence
  float pdf;       // per solid angle; of singular lights the choice's alone; 0: no light
  bool singular;   // no scattered ray could have met it
  uint source;     // LIGHT_KNOWN, LIGHT_WORLD, or a primitive whose emission at u, v is to be
                   // multiplied (Surface.emission as evaluate_material() leaves it, not finished)
  float u, v;      // barycentric coordinates of the second and third vertex
  uint seen_by;    // SEEN_BY_... bits: which kinds of rays could have met it
  uint lamp;       // its number in the scene; NO_LIGHT for what is none
};

const uint LIGHT_SEEN_BY_ALL = 63u;

#include "path_tracer/light_shapes.glsl"
#if LIGHT_ANY
#include "path_tracer/light_tree.glsl"
#endif
#if LIGHT_TRIANGLES
layout(binding = 2) uniform usamplerBuffer glowing_records;  // a primitive's record, or NO_LIGHT
#endif
#if WORLD_SAMPLED
#include "path_tracer/world_map.glsl"
#endif

// Probability that a sample goes to the world.
float world_share(vec3 from, vec3 normal) {
#if WORLD_SAMPLED && LIGHT_ANY
  float world = light_constants.world_irradiance;
  return world / (world + tree_importance(from, normal));
#else
  return float(WORLD_SAMPLED);
#endif
}

// False, and pdf 0, where no light comes from what was chosen.
bool light_sample(vec3 from, vec3 normal, vec3 random, out LightSample s) {
  s = LightSample(vec3(0.0, 0.0, 1.0), 0.0, vec3(0.0), 0.0, false, LIGHT_KNOWN, 0.0, 0.0,
                  LIGHT_SEEN_BY_ALL, NO_LIGHT);
#if WORLD_SAMPLED
  float share = world_share(from, normal);
  if (random.z < share) {
    ivec2 size = ivec2(light_constants.world_width, light_constants.world_height);
    s.direction = sample_world_map(size, random.xy, s.pdf);
    s.pdf *= share;
    s.t_max = FAR;
    s.value = vec3(1.0);
    s.source = LIGHT_WORLD;
    return s.pdf > 0.0;
  }
#else
  const float share = 0.0;
#endif
#if LIGHT_ANY
  uint light = 0u;
  float probability = 1.0;
#if LIGHT_TREE
  light = choose_light(from, normal, min((random.z - share) / (1.0 - share), 0.99999994), probability);
  if (light == NO_LIGHT) return false;
#endif
  LightRecord record = fetch_record(light);
  sample_record(record, from, random.xy, s);
  if ((record_flags(record) & KIND_MASK) != KIND_TRIANGLE) s.lamp = floatBitsToUint(record.edge_y.w);
  s.pdf *= probability * (1.0 - share);
  if (!(s.pdf > 0.0 && s.pdf < 1.0e37)) s.pdf = 0.0;
#endif
  return s.pdf > 0.0;
}

// Probability that a sample goes to that light.
float record_probability(LightRecord l, vec3 from, vec3 normal) {
  float probability = 1.0 - world_share(from, normal);
#if LIGHT_TREE
  probability *= light_probability(floatBitsToUint(l.edge_x.w), from, normal);
#endif
  return probability;
}

// The density, per solid angle, with which light_sample() at `from` sends to the point of `primitive`
// that lies at `t` along the unit `direction`; 0 where it never does.
float light_pdf_primitive(vec3 from, vec3 normal, uint primitive, vec3 direction, float t) {
#if LIGHT_TRIANGLES
  uint place = primitive - light_constants.first_glowing;
  if (place >= light_constants.glowing_count) return 0.0;
  uint light = texelFetch(glowing_records, int(place)).x;
  if (light == NO_LIGHT) return 0.0;
  LightRecord l = fetch_record(light);
  float cosine = abs(dot(direction, l.axis.xyz));
  float pdf = cosine > 0.0 ? t * t / (cosine * l.axis.w) : 0.0;
  pdf *= record_probability(l, from, normal);
  return pdf < 1.0e37 ? pdf : 0.0;
#else
  return 0.0;
#endif
}

// The same of a ray that leaves the scene.
float light_pdf_world(vec3 from, vec3 normal, vec3 direction) {
#if WORLD_SAMPLED
  ivec2 size = ivec2(light_constants.world_width, light_constants.world_height);
  return world_share(from, normal) * world_map_pdf(size, direction);
#else
  return 0.0;
#endif
}

#if LAMPS_SEEN
#include "path_tracer/lamps_seen.glsl"
#endif

// Radiance of the lamps with an extent that the ray from `from` passes before `t_max` (FAR: it leaves
// the scene), by the power heuristic's weight against the density `scattering_pdf` of the scattering
// that sent it; with their whole radiance where that was singular, at scattering_pdf 0. Lamps stop no
// ray.
vec3 lamps_seen(vec3 from, vec3 normal, vec3 direction, float t_max, float scattering_pdf) {
#if LAMPS_SEEN
  return radiance_of_lamps(from, normal, direction, t_max, scattering_pdf);
#else
  return vec3(0.0);
#endif
}
