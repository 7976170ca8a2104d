// Finds the seed of each cell (cells.glsl), and which cells have a solid voxel in them, or others than
// the last time.
#include "base/invocation.glsl"
#include "radiance_cache/cells.glsl"
#include "radiance_cache/volume.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer Seeds { uint seeds[]; };  // seed_code(), CELL_OCCUPIED, CELL_CHANGED
// A number of 64 bits for the solid voxels of each cell.
layout(std430, binding = 1) buffer Contents { uvec2 contents[]; };
layout(location = 0) uniform bool anew;  // contents are not those of the same cells before

void main() {
  uint number = invocation();
  if (number >= uint(cache.count.y)) return;
  Cell cell = cell_of(cache, number);
  CacheVolume volume = cache.volumes[cell.volume];
  int side = volume.cells.w;
  bool occupied = false;
  float nearest = 1.0e30;
  uint seed = 0u;
  uvec2 content = uvec2(0u);
  for (int i = 0; i < side * side * side; ++i) {
    ivec3 voxel = ivec3(i % side, i / side % side, i / (side * side));
    bool solid = voxel_is_solid(volume, cell.at * side + voxel);
    vec3 off = vec3(voxel) + 0.5 - 0.5 * float(side);
    float squared = dot(off, off);
    occupied = occupied || solid;
    if (solid) content += uvec2(hash(uint(i) + 1u), hash(uint(i) + 0x10000u));
    if (!solid && squared < nearest) {
      nearest = squared;
      seed = seed_code(voxel);
    }
  }
  bool changed = anew || contents[number] != content;
  contents[number] = content;
  seeds[number] = seed | (occupied ? CELL_OCCUPIED : 0u) | (changed ? CELL_CHANGED : 0u);
}
