// The boxes that hold what the camera sees, in slabs of distance that halve from slab to slab.
#define G_BUFFER_READ 1
#include "rasterize/bins.glsl"
#include "rasterize/g_buffer.glsl"
#include "rasterize/visible_bounds_shared.h"

layout(local_size_x = 64) in;
// Cleared to zeros. Maxima of ordered_bits() of x, y, z and of -x, -y, -z; pixels.
layout(std430, binding = 3) buffer Slabs { VisibleSlab slabs[VISIBLE_SLABS]; };
layout(location = 2) uniform float farthest;  // distance at which slab 0 ends, metres

shared uint boxes[VISIBLE_SLABS][7];

// Floats as integers of the same order; zero bits come before all numbers.
uint ordered_bits(float x) {
  uint bits = floatBitsToUint(x);
  return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

void main() {
  for (uint i = gl_LocalInvocationIndex; i < VISIBLE_SLABS * 7u; i += 64u) boxes[i / 7u][i % 7u] = 0u;
  barrier();
  uint i = gl_GlobalInvocationID.x;
  if (i < bins[material_count + 1u].count) {
    vec3 p = texelFetch(g_position, pixel_of(pixels[i]), 0).xyz;
    float halvings = log2(farthest / max(length(p), 1.0e-30));
    uint slab = uint(clamp(halvings, 0.0, float(VISIBLE_SLABS - 1u)));
    for (int axis = 0; axis < 3; ++axis) {
      atomicMax(boxes[slab][axis], ordered_bits(p[axis]));
      atomicMax(boxes[slab][3 + axis], ordered_bits(-p[axis]));
    }
    atomicAdd(boxes[slab][6], 1u);
  }
  barrier();
  uint slab = gl_LocalInvocationIndex;
  if (slab < VISIBLE_SLABS && boxes[slab][6] > 0u) {
    for (int axis = 0; axis < 3; ++axis) {
      atomicMax(slabs[slab].high[axis], boxes[slab][axis]);
      atomicMax(slabs[slab].minus_low[axis], boxes[slab][3 + axis]);
    }
    atomicAdd(slabs[slab].pixels, boxes[slab][6]);
  }
}
