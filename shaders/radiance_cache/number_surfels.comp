// Puts the surfels of voxels that are still solid into the order of words and bits; one invocation a
// surfel.
#include "base/invocation.glsl"
#include "radiance_cache/volume.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Listed { uint listed[]; };  // voxels: word * 32 + bit
layout(std430, binding = 1) readonly buffer From { Surfel from[]; };
layout(std430, binding = 2) writeonly buffer To { Surfel to[]; };
layout(location = 0) uniform uint count;  // of `from`

void main() {
  uint i = invocation();
  if (i >= count) return;
  uint voxel = listed[i];
  uvec2 word = texelFetch(volume_words, int(voxel >> 5)).xy;
  if ((word.x >> (voxel & 31u) & 1u) != 0u) to[solid_number(word, voxel & 31u)] = from[i];
}
