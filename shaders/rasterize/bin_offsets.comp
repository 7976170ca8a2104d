// One work group; each invocation adds up a run of bins, so that no invocation loops for long.
#include "rasterize/bins.glsl"

layout(local_size_x = 256) in;
shared uint sums[256];

Bin make_bin(uint first, uint count) {
  return Bin((count + BIN_GROUP - 1u) / BIN_GROUP, 1u, 1u, first, count, first, 0u, 0u);
}

void main() {
  uint me = gl_LocalInvocationIndex;
  uint bin_count = material_count + 1u;
  uint run = (bin_count + 255u) / 256u;
  uint begin = min(me * run, bin_count), end = min(begin + run, bin_count);
  uint sum = 0u;
  for (uint i = begin; i < end; ++i) sum += bins[i].count;
  sums[me] = sum;
  barrier();
  uint first = 0u;
  for (uint i = 0u; i < me; ++i) first += sums[i];
  for (uint i = begin; i < end; ++i) {
    uint count = bins[i].count;
    bins[i] = make_bin(first, count);
    if (i == material_count) bins[bin_count] = make_bin(0u, first);
    first += count;
  }
}
