// For programs of materials, with LOBES_APART: stores the surface that a ray has met.
#include "base/lobes.glsl"
#include "tracing/surface_record.glsl"

layout(std430, binding = 4) writeonly buffer Records { uvec4 records[]; };

// The largest size of a vector's components.
float reach(vec3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

// In record number `slot`, of ray number `ray`. `surface` is finished.
void store_surface(uint slot, uint ray, Hit hit, Surface surface) {
  uint record = slot * uint(SURFACE_TEXELS);
  // Wide enough for what positions on this triangle are rounded by, along the ray and in the list.
  float offset = RAY_OFFSET * (reach(hit.position) + reach(hit.edge1) + reach(hit.edge2));
  records[record] = uvec4(floatBitsToUint(hit.position), floatBitsToUint(offset));
  records[record + 1u] = uvec4(ray, floatBitsToUint(hit.bulge), 0u, 0u);
#if EMISSION
  records[record + 2u] = uvec4(floatBitsToUint(surface.emission), 0u);
#endif
  uvec4 lobes[LOBES_TEXELS];
  pack_lobes(lobes_of(hit, surface), lobes);
  for (int k = 0; k < LOBES_TEXELS; ++k) records[record + uint(LOBES_AT + k)] = lobes[k];
}
