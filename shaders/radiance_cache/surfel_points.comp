// A point of the triangle that stands for each solid voxel, drawn evenly from its part in the voxel;
// one invocation a voxel.
#include "base/invocation.glsl"
#include "radiance_cache/volume.glsl"
#include "radiance_cache/voxels.glsl"

layout(local_size_x = 64) in;
layout(binding = 1) uniform usamplerBuffer voxels;    // area, key
layout(std430, binding = 0) readonly buffer Listed { uint listed[]; };
layout(std430, binding = 1) readonly buffer Winners { uint winners[]; };
// Of their surfaces only the instance, and in x a random number.
layout(std430, binding = 2) writeonly buffer Surfels { Surfel surfels[]; };
layout(std430, binding = 3) writeonly buffer Hits { TracedHit hits[]; };
layout(location = 0) uniform uint count;  // solid voxels

const int LINES = 16;  // over the triangle's part, one of which the point lies on

// Where on a line at `y` a polygon lies; first above last where it does not.
vec2 ends_on_line(vec2 corners[5], float y) {
  vec2 ends = vec2(1.0e30, -1.0e30);
  for (int i = 0; i < 5; ++i) {
    vec2 p = corners[i], q = corners[(i + 1) % 5];
    if (y < min(p.y, q.y) || y > max(p.y, q.y)) continue;
    float x = p.x + (q.x - p.x) * (q.y != p.y ? (y - p.y) / (q.y - p.y) : 0.0);
    ends = vec2(min(ends.x, x), max(ends.y, x));
  }
  return ends;
}

// The lines at which a polygon lies within the unit square.
vec2 lines_of(vec2 corners[5]) {
  vec2 lines = vec2(1.0e30, -1.0e30);
  for (int i = 0; i < 5; ++i) {
    vec2 p = corners[i], q = corners[(i + 1) % 5];
    if (max(p.x, q.x) < 0.0 || min(p.x, q.x) > 1.0) continue;
    float run = q.x - p.x, steepness = run != 0.0 ? (q.y - p.y) / run : 0.0;
    vec2 ends = p.yy + (clamp(vec2(p.x, q.x), 0.0, 1.0) - p.x) * steepness;
    if (run == 0.0) ends = vec2(p.y, q.y);
    lines = vec2(min(lines.x, min(ends.x, ends.y)), max(lines.y, max(ends.x, ends.y)));
  }
  return clamp(lines, 0.0, 1.0);
}

void main() {
  uint number = invocation();
  if (number >= count) return;
  uint index = listed[number], primitive = winners[number];
  int of_volume = volume_of_word(int(index >> 5));
  CacheVolume volume = cache.volumes[of_volume];
  ivec3 voxel = voxel_of_word(volume, int(index >> 5)) + ivec3(index & 31u, 0, 0);
  int texel = int(primitive) * 3;
  vec4 t0 = texelFetch(triangles, texel);
  vec3 e1 = texelFetch(triangles, texel + 1).xyz - t0.xyz;
  vec3 e2 = texelFetch(triangles, texel + 2).xyz - t0.xyz;
  Placed t;
  place(volume, t0.xyz, t0.xyz + e1, t0.xyz + e2, t);
  ivec3 at = axis_last(voxel, t.axis);

  // One of the lines by the length that the triangle has on it, and evenly along it.
  vec2 corners[5];
  cut_to_layer(t, at, corners);
  vec2 lines = lines_of(corners), chosen = vec2(0.5);
  uint seed = hash(voxel_seed(primitive, voxel, of_volume) + 1u);
  float sum = 0.0, shift = unit_float(hash(seed + 1u)), along = unit_float(hash(seed + 2u));
  for (int i = 0; i < LINES; ++i) {
    float y = mix(lines.x, lines.y, (float(i) + shift) / float(LINES));
    vec2 ends = clamp(ends_on_line(corners, y), 0.0, 1.0);
    // A point counts, too, where rounding leaves no more of the triangle.
    float part = max(ends.y - ends.x, 0.0) + 1.0e-20;
    sum += part;
    seed = hash(seed);
    if (unit_float(seed) * sum < part) chosen = vec2(mix(ends.x, ends.y, along), y);
  }

  // Its barycentric coordinates, as seen along the axis.
  float size = voxel_size(volume);
  vec3 base = axis_last((t0.xyz - volume.low.xyz) / size, t.axis) - vec3(at);
  vec2 offset = chosen - base.xy, a = axis_last(e1, t.axis).xy / size, b = axis_last(e2, t.axis).xy / size;
  float determinant = a.x * b.y - a.y * b.x;
  float inverse = determinant != 0.0 ? 1.0 / determinant : 0.0;
  float u = clamp((offset.x * b.y - offset.y * b.x) * inverse, 0.0, 1.0);
  float v = clamp((a.x * offset.y - a.y * offset.x) * inverse, 0.0, 1.0 - u);
  hits[number] = TracedHit(0.0, primitive, u, v);
  vec3 low = volume.low.xyz + vec3(voxel) * size;
  vec3 position = clamp(t0.xyz + u * e1 + v * e2, low, low + size);
  float area = float(texelFetch(voxels, int(index)).x) / AREA_STEPS * size * size;
  surfels[number] = Surfel(vec4(position, area), uvec4(hash(seed + 3u), 0u, 0u, floatBitsToUint(t0.w)));
}
