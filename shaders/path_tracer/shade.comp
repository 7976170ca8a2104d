// What happens where paths meet surfaces: light that the surface emits, light that reaches it from a
// light that is picked by chance, and the direction in which the path goes on.
#define STATE_UNIT 7
#include "base/color.glsl"
#include "base/invocation.glsl"
#include "base/lobes.glsl"
#include "base/bsdf.glsl"
#include "path_tracer/path_state.glsl"
#include "path_tracer/light_sums.glsl"
#include "base/sampling.glsl"
#include "tracing/surface_record.glsl"
#include "scene/visibility_shared.h"
#include "tracing/rays_shared.h"
#if LIGHTS
#include "path_tracer/lights.glsl"
#endif
#if SHADOW_MAPS
#include "rasterize/shadow_lookup.glsl"
#endif

layout(local_size_x = 64) in;
layout(binding = 5) uniform samplerBuffer rays_in;  // as TracedRay
layout(binding = 8) uniform usamplerBuffer records;
layout(binding = 6) uniform usamplerBuffer hits;    // as TracedHit
layout(binding = 9) uniform samplerBuffer passed_in;
layout(std430, binding = 0) writeonly buffer Rays { TracedRay rays[]; };
layout(std430, binding = 1) writeonly buffer States { uvec4 new_states[]; };
layout(std430, binding = 2) buffer Counters { uint going_count, shadow_count, lit_count; };
layout(std430, binding = 11) writeonly buffer Going { uint going[]; };
layout(std430, binding = 12) writeonly buffer PassedOn { vec4 passed[]; };
#if LIGHTS
layout(std430, binding = 5) writeonly buffer ShadowRays { TracedRay shadow_rays[]; };
layout(std430, binding = 7) writeonly buffer ShadowList { uint shadow_list[]; };
layout(std430, binding = 13) writeonly buffer LitList { uint lit_list[]; };  // without a shadow ray
layout(std430, binding = 8) writeonly buffer Arrivals { Arrival arrivals[]; };
layout(std430, binding = 9) writeonly buffer ShadowPassed { vec4 shadow_passed[]; };
#if SHADOW_MAPS
layout(std430, binding = 3) readonly buffer MappedLights { Light mapped_lights[]; };
layout(location = 2) uniform uint mapped_count;
#endif
#if LIGHT_PASSES
layout(std430, binding = 10) writeonly buffer Shares { vec4 shares[]; };  // two a path
#endif
#endif
layout(location = 0) uniform uint count;
layout(location = 1) uniform uint depth;  // surfaces that the paths have met before

// Random numbers of one surface: pairs of dimensions, behind those of the camera.
const uint FIRST_PAIR = 2u, PAIRS = 4u;
const uint BSDF_PAIR = 0u, CHANCE_PAIR = 1u, LIGHT_PAIR = 2u, LIGHT_CHOICE_PAIR = 3u;

// From this scattering on paths may end by chance. Earlier would be faster for as much more noise, of
// which dark corners would show most.
const uint ROULETTE_FROM = 4u;

// Where bumps of coarse facets are lit as the smooth surface that their normals tell of would be:
// shadow rays begin there while the light is this near to the facet's horizon (Cycles' measure).
const float TERMINATOR = 0.1;

float largest(vec3 v) { return max(max(v.x, v.y), v.z); }
vec3 quotient(vec3 a, vec3 b) {
  return vec3(b.x != 0.0 ? a.x / b.x : 0.0, b.y != 0.0 ? a.y / b.y : 0.0, b.z != 0.0 ? a.z / b.z : 0.0);
}

