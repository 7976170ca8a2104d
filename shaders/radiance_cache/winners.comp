// Who has the greatest key of each solid voxel, the first of them if they are many; one invocation a
// contender.
#include "base/invocation.glsl"
#include "radiance_cache/volume.glsl"
#include "radiance_cache/voxels_shared.h"

layout(local_size_x = 64) in;
layout(binding = 1) uniform usamplerBuffer voxels;  // area, greatest key
layout(std430, binding = 0) readonly buffer Contenders {
  uint contender_count, unused;
  Contender contenders[];
};
layout(std430, binding = 1) buffer Winners { uint winners[]; };  // by number of solid voxel
layout(location = 0) uniform uint count;

void main() {
  uint i = invocation();
  if (i >= count) return;
  Contender contender = contenders[i];
  uint bit = contender.voxel & 31u;
  uvec2 word = texelFetch(volume_words, int(contender.voxel >> 5)).xy;
  if ((word.x >> bit & 1u) != 0u && texelFetch(voxels, int(contender.voxel)).y == contender.key)
    atomicMin(winners[solid_number(word, bit)], contender.primitive);
}
