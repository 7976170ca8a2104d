// Writes every triangle of the scene as rays meet it: transformed, about the list's origin. One
// invocation a triangle.
//
// Vertices are transformed by the same operations in every triangle that shares them, so that they
// come out with the same bits: neighbours leave no gap (tracing/intersect.glsl).
#include "base/invocation.glsl"
#include "gpu_scene/geometry.glsl"
#include "tracing/flatten_shared.h"
#include "tracing/rays_shared.h"

layout(local_size_x = 64) in;
layout(binding = 6) uniform usamplerBuffer spans;  // as TriangleSpan
layout(std430, binding = 0) writeonly buffer Triangles { TracedTriangle list[]; };
layout(std430, binding = 1) coherent buffer Summary { FlattenSummary summary; };
layout(location = 0) uniform uvec2 counts;  // triangles, spans
layout(location = 1) uniform vec3 origin;

// The last span that begins at `primitive` or before.
TriangleSpan span_of(uint primitive) {
  uint low = 0u, high = counts.y - 1u;
  while (low < high) {
    uint middle = (low + high + 1u) / 2u;
    if (texelFetch(spans, int(middle)).x <= primitive) low = middle;
    else high = middle - 1u;
  }
  uvec4 span = texelFetch(spans, int(low));
  return TriangleSpan(span.x, span.y, span.z, span.w);
}

vec3 place(Transform transform, int vertex) {
  vec3 p = texelFetch(vertex_positions, vertex).xyz;
  precise vec3 placed = transform.linear[0] * p.x + transform.linear[1] * p.y +
                        transform.linear[2] * p.z + transform.translation;
  return placed;
}

// False for what is not a number, too.
bool within_reach(vec3 p) {
  return abs(p.x) <= FARTHEST && abs(p.y) <= FARTHEST && abs(p.z) <= FARTHEST;
}

// Whole numbers that are ordered as the floats are.
uint order_of(float x) {
  uint bits = floatBitsToUint(x);
  return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

void main() {
  uint primitive = invocation();
  if (primitive >= counts.x) return;
  TriangleSpan span = span_of(primitive);
  uint triangle = span.first_triangle + (primitive - span.first_primitive);
  int mesh = fetch_mesh_record(span.instance);
  Transform transform = fetch_transform(span.instance, origin);
  uvec3 v = texelFetch(triangle_vertices, int(table(mesh + MESH_TRIANGLE_BASE) + triangle)).xyz +
            table(mesh + MESH_VERTEX_BASE);
  vec3 a = place(transform, int(v.x)), b = place(transform, int(v.y)), c = place(transform, int(v.z));

  bool met = within_reach(a) && within_reach(b) && within_reach(c);
  if (met) {
    // Most triangles lie within what others have reported.
    vec3 low = min(a, min(b, c)), high = max(a, max(b, c));
    for (int i = 0; i < 3; ++i) {
      uint least = order_of(low[i]), most = order_of(high[i]);
      if (least < summary.low[i]) atomicMin(summary.low[i], least);
      if (most > summary.high[i]) atomicMax(summary.high[i], most);
    }
  } else {
    atomicAdd(summary.lost, 1u);
    a = b = c = vec3(0.0);
  }
  list[primitive] = TracedTriangle(a.x, a.y, a.z, span.instance, b.x, b.y, b.z, triangle, c.x, c.y,
                                   c.z, met ? span.flags : 0u);
}