void main() {
  uint i = invocation();
  if (i >= count) return;
  int record = int(i) * SURFACE_TEXELS;
  uvec4 head0 = texelFetch(records, record), head1 = texelFetch(records, record + 1);
  vec3 position = uintBitsToFloat(head0.xyz);
  float offset = uintBitsToFloat(head0.w), bulge = uintBitsToFloat(head1.y);
  uint index = head1.x;

  Path path = fetch_path(index);
  vec4 ray0 = texelFetch(rays_in, int(index) * 3), ray1 = texelFetch(rays_in, int(index) * 3 + 1);
  vec3 arriving = ray1.xyz;
  uint pixel = floatBitsToUint(texelFetch(rays_in, int(index) * 3 + 2).w);
  uvec4 hit = texelFetch(hits, int(index));
  float t = uintBitsToFloat(hit.x);
  vec4 through = texelFetch(passed_in, int(index));
  path.throughput *= through.rgb;
  uint scatterings = turns_of_all(path.turns);

  vec3 shining = vec3(0.0);
#if EMISSION
  vec3 emission = uintBitsToFloat(texelFetch(records, record + 2).xyz);
  if (emission != vec3(0.0)) {
    float weight = 1.0;
#if LIGHTS
    if (path.scattering_pdf > 0.0)
      weight = power_heuristic(path.scattering_pdf, light_pdf_primitive(ray0.xyz, path.normal, hit.y,
                                                                        arriving, t));
#endif
    shining = emission * weight;
  }
#endif
#if LAMPS_SEEN
  if (scatterings > 0u)
    shining += lamps_seen(ray0.xyz, path.normal, arriving, t, path.scattering_pdf);
#endif
#if EMISSION || LAMPS_SEEN
  if (shining != vec3(0.0)) {
#if LIGHT_PASSES
    add_light(index, path.throughput * shining, scatterings, path.diffuse_share, path.glossy_share);
#else
    add_light(index, path.throughput * shining, scatterings, vec3(0.0), vec3(0.0));
#endif
  }
#endif

  uvec4 texels[LOBES_TEXELS];
  for (int k = 0; k < LOBES_TEXELS; ++k) texels[k] = texelFetch(records, record + LOBES_AT + k);
  Lobes lobes = unpack_lobes(texels, -arriving);
  if (scatterings == 0u) {
#ifdef PASS_EMIT
    set_pass(index, PASS_EMIT, path.throughput * shining);
#endif
#ifdef PASS_NORMAL
    set_pass(index, PASS_NORMAL, lobes_normal(lobes));
#endif
#ifdef PASS_DIFFCOL
    set_pass(index, PASS_DIFFCOL, path.throughput * lobes_color_diffuse(lobes));
#endif
#ifdef PASS_GLOSSCOL
    set_pass(index, PASS_GLOSSCOL, path.throughput * lobes_color_glossy(lobes));
#endif
#ifdef PASS_TRANSCOL
    set_pass(index, PASS_TRANSCOL, path.throughput * lobes_color_transmission(lobes));
#endif
  }
  if (ends_after(path.turns) || through.a > float(frame.size.y)) return;

#if FILTER_GLOSSY
  float likelihood = frame.clamps.z * path.least_pdf;
  if (likelihood < 1.0) blur_lobes(lobes, 0.5 * sqrt(1.0 - likelihood));
#endif
  uint key = hash(frame.range.y ^ hash(pixel));
  uint dimension = FIRST_PAIR + PAIRS * depth;
  vec2 chance = path_pair(key, frame.range.x, dimension + CHANCE_PAIR);
  bool both_sides = transmits(lobes);
  uint seed = hash(key + hash(frame.range.x ^ hash(depth)));

#if LIGHTS
  LightSample light;
  vec3 choice = vec3(path_pair(key, frame.range.x, dimension + LIGHT_PAIR),
                     path_pair(key, frame.range.x, dimension + LIGHT_CHOICE_PAIR).x);
  if (light_sample(position, both_sides ? vec3(0.0) : lobes.smooth_normal, choice, light)) {
    BsdfValue value = bsdf_evaluate(lobes, light.direction);
    // A surface that rays of a kind do not meet lights nothing that scatters by that kind, as in Cycles.
    float weight = light.singular ? 1.0 : power_heuristic(light.pdf, value.pdf);
    value.diffuse *= (light.seen_by & SEEN_BY_DIFFUSE) != 0u ? weight : 0.0;
    value.glossy *= (light.seen_by & SEEN_BY_GLOSSY) != 0u ? weight : 0.0;
    value.transmission *= (light.seen_by & SEEN_BY_TRANSMISSION) != 0u ? weight : 0.0;
    vec3 all = value.diffuse + value.glossy + value.transmission;
    vec3 contribution = path.throughput * all * light.value / light.pdf;
    bool traced = light.t_max > 0.0;
#if SHADOW_MAPS
    if (traced && light.lamp < mapped_count) {
      traced = false;
      Light mapped = mapped_lights[light.lamp];
      Receiver receiver = Receiver(position, lobes.geometric_normal, lobes.smooth_normal, bulge, 0.0);
      if (mapped.shadow != NO_SHADOW) contribution *= shadow(mapped, receiver, light.direction);
    }
#endif
    if (largest(contribution) > 0.0) {
      // Light from the side of the smooth normal does not come through the surface.
      float away = -offset;
      if (dot(lobes.smooth_normal, light.direction) >= 0.0) {
        float facing = dot(lobes.geometric_normal, light.direction);
        away = offset + bulge * clamp(1.0 - facing / TERMINATOR, 0.0, 1.0);
      }
      vec3 origin = position + away * lobes.geometric_normal;
      // Aimed anew from there: at a slant even this offset would lead into what the light lies on.
      bool ends = light.t_max < frame.camera.w;
      vec3 aim = ends ? position + light.t_max * light.direction - origin : light.direction;
      shadow_rays[index] = TracedRay(origin.x, origin.y, origin.z, 0.0, aim.x, aim.y, aim.z,
                                     ends ? 1.0 : frame.camera.w, NO_PRIMITIVE, SEEN_BY_SHADOW,
                                     hash(seed), index);
      arrivals[index] = Arrival(contribution.r, contribution.g, contribution.b, light.source,
                                scatterings + 1u, 0u, 0u, 0u);
      shadow_passed[index] = vec4(1.0, 1.0, 1.0, through.a);
#if LIGHT_PASSES
      bool first = scatterings == 0u;
      shares[index * 2u] = vec4(first ? quotient(value.diffuse, all) : path.diffuse_share, 0.0);
      shares[index * 2u + 1u] = vec4(first ? quotient(value.glossy, all) : path.glossy_share, 0.0);
#endif
      if (traced) shadow_list[atomicAdd(shadow_count, 1u)] = index;
      else lit_list[atomicAdd(lit_count, 1u)] = index;
    }
  }
#endif

  BsdfSample next = bsdf_sample(lobes, vec3(path_pair(key, frame.range.x, dimension + BSDF_PAIR),
                                            chance.x));
  if (!(next.pdf > 0.0)) return;
  vec3 all = next.value.diffuse + next.value.glossy + next.value.transmission;
  path.throughput *= all / next.pdf;
#if LIGHT_PASSES
  if (scatterings == 0u) {
    path.diffuse_share = quotient(next.value.diffuse, all);
    path.glossy_share = quotient(next.value.glossy, all);
  }
#endif
  float strength = largest(path.throughput);
  if (!(strength > 0.0 && strength < 1.0e30)) return;
  path.turns = with_turn(path.turns, next.kind, both_sides);
#if !SHINES
  // A path that may not be scattered again looks for light, of which it would meet none.
  if (ends_after(path.turns)) return;
#endif
  if (scatterings + 1u >= ROULETTE_FROM) {
    float stays = min(sqrt(strength), 1.0);
    if (chance.y >= stays) return;
    path.throughput /= stays;
  }

  vec3 origin = position + (dot(lobes.geometric_normal, next.direction) < 0.0 ? -offset : offset) * lobes.geometric_normal;
  uint seen_by = next.kind == BOUNCE_DIFFUSE  ? SEEN_BY_DIFFUSE
                 : next.kind == BOUNCE_GLOSSY ? SEEN_BY_GLOSSY
                                              : SEEN_BY_TRANSMISSION;
  rays[index] = TracedRay(origin.x, origin.y, origin.z, 0.0, next.direction.x, next.direction.y,
                          next.direction.z, frame.camera.w, NO_PRIMITIVE, seen_by, seed, pixel);
  float least = next.singular ? path.least_pdf : min(path.least_pdf, next.pdf);
  uint state = index * uint(STATE_TEXELS);
  new_states[state] = uvec4(floatBitsToUint(path.throughput),
                            floatBitsToUint(next.singular ? 0.0 : next.pdf));
  new_states[state + 1u] = uvec4(floatBitsToUint(least), pack_unit(lobes.smooth_normal), path.turns,
                                 floatBitsToUint(path.way + t));
#if LIGHT_PASSES
  new_states[state + 2u] = uvec4(floatBitsToUint(path.diffuse_share), 0u);
  new_states[state + 3u] = uvec4(floatBitsToUint(path.glossy_share), 0u);
#endif
  passed[index] = vec4(1.0, 1.0, 1.0, through.a);
  going[atomicAdd(going_count, 1u)] = index;
}
