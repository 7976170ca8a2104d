// Which voxels are solid, and the places of those of a word in a list of all, in any order; one
// invocation a word.
//
// A voxel is solid that holds enough of surfaces. A wall that runs on the border between two voxels, or
// at an angle to them, has too little in either: then that one is solid which has more of it, so that
// rays do not pass. As seen along an axis, every part of such a wall is at least as large as a face.
#include "base/invocation.glsl"
#include "radiance_cache/volume.glsl"
#include "radiance_cache/voxels_shared.h"

layout(local_size_x = 64) in;
layout(binding = 0) uniform usamplerBuffer voxels;  // area, greatest key of who is in it
layout(std430, binding = 0) writeonly buffer Words { uvec2 words[]; };
layout(std430, binding = 1) buffer Count { uint solid; };
layout(location = 0) uniform uint count;      // words
layout(location = 1) uniform uint least;      // area

// Of a whole wall in two voxels; less than a face by what rounding may take.
const uint WHOLE = uint(0.98 * AREA_STEPS);

// Whether the voxel has more of a wall than one of its neighbours that has the rest.
bool holds_wall(CacheVolume volume, ivec3 voxel, uint area) {
  bool holds = false;
  for (int i = 0; i < 6; ++i) {
    ivec3 step = ivec3(0);
    step[i % 3] = i < 3 ? 1 : -1;
    ivec3 at = voxel + step;
    if (!holds_voxel(volume, at)) continue;
    uint other = texelFetch(voxels, word_of(volume, at) * 32 + (at.x & 31)).x;
    // Of two that have the same, the one before.
    bool more = i < 3 ? area >= other : area > other;
    holds = holds || (more && area + other >= WHOLE);
  }
  return holds;
}

void main() {
  uint word = invocation();
  if (word >= count) return;
  CacheVolume volume = cache.volumes[volume_of_word(int(word))];
  ivec3 first_voxel = voxel_of_word(volume, int(word));
  uint bits = 0u;
  for (int i = 0; i < 32; ++i) {
    uvec2 voxel = texelFetch(voxels, int(word) * 32 + i).xy;
    if (voxel.y == 0u) continue;
    // The larger part of a wall is at least half of it.
    bool wall = voxel.x < least && voxel.x >= WHOLE / 2u &&
                holds_wall(volume, first_voxel + ivec3(i, 0, 0), voxel.x);
    if (voxel.x >= least || wall) bits |= 1u << i;
  }
  uint first = 0u;
  if (bits != 0u) first = atomicAdd(solid, uint(bitCount(bits)));
  words[word] = uvec2(bits, first);
}
