// Sums the area of triangles in each voxel and draws one triangle of each by its area there; one
// invocation a triangle, or (LARGE) one work group a triangle whose box has many columns, which the
// others list.
//
// A triangle is drawn by weighted reservoir sampling (Efraimidis and Spirakis 2006): each has a key
// from a random number of its own, and the greatest wins. Whoever has a greater one than all before is
// listed with it, so that the one who wins in the end is found among few; who else is depends on the
// order in which things run, but not who wins.
#include "base/invocation.glsl"
#include "radiance_cache/volume.glsl"
#include "radiance_cache/voxels.glsl"
#include "scene/visibility_shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Voxels { uvec2 voxels[]; };  // area, greatest key
layout(std430, binding = 1) buffer Large { uint large_count, large[]; };
layout(std430, binding = 2) buffer Contenders { uint contender_count, unused; Contender contenders[]; };
layout(location = 0) uniform uint count;  // triangles, or large ones
layout(location = 1) uniform uint room;   // in `contenders`

const int MOST_COLUMNS = 64;  // of a triangle that one invocation takes

void visit(uint primitive, CacheVolume volume, ivec3 voxel, float area) {
  uint seed = voxel_seed(primitive, voxel, volume_index);
  // -log of a random number in (0, 1) is distributed exponentially.
  uint key = floatBitsToUint(area / -log((float(seed >> 8) + 0.5) / 16777216.0));
  uint index = uint(word_of(volume, voxel) * 32 + (voxel.x & 31));
  // Rounded by chance, or many tiny triangles would come to nothing.
  atomicAdd(voxels[index].x, uint(area * AREA_STEPS + unit_float(bitfieldReverse(seed))));
  if (atomicMax(voxels[index].y, key) < key) {
    uint place = atomicAdd(contender_count, 1u);
    if (place < room) contenders[place] = Contender(index, key, primitive);
  }
}

void main() {
#if LARGE
  uint item = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  if (item >= count) return;
  uint primitive = large[item];
  int column = int(gl_LocalInvocationIndex), stride = 64;
#else
  uint primitive = spread_invocation(16u);
  if (primitive >= count) return;
  int column = 0, stride = 1;
#endif
  Corners corners = fetch_corners(primitive);
  if ((corners.flags & SEEN_BY_DIFFUSE) == 0u) return;
  CacheVolume volume = cache.volumes[volume_index];
  Placed t;
  if (!place(volume, corners.p0, corners.p1, corners.p2, t)) return;
  int width = t.high.x - t.low.x + 1, columns = width * (t.high.y - t.low.y + 1);
#if !LARGE
  if (columns > MOST_COLUMNS) {
    large[atomicAdd(large_count, 1u)] = primitive;
    return;
  }
#endif
  ivec3 voxel;
  int deepest = -1;
  for (bool next = true; column < columns;) {
    if (next) {
      voxel.xy = t.low.xy + ivec2(column % width, column / width);
      ivec2 depths = depths_of(t, voxel.xy);
      voxel.z = depths.x;
      deepest = depths.y;
    }
    float area = t.single ? t.area : area_within(t, voxel);
    if (area > 0.0) visit(primitive, volume, axis_back(voxel, t.axis), area);
    next = ++voxel.z > deepest;
    if (next) column += stride;
  }
}
