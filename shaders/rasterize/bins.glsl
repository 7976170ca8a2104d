// Pixels sorted by what they show: a bin for each material, then one for the background. Each
// program runs over its own pixels only, since on llvmpipe a branch skips no arithmetic.
#include "gpu_scene/view_shared.h"

layout(std430, binding = 0) readonly buffer Records { DrawRecord records[]; };
struct Bin {
  uint groups_x, groups_y, groups_z;  // indirect dispatch, BIN_GROUP invocations a group
  uint first;                         // in `pixels`
  uint count;
  uint cursor;
  uint padding0, padding1;
};
// Materials, background, and last the union of all materials.
layout(std430, binding = 1) buffer Bins { Bin bins[]; };
layout(std430, binding = 2) buffer Pixels { uint pixels[]; };  // y * width + x
layout(location = 1) uniform uint material_count;

const uint BIN_GROUP = 64u;

uint bin_of(uint record) {
  return record == 0u ? material_count : records[record - 1u].material;
}

ivec2 pixel_of(uint index) {
  return ivec2(int(index) % view.size.x, int(index) / view.size.x);
}
