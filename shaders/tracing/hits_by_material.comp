// Sorts rays by the material that they met, those that met nothing behind all others: counts them
// (PLACED 0), then lists them (PLACED 1), where `bins` begin as the numbers of rays in all bins
// before. With ALPHA_ONLY only the rays that met a surface with an alpha are sorted.
#include "base/invocation.glsl"
#include "tracing/rays_shared.h"

layout(local_size_x = 64) in;
layout(binding = 7) uniform samplerBuffer triangles;  // as TracedTriangle
layout(std430, binding = 0) readonly buffer Hits { TracedHit hits[]; };
#if LISTED
layout(std430, binding = 3) readonly buffer Listed { uint listed[]; };
#endif
#if PLACED
layout(std430, binding = 4) writeonly buffer Sorted { uint by_material[]; };
#endif
layout(std430, binding = 5) buffer Bins { uint bins[]; };
layout(location = 1) uniform uint count;
layout(location = 2) uniform uint materials;

void main() {
  uint slot = invocation();
  if (slot >= count) return;
#if LISTED
  uint ray = listed[slot];
#else
  uint ray = slot;
#endif
  uint primitive = hits[ray].primitive;
  uint bin = materials;
  if (primitive != NO_PRIMITIVE) {
    uint flags = floatBitsToUint(texelFetch(triangles, int(primitive) * 3 + 2).w);
    bin = flags >> TRIANGLE_MATERIAL_SHIFT;
#if ALPHA_ONLY
    if ((flags & TRIANGLE_HAS_ALPHA) == 0u) return;
  } else {
    return;
#endif
  }
  uint place = atomicAdd(bins[bin], 1u);
#if PLACED
  by_material[place] = ray;
#endif
}
