// Finds what reaches each empty voxel (reach.glsl): which seeds of the cells about it see its middle.
// One invocation a voxel; what no cell that has changed is about stays as it is.
#include "base/invocation.glsl"
#include "radiance_cache/cells.glsl"
#include "radiance_cache/reach.glsl"
#include "radiance_cache/volume.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Reach { uint reach[]; };  // by number of voxel
layout(binding = 0) uniform usamplerBuffer seeds;  // of all cells
layout(location = 0) uniform uint count;           // voxels

// Whether no solid voxel lies on the way from the middle of one to that of another: every voxel that a
// line between them passes, and at a corner one more.
bool sees(CacheVolume volume, ivec3 from, ivec3 to) {
  ivec3 way = sign(to - from), left = abs(to - from);
  // The line passes the borders of n voxels along an axis at (k + 1/2) / n.
  vec3 pace = 1.0 / vec3(max(left, ivec3(1))), next = 0.5 * pace + vec3(equal(left, ivec3(0))) * 2.0;
  bool open = true;
  for (int i = left.x + left.y + left.z; i > 0 && open; --i) {
    int axis = next.x <= next.y && next.x <= next.z ? 0 : next.y <= next.z ? 1 : 2;
    next[axis] += pace[axis];
    from[axis] += way[axis];
    open = !voxel_is_solid(volume, from);
  }
  return open;
}

void main() {
  uint number = spread_invocation(64u);
  if (number >= count) return;
  CacheVolume volume = cache.volumes[volume_of_word(int(number >> 5))];
  ivec3 voxel = voxel_of_word(volume, int(number >> 5)) + ivec3(number & 31u, 0, 0);
  int side = volume.cells.w;
  ivec3 own = voxel / side, half_way = 2 * (voxel - own * side) + 1 - side;
  // The cells that a look-up here can go to: none beyond the far side of its own.
  ivec3 low = max(own - ivec3(lessThanEqual(half_way, ivec3(0))), ivec3(0));
  ivec3 high = min(own + ivec3(greaterThanEqual(half_way, ivec3(0))), volume.cells.xyz - 1);
  uint bits = 0u, solid = 0u, about = 0u;  // solid: those with solid voxels
  for (int z = low.z; z <= high.z; ++z)
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x) {
        ivec3 at = ivec3(x, y, z);
        uint cell = texelFetch(seeds, cell_number(volume, at)).x;
        about |= cell;
        if ((cell & CELL_OCCUPIED) != 0u) solid |= reach_bit(at - own);
      }
  if ((about & CELL_CHANGED) == 0u) return;
  if (holds_voxel(volume, voxel) && !voxel_is_solid(volume, voxel))
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
          ivec3 at = ivec3(x, y, z);
          uint seed = texelFetch(seeds, cell_number(volume, at)).x & SEED_CODE;
          if (seed == 0u) continue;
          // Between empty cells nothing stands in the way.
          bool open = (solid & reach_bits_between(at - own)) == 0u;
          if (open || sees(volume, at * side + seed_voxel(seed), voxel)) bits |= reach_bit(at - own);
        }
  reach[number] = bits;
}
