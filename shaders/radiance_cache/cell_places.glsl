// Where in a cell light is received. In voxels of the cell's volume, from its lowest corner.
#include "radiance_cache/cells.glsl"
#include "radiance_cache/reach.glsl"
#include "radiance_cache/volume.glsl"

#if WALLS
layout(binding = REACH_UNIT) uniform usamplerBuffer reach;  // of voxels by number
#endif

// Light is received anywhere in the cell that its seed sees (or, without WALLS, anywhere that is empty),
// if so many tries find such a place; else in the seed's own voxel. So light on the two sides of a wall
// is not mixed.
const int TRIES = 8;

// The middle of the seed's voxel. `code`: a word of seeds (cells.glsl).
vec3 seed_in_volume(CacheVolume volume, ivec3 cell, uint code) {
  return vec3(cell * volume.cells.w) + vec3(seed_voxel(code)) + 0.5;
}

// A point of the unit cube drawn by `random`, which moves on.
vec3 random_point(inout uint random) {
  vec3 u;
  for (int axis = 0; axis < 3; ++axis) {
    random = hash(random);
    u[axis] = unit_float(random);
  }
  return u;
}

// Whether light is received at a place of the cell.
bool is_open(CacheVolume volume, ivec3 cell, vec3 place) {
  ivec3 first = cell * volume.cells.w;
  ivec3 voxel = clamp(ivec3(place), first, first + volume.cells.w - 1);
#if WALLS
  int number = word_of(volume, voxel) * 32 + (voxel.x & 31);
  return (texelFetch(reach, number).x & reach_bit(ivec3(0))) != 0u;
#else
  return !voxel_is_solid(volume, voxel);
#endif
}

// A place: the one at the share `u` of the cell (0 to 1 each), or another one drawn by `random`, which
// moves on.
vec3 place_in_cell(CacheVolume volume, ivec3 cell, vec3 seed, vec3 u, inout uint random) {
  vec3 place = seed;
  bool seen = false;
  for (int i = 0; i <= TRIES && !seen; ++i) {
    place = i < TRIES ? (vec3(cell) + u) * float(volume.cells.w) : seed + u - 0.5;
    seen = is_open(volume, cell, place);
    u = random_point(random);
  }
  return place;
}
