// Random numbers of paths: Owen-scrambled (0,2)-Sobol pairs (Burley 2020), reproducible from the
// pixel's key, the sample's index and the dimension alone.
#include "base/packing.glsl"

// Sobol's second generator matrix times the bits of `index`: Pascal's triangle modulo 2, a Kronecker
// power, so that five steps do. Bits come out in reverse order.
uint second_dimension(uint index) {
  index ^= (index & 0xaaaaaaaau) >> 1;
  index ^= (index & 0xccccccccu) >> 2;
  index ^= (index & 0xf0f0f0f0u) >> 4;
  index ^= (index & 0xff00ff00u) >> 8;
  return index ^ (index >> 16);
}

// The `index`-th point of the pair of dimensions `dimension`, in [0, 1)^2; the points that
// film::sample_point() has for the seed `key`.
vec2 path_pair(uint key, uint index, uint dimension) {
  uint seed = hash(key ^ hash(dimension));
  uint shuffled = bitfieldReverse(scramble_upwards(bitfieldReverse(index), seed));
  uint first = bitfieldReverse(scramble_upwards(shuffled, hash(seed)));
  uint second = bitfieldReverse(scramble_upwards(second_dimension(shuffled), hash(seed + 1u)));
  return vec2(unit_float(first), unit_float(second));
}
