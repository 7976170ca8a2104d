// What the surfaces of solid voxels reflect, of one material; one invocation a voxel. Those that light
// passes vanish by that chance.
#include "base/invocation.glsl"
#include "gpu_scene/material.glsl"
#include "generated/material.glsl"
#include "radiance_cache/reflectance.glsl"
#include "radiance_cache/surfel_color.glsl"
#include "radiance_cache/volume_shared.h"
#include "tracing/rays_shared.h"

layout(local_size_x = 64) in;
layout(binding = 7) uniform samplerBuffer triangles;  // as TracedTriangle
layout(std430, binding = 0) readonly buffer Hits { TracedHit hits[]; };
layout(std430, binding = 1) buffer Words { uvec2 words[]; };
layout(std430, binding = 2) buffer Surfels { Surfel surfels[]; };
layout(std430, binding = 3) readonly buffer Listed { uint listed[]; };  // voxels: word * 32 + bit
layout(std430, binding = 4) readonly buffer Sorted { uint by_material[]; };
layout(location = 1) uniform uvec2 range;  // of by_material: first, count

// Where half of a diffuse surface's light leaves below: its mean over all directions, by cosine.
const float MEAN_COSINE = 2.0 / 3.0;

struct Side {
  vec3 color;    // what it reflects of what does not pass
  float solid;   // what does not pass
};

Side side_of(Surfel surfel, uint triangle, vec3 normal, vec3 along, float reach) {
  Ray ray;
  ray.direction = -(MEAN_COSINE * normal + sqrt(1.0 - MEAN_COSINE * MEAN_COSINE) * along);
  ray.origin = surfel.place.xyz - ray.direction * reach;
  Hit hit = fetch_hit(ray, surfel.surface.w, triangle);
  Surface surface = empty_surface();
  evaluate_material(hit, surface);
  finish_surface(hit, surface);

  vec3 color = reflectance(surface, hit.view);
  float reflecting = 1.0 - clamp(luminance(surface.transmission), 0.0, 1.0);
  Side side;
  side.color = clamp(finite(color / max(reflecting, 1.0e-3)), 0.0, 1.0);
  side.solid = reflecting * (1.0 - clamp(luminance(finite(surface.transparency)), 0.0, 1.0));
  return side;
}

void main() {
  uint i = invocation();
  if (i >= range.y) return;
  uint number = by_material[range.x + i];
  Surfel surfel = surfels[number];
  uint primitive = hits[number].primitive;
  int texel = int(primitive) * 3;
  vec3 p0 = texelFetch(triangles, texel).xyz;
  vec4 p1 = texelFetch(triangles, texel + 1);
  vec3 e1 = p1.xyz - p0, e2 = texelFetch(triangles, texel + 2).xyz - p0;
  uint triangle = floatBitsToUint(p1.w);
  float reach = max(length(e1), length(e2));
  vec3 normal = safe_normalize(cross(e1, e2), vec3(0.0, 0.0, 1.0)) *
                determinant_sign(fetch_transform(surfel.surface.w, view.world_origin.xyz).linear);
  vec3 along = safe_normalize(e1, vec3(1.0, 0.0, 0.0));

  Side front = side_of(surfel, triangle, normal, along, reach);
#if SIDES_DIFFER
  Side back = side_of(surfel, triangle, -normal, along, reach);
#else
  Side back = front;
#endif
  surfels[number].surface.xyz = uvec3(pack_unit(normal), pack_color(front.color), pack_color(back.color));
  // Each side stands for the light that falls on it.
  uint voxel = listed[number];
  if (unit_float(surfel.surface.x) >= 0.5 * (front.solid + back.solid))
    atomicAnd(words[voxel >> 5].x, ~(1u << (voxel & 31u)));
}
