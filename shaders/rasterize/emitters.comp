// The radiance that leaves points of glowing surfaces, to the front and to the back, square to the
// surface. One material runs over its own points.
#include "base/invocation.glsl"
#include "gpu_scene/material.glsl"
#include "generated/material.glsl"
#include "rasterize/emitters_shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 3) readonly buffer Places { EmitterPlace places[]; };
layout(std430, binding = 4) writeonly buffer Radiances { EmitterRadiance radiances[]; };
layout(location = 1) uniform uvec2 range;  // first, count

vec3 radiance(EmitterPlace place, float side) {
  uvec3 v = texelFetch(triangle_vertices,
                       int(table(fetch_mesh_record(place.instance) + MESH_TRIANGLE_BASE) +
                           place.triangle)).xyz +
            table(fetch_mesh_record(place.instance) + MESH_VERTEX_BASE);
  Transform transform = fetch_transform(place.instance, view.world_origin.xyz);
  vec3 p0 = texelFetch(vertex_positions, int(v.x)).xyz;
  vec3 e1 = transform.linear * (texelFetch(vertex_positions, int(v.y)).xyz - p0);
  vec3 e2 = transform.linear * (texelFetch(vertex_positions, int(v.z)).xyz - p0);
  // A ray that falls on the place, square to the triangle, from about the triangle's size away.
  vec3 normal = safe_normalize(cross(e1, e2), vec3(0.0, 0.0, 1.0)) *
                determinant_sign(transform.linear) * side;
  Ray ray;
  ray.direction = -normal;
  ray.origin = transform.linear * p0 + transform.translation + place.u * e1 + place.v * e2 +
               normal * max(length(e1), length(e2));
  Surface surface = empty_surface();
  evaluate_material(fetch_hit(ray, place.instance, place.triangle), surface);
  return max(finite(surface.emission), vec3(0.0));
}

void main() {
  uint i = invocation();
  if (i >= range.y) return;
  i += range.x;
  radiances[i].front = vec4(radiance(places[i], 1.0), 0.0);
  radiances[i].back = vec4(radiance(places[i], -1.0), 0.0);
}
