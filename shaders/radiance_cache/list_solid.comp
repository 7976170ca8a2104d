// Lists the solid voxels by the places that solid.comp gave them; one invocation a word.
#include "base/invocation.glsl"

layout(local_size_x = 64) in;
layout(binding = 0) uniform usamplerBuffer words;
layout(std430, binding = 0) writeonly buffer Listed { uint listed[]; };  // voxels: word * 32 + bit
layout(location = 0) uniform uint count;  // words

void main() {
  uint word = invocation();
  if (word >= count) return;
  uvec2 solid = texelFetch(words, int(word)).xy;
  for (uint bits = solid.x; bits != 0u; bits &= bits - 1u)
    listed[solid.y++] = word * 32u + uint(findLSB(bits));
}
