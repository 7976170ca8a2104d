// The list of triangles that structures are built over and rays meet.
#include "tracing/rays_shared.h"

layout(binding = 0) uniform samplerBuffer triangles;  // as TracedTriangle

// A vector with component `axis` last; the order stays right-handed.
vec3 axis_last(vec3 v, int axis) { return axis == 0 ? v.yzx : axis == 1 ? v.zxy : v.xyz; }

struct Corners {
  vec3 p0, p1, p2;
  uint flags;
};

Corners fetch_corners(uint primitive) {
  int i = int(primitive) * 3;
  vec4 texel2 = texelFetch(triangles, i + 2);
  return Corners(texelFetch(triangles, i).xyz, texelFetch(triangles, i + 1).xyz, texel2.xyz,
                 floatBitsToUint(texel2.w));
}
