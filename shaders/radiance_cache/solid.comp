// Which voxels are solid, and the places of those of a word in a list of all, in any order; one
// invocation a word.
#include "base/invocation.glsl"

layout(local_size_x = 64) in;
layout(binding = 0) uniform usamplerBuffer voxels;  // area, greatest key of who is in it
layout(std430, binding = 0) writeonly buffer Words { uvec2 words[]; };
layout(std430, binding = 1) buffer Count { uint solid; };
layout(location = 0) uniform uint count;      // words
layout(location = 1) uniform uint least;      // area

void main() {
  uint word = invocation();
  if (word >= count) return;
  uint bits = 0u;
  for (int i = 0; i < 32; ++i) {
    uvec2 voxel = texelFetch(voxels, int(word) * 32 + i).xy;
    if (voxel.x >= least && voxel.y != 0u) bits |= 1u << i;
  }
  uint first = 0u;
  if (bits != 0u) first = atomicAdd(solid, uint(bitCount(bits)));
  words[word] = uvec2(bits, first);
}
