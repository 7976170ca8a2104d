// Where in a cell light is received. In voxels of the cell's volume, from its lowest corner.
#include "radiance_cache/cells.glsl"
#include "radiance_cache/volume.glsl"

// Light is received anywhere in the cell that its seed sees, if so many tries find such a place; else in
// the seed's own voxel. So light on the two sides of a wall is not mixed.
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

// Whether no solid voxel lies between two points at most a cell apart.
bool sees(CacheVolume volume, vec3 from, vec3 to) {
  vec3 way = to - from;
  float reach = max(abs(way.x), max(abs(way.y), abs(way.z)));
  int steps = int(ceil(2.0 * reach));
  bool open = true;
  for (int i = 1; i <= steps && open; ++i)
    open = !voxel_is_solid(volume, ivec3(from + way * (float(i) / float(steps))));
  return open;
}

// A place: the one at the share `u` of the cell (0 to 1 each), or another one drawn by `random`, which
// moves on.
vec3 place_in_cell(CacheVolume volume, ivec3 cell, vec3 seed, vec3 u, inout uint random) {
  vec3 place = seed;
  bool seen = false;
  for (int i = 0; i <= TRIES && !seen; ++i) {
    place = i < TRIES ? (vec3(cell) + u) * float(volume.cells.w) : seed + u - 0.5;
    seen = sees(volume, seed, place);
    u = random_point(random);
  }
  return place;
}
