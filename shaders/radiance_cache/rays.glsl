// The directions that cells look in, and what they have met there.
#include "base/packing.glsl"

// What a ray has met: a surfel's number times two, plus one for its back; or nothing.
const uint RAY_MISS = 0xffffffffu;

const float CACHE_PI = 3.14159265359;

// The k-th of `count` directions spread evenly over the sphere (a Fibonacci spiral), turned about z
// by the `turn`-th part of a whole turn so that cells do not all miss the same things.
vec3 cache_direction(uint k, uint count, float turn) {
  float z = 1.0 - (2.0 * float(k) + 1.0) / float(count);
  float phi = 2.0 * CACHE_PI * (turn + fract(float(k) * 0.61803398875));
  return vec3(sqrt(max(1.0 - z * z, 0.0)) * vec2(cos(phi), sin(phi)), z);
}

// Of a cell, by its place on the lattice of cells in world space: a volume that moves on by whole
// cells leaves each cell with its own.
float cell_turn(ivec3 lattice, uint seed) {
  return unit_float(hash(uint(lattice.x) ^ hash(uint(lattice.y) ^ hash(uint(lattice.z) ^ hash(seed)))));
}
