// Reading and counting what a path knows. Programs read states as texels, which is faster on
// llvmpipe, and write them through a storage block.
#include "base/packing.glsl"
#include "path_tracer/path_shared.h"

#if LIGHT_PASSES
const int STATE_TEXELS = 4;
#else
const int STATE_TEXELS = 2;
#endif

struct Path {
  vec3 throughput;
  float scattering_pdf, least_pdf;
  vec3 normal;  // smooth, of the surface that it left; 0 where that transmits
  uint turns;
  float way;  // from the camera on, metres
#if LIGHT_PASSES
  vec3 diffuse_share, glossy_share;
#endif
};

// How often the path was scattered, from bit 0 on: 11 bits in all, then 6 bits by each kind of lobe,
// which end at 63. Bit 29: the surface that it left transmits.
const uint MOST_BY_KIND = 63u;
const uint FROM_BOTH_SIDES = 1u << 29;

uint turns_of_all(uint turns) { return turns & 2047u; }
// `kind`: 0 diffuse, 1 glossy, 2 transmission.
uint turns_of_kind(uint turns, uint kind) { return (turns >> (11u + 6u * kind)) & MOST_BY_KIND; }

uint with_turn(uint turns, uint kind, bool from_both_sides) {
  turns = (turns & ~FROM_BOTH_SIDES) + 1u;
  if (turns_of_kind(turns, kind) < MOST_BY_KIND) turns += 1u << (11u + 6u * kind);
  return from_both_sides ? turns | FROM_BOTH_SIDES : turns;
}

// Whether a path that was scattered so often ends at the surface that it meets. A limit that the
// counters do not reach is none.
bool ends_after(uint turns) {
  bool ends = turns_of_all(turns) > frame.limits.x;
  for (uint kind = 0u; kind < 3u; ++kind) ends = ends || turns_of_kind(turns, kind) > frame.limits[kind + 1u];
  return ends;
}

#ifdef STATE_UNIT
layout(binding = STATE_UNIT) uniform usamplerBuffer states;  // as PathState

Path fetch_path(uint i) {
  uvec4 texel0 = texelFetch(states, int(i) * STATE_TEXELS);
  uvec4 texel1 = texelFetch(states, int(i) * STATE_TEXELS + 1);
  Path path;
  path.throughput = uintBitsToFloat(texel0.xyz);
  path.scattering_pdf = uintBitsToFloat(texel0.w);
  path.least_pdf = uintBitsToFloat(texel1.x);
  path.turns = texel1.z;
  path.normal = (path.turns & FROM_BOTH_SIDES) != 0u ? vec3(0.0) : unpack_unit(texel1.y);
  path.way = uintBitsToFloat(texel1.w);
#if LIGHT_PASSES
  path.diffuse_share = uintBitsToFloat(texelFetch(states, int(i) * STATE_TEXELS + 2).xyz);
  path.glossy_share = uintBitsToFloat(texelFetch(states, int(i) * STATE_TEXELS + 3).xyz);
#endif
  return path;
}
#endif

// Weight of one of two ways to the same light by their densities (Veach's power heuristic).
float power_heuristic(float chosen, float other) {
  float ratio = other / chosen;  // squares of densities might overflow
  return 1.0 / (1.0 + ratio * ratio);
}
