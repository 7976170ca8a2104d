// Unit vectors in 32 bits (octahedral map, 2 x 16 bits; the largest error is .0037 degrees), colours
// in 32 bits, and the integer hash behind every per-pixel random number.

vec2 octahedral_from_unit(vec3 n) {
  n /= abs(n.x) + abs(n.y) + abs(n.z);
  vec2 folded = (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
  return n.z >= 0.0 ? n.xy : folded;
}

uint pack_unit(vec3 n) { return packSnorm2x16(octahedral_from_unit(n)); }

vec3 unpack_unit(uint word) {
  vec2 o = unpackSnorm2x16(word);
  vec3 n = vec3(o, 1.0 - abs(o.x) - abs(o.y));
  float fold = max(-n.z, 0.0);
  n.xy += vec2(n.x >= 0.0 ? -fold : fold, n.y >= 0.0 ? -fold : fold);
  return normalize(n);
}

// A colour that is not negative: eight bits each and an exponent, so of any size; off by at most
// 1/256 of its largest part.
uint pack_light(vec3 c) {
  c = max(c, vec3(0.0));
  float largest = max(c.r, max(c.g, c.b));
  if (!(largest >= 1.0e-36)) return 0u;
  int exponent = clamp(int(floor(log2(largest * (256.0 / 255.5)))) + 1, -119, 120);
  uvec3 parts = uvec3(min(c * exp2(float(8 - exponent)) + 0.5, vec3(255.0)));
  return parts.r | parts.g << 8 | parts.b << 16 | uint(exponent + 127) << 24;
}

vec3 unpack_light(uint word) {
  return vec3(uvec3(word, word >> 8, word >> 16) & 255u) * exp2(float(int(word >> 24) - 135));
}

// PCG's permutation on one word (O'Neill 2014; as a hash: Jarzynski and Olano 2020).
uint hash(uint x) {
  uint state = x * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}

// A hash in which low bits only reach higher ones (Laine and Karras 2011, with the constants of
// Vegdahl 2021): applied to reversed bits it is nested (Owen) scrambling.
uint scramble_upwards(uint x, uint seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

// The van der Corput sequence with its indices shuffled and its values scrambled, both nested: for
// each `seed` another sequence, stratified over every power of two of indices, and independent of
// the others. 32 bits of a value in [0, 1).
uint shuffled_radical_inverse(uint index, uint seed) {
  index = bitfieldReverse(scramble_upwards(bitfieldReverse(index), seed));
  return bitfieldReverse(scramble_upwards(index, hash(seed)));
}

// Uniform in [0, 1), from the 24 bits that a float can hold.
float unit_float(uint bits) { return float(bits >> 8) * (1.0 / 16777216.0); }
