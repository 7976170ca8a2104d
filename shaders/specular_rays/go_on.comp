// What happens where paths meet surfaces: light that the surface emits, and the direction in which
// the path goes on, if the surface is smooth enough; else it ends here, to be lit.
#include "base/invocation.glsl"
#include "base/sampling.glsl"
#include "scene/visibility_shared.h"
#include "specular_rays/end_surface.glsl"
#include "tracing/rays_shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer Rays { TracedRay rays[]; };
layout(std430, binding = 1) writeonly buffer Paths { SpecularPath paths[]; };
layout(std430, binding = 2) buffer Counters { uint going_count, ended_count; };
layout(std430, binding = 3) readonly buffer Sorted { uint sorted[]; };
layout(std430, binding = 4) writeonly buffer Going { uint going[]; };
layout(std430, binding = 5) writeonly buffer Ended { uint ended[]; };
#if COLORED_ALPHA
layout(std430, binding = 6) buffer Passed { vec4 passed[]; };
#endif
layout(location = 0) uniform uint count;
layout(location = 1) uniform uint events;  // that paths have been through

// A path ends where less of the light than this goes on as in a mirror: sheen on varnish, seen in
// another mirror, is worth no noise.
const float LEAST_SHARE = 0.2;
// How often at least a path ends on a surface that is not quite smooth: only there do lamps light it,
// which no ray meets.
const float HIGHLIGHT_CHANCE = 0.5;

// FOLLOWS bits of the lobes that are smooth enough.
uint smooth_lobes(Lobes l) {
  float alpha = frame.roughness.x * frame.roughness.x;
  uint which = 0u;
#if GLOSSY
  if (l.alpha <= alpha) which |= FOLLOWS_SPECULAR;
#if LAYERS
  if (abs(l.coat_alpha) <= alpha) which |= FOLLOWS_COAT;
#endif
#endif
#if TRANSMISSION
  which |= FOLLOWS_TRANSMISSION;
#endif
  return which;
}

#if LAMPS
// Whether a point of light is seen by some of the lobes of FOLLOWS bits.
bool has_highlights(Lobes l, uint which) {
  bool found = false;
#if GLOSSY
  found = (which & FOLLOWS_SPECULAR) != 0u && l.chances.specular > 0.0 && !is_smooth(l.alpha);
#if LAYERS
  found = found || ((which & FOLLOWS_COAT) != 0u && l.chances.coat > 0.0 && !is_smooth(l.coat_alpha));
#endif
#endif
  return found;
}
#endif

float share_of(LobeChances chances, uint which) {
  return ((which & FOLLOWS_SPECULAR) != 0u ? chances.specular : 0.0) +
         ((which & FOLLOWS_COAT) != 0u ? chances.coat : 0.0) +
         ((which & FOLLOWS_TRANSMISSION) != 0u ? chances.transmission : 0.0);
}

// The lobes of FOLLOWS bits alone.
Lobes only(Lobes l, uint which) {
  remove_lobes(l, FOLLOWS & ~which);
  l.diffuse = vec3(0.0);
#if LAYERS
  l.sheen = vec3(0.0);
#endif
  l.chances = chances_of(l);
  return l;
}

void store_path(uint index, Path path) {
  paths[index] = SpecularPath(path.throughput.r, path.throughput.g, path.throughput.b, path.way,
                              path.pixel, path.lobes, 0u, 0u);
}

void end_path(uint index, Path path) {
  store_path(index, path);
  ended[atomicAdd(ended_count, 1u)] = index;
}

void main() {
  uint i = invocation();
  if (i >= count) return;
  uint index = sorted[i];
  Path path = fetch_path(index);
#if COLORED_ALPHA
  if (events > 0u) path.throughput *= passed[index].rgb;
#endif
  int record = int(index) * SURFACE_TEXELS;
  vec4 head = uintBitsToFloat(texelFetch(records, record));
  vec3 position = head.xyz;
  float offset = head.w;
#if EMISSION
  vec3 emission = uintBitsToFloat(texelFetch(records, record + 2).xyz);
  if (events == 1u) add_direct(path, emission);
  if (events > 1u) add_indirect(path, emission);
#endif

  Lobes lobes = fetch_lobes(index, -fetch_direction(index));
  uint key = path_key(path.pixel);
  vec2 chance = path_pair(key, frame.sampling.x, 2u * events + 1u);
  uint followed = path.lobes & FOLLOWS;  // of the first surface, of which the others are not traced
  if (events > 0u) {
    followed = smooth_lobes(lobes);
    float share = share_of(lobes.chances, followed);
    path.lobes &= ~FOLLOWS;
    if (events == MOST_EVENTS || share < LEAST_SHARE) {
      end_path(index, path);
      return;
    }
    // Either goes on by the smooth lobes or ends, to be lit by way of the others, and by lamps by way
    // of all.
    float ends = 1.0 - share;
#if LAMPS
    if (has_highlights(lobes, followed)) ends = max(ends, HIGHLIGHT_CHANCE);
#endif
    if (chance.y < ends) {
      path.throughput /= ends;
      path.lobes |= followed;
      end_path(index, path);
      return;
    }
    path.throughput /= 1.0 - ends;
  }

  BsdfSample next = bsdf_sample(only(lobes, followed),
                                vec3(path_pair(key, frame.sampling.x, 2u * events), chance.x));
  if (!(next.pdf > 0.0)) return;
  path.throughput *= (next.value.glossy + next.value.transmission) / next.pdf;
  float strength = max(max(path.throughput.r, path.throughput.g), path.throughput.b);
  if (!(strength > 0.0 && strength < 1.0e30)) return;
  bool refracts = next.kind == BOUNCE_TRANSMISSION;
  if (events == 0u && refracts)
    imageStore(direct_light, pixel_of(path), vec4(vec3(0.0), float(path.lobes | LEFT_BY_REFRACTION)));
  path.way += distance(texelFetch(rays_in, int(index) * 3).xyz, position);
  store_path(index, path);

  bool below = dot(lobes.geometric_normal, next.direction) < 0.0;
  vec3 origin = position + (below ? -offset : offset) * lobes.geometric_normal;
  uint seed = hash(key + hash(frame.sampling.x ^ hash(events + 1u)));
  rays[index] = TracedRay(origin.x, origin.y, origin.z, 0.0, next.direction.x, next.direction.y,
                          next.direction.z, frame.camera.w, NO_PRIMITIVE,
                          refracts ? SEEN_BY_TRANSMISSION : SEEN_BY_GLOSSY, seed, path.pixel);
#if COLORED_ALPHA
  passed[index] = vec4(1.0, 1.0, 1.0, 0.0);
#endif
  going[atomicAdd(going_count, 1u)] = index;
}
