// A point of the triangle that stands for each solid voxel, drawn evenly from its part in the voxel;
// one invocation a voxel.
#include "base/invocation.glsl"
#include "radiance_cache/volume.glsl"
#include "radiance_cache/voxels.glsl"

layout(local_size_x = 64) in;
layout(binding = 0) uniform samplerBuffer triangles;  // as TracedTriangle
layout(binding = 1) uniform usamplerBuffer voxels;    // area, key
layout(std430, binding = 0) readonly buffer Listed { uint listed[]; };
layout(std430, binding = 1) readonly buffer Winners { uint winners[]; };
// Of their surfaces only the instance, and in x a random number.
layout(std430, binding = 2) writeonly buffer Surfels { Surfel surfels[]; };
layout(std430, binding = 3) writeonly buffer Hits { TracedHit hits[]; };
layout(location = 0) uniform uint count;  // solid voxels

const int LINES = 16;  // over the triangle's part, one of which the point lies on

// The ends of the triangle's part of the voxel on a line across the columns.
vec2 ends_on_line(Placed t, float y, ivec3 voxel) {
  float low = float(voxel.x + 1), high = float(voxel.x);
  vec2 corners[4] = vec2[4](t.p0.xy, t.p1.xy, t.p2.xy, t.p0.xy);
  for (int i = 0; i < 3; ++i) {
    vec2 p = corners[i], q = corners[i + 1];
    if (y < min(p.y, q.y) || y > max(p.y, q.y)) continue;
    float x = p.x + (q.x - p.x) * (q.y != p.y ? (y - p.y) / (q.y - p.y) : 0.0);
    low = min(low, x);
    high = max(high, x);
  }
  vec2 ends = clamp(vec2(low, high), float(voxel.x), float(voxel.x + 1));
  // Where the plane enters and leaves the voxel's depths.
  float start = t.p1.z + t.slope.y * (y - t.p1.y), slope = t.slope.x;
  vec2 depths = vec2(voxel.z, voxel.z + 1);
  if (abs(slope) < 1.0e-5) {
    bool within = start + 1.0e-3 >= depths.x && start - 1.0e-3 <= depths.y;
    return within ? ends : ends.xx;
  }
  vec2 at = t.p1.x + (depths - start) / slope;
  return clamp(ends, min(at.x, at.y), max(at.x, at.y));
}

void main() {
  uint number = invocation();
  if (number >= count) return;
  uint index = listed[number], primitive = winners[number];
  int word = int(index >> 5), of_volume = 0;
  for (int i = 1; i < cache.count.x; ++i)
    if (word >= cache.volumes[i].first.y) of_volume = i;
  CacheVolume volume = cache.volumes[of_volume];
  int row = (word - volume.first.y) / volume.first.x, rows = volume.cells.y * volume.cells.w;
  ivec3 voxel = ivec3((word - volume.first.y - row * volume.first.x) * 32 + int(index & 31u), row % rows,
                      row / rows);
  int texel = int(primitive) * 3;
  vec4 t0 = texelFetch(triangles, texel);
  vec3 e1 = texelFetch(triangles, texel + 1).xyz - t0.xyz, e2 = texelFetch(triangles, texel + 2).xyz - t0.xyz;
  Placed t;
  place(volume, t0.xyz, t0.xyz + e1, t0.xyz + e2, t);
  ivec3 at = axis_last(voxel, t.axis);

  // One of the lines by the length that the triangle has on it, and evenly along it.
  uint seed = hash(voxel_seed(primitive, voxel, of_volume) + 1u);
  float low = max(min(t.p0.y, min(t.p1.y, t.p2.y)), float(at.y));
  float high = min(max(t.p0.y, max(t.p1.y, t.p2.y)), float(at.y + 1));
  float sum = 0.0, shift = unit_float(hash(seed + 1u)), along = unit_float(hash(seed + 2u));
  vec2 chosen = clamp((t.p0.xy + t.p1.xy + t.p2.xy) / 3.0, vec2(at.xy), vec2(at.xy + 1));
  for (int i = 0; i < LINES; ++i) {
    float y = mix(low, high, (float(i) + shift) / float(LINES));
    vec2 ends = ends_on_line(t, y, at);
    float part = max(ends.y - ends.x, 0.0);
    sum += part;
    seed = hash(seed);
    if (part > 0.0 && unit_float(seed) * sum < part) chosen = vec2(mix(ends.x, ends.y, along), y);
  }
  vec3 place = vec3(chosen, t.p1.z + dot(t.slope, chosen - t.p1.xy));

  // Its barycentric coordinates, as seen along the axis.
  vec3 base = axis_last((t0.xyz - volume.low.xyz) / voxel_size(volume), t.axis);
  vec2 offset = place.xy - base.xy;
  vec2 a = axis_last(e1, t.axis).xy / voxel_size(volume), b = axis_last(e2, t.axis).xy / voxel_size(volume);
  float determinant = a.x * b.y - a.y * b.x;
  float inverse = determinant != 0.0 ? 1.0 / determinant : 0.0;
  float u = clamp((offset.x * b.y - offset.y * b.x) * inverse, 0.0, 1.0);
  float v = clamp((a.x * offset.y - a.y * offset.x) * inverse, 0.0, 1.0 - u);
  hits[number] = TracedHit(0.0, primitive, u, v);
  vec3 position = clamp(axis_back(place, t.axis), vec3(voxel), vec3(voxel + 1)) * voxel_size(volume) +
                  volume.low.xyz;
  float area = float(texelFetch(voxels, int(index)).x) / AREA_STEPS * voxel_size(volume) *
               voxel_size(volume);
  surfels[number] = Surfel(vec4(position, area), uvec4(hash(seed + 3u), 0u, 0u, floatBitsToUint(t0.w)));
}
