// What makes the geometry volume: its voxels by number, a word's 32 after another's, and triangles
// among them.
#include "radiance_cache/voxels_shared.h"
#include "tracing/triangles.glsl"

layout(location = 3) uniform int volume_index;
// Where voxel (0, 0, 0) of each volume lies on the lattice of all voxels of this size in the world, so
// that a voxel draws the same random numbers wherever its volume moves.
layout(location = 4) uniform ivec3 lattice[MOST_CASCADES];

// A number for drawing random ones for a triangle in a voxel.
uint voxel_seed(uint primitive, ivec3 voxel, int volume) {
  uvec3 place = uvec3(voxel + lattice[volume]) * uvec3(0x9e3779b1u, 0x85ebca77u, 0xc2b2ae3du);
  return hash((place.x + place.y + place.z) ^ hash(primitive));
}

// axis_last() of voxels, and back.
ivec3 axis_last(ivec3 v, int axis) { return axis == 0 ? v.yzx : axis == 1 ? v.zxy : v.xyz; }
ivec3 axis_back(ivec3 v, int axis) { return axis == 0 ? v.zxy : axis == 1 ? v.yzx : v.xyz; }

// A triangle in a volume. Coordinates count voxels, and the axis to which its normal is closest is the
// last: over the other two, a column of voxels meets it in at most a few.
struct Placed {
  int axis;
  vec3 p0, p1, p2;    // in the order of their last coordinates
  vec2 slope;         // of the last coordinate over the other two, -1 .. 1
  float area;         // of it all, in faces of a voxel
  float steepness;    // area of a part over the part's area as seen along the axis
  ivec3 low, high;    // first and last voxels that its box touches
  bool single;        // lies in one voxel
};

void order_by_last(inout vec3 a, inout vec3 b) {
  if (a.z > b.z) {
    vec3 c = a;
    a = b;
    b = c;
  }
}

// False where the triangle's box lies outside or it has no area.
bool place(CacheVolume volume, vec3 p0, vec3 p1, vec3 p2, out Placed t) {
  float scale = 1.0 / voxel_size(volume);
  vec3 e1 = (p1 - p0) * scale, e2 = (p2 - p0) * scale;
  // Both large and tiny triangles have products that floats hold.
  float size = max(max(max(abs(e1.x), abs(e1.y)), abs(e1.z)), max(max(abs(e2.x), abs(e2.y)), abs(e2.z)));
  vec3 across = cross(e1 / max(size, 1.0e-30), e2 / max(size, 1.0e-30));
  float doubled = length(across);
  t.area = 0.5 * doubled * size * size;
  vec3 n = across / max(doubled, 1.0e-30), a = abs(n);
  t.axis = a.x > a.y && a.x > a.z ? 0 : a.y > a.z ? 1 : 2;
  n = axis_last(n, t.axis);
  t.slope = clamp(-n.xy / (abs(n.z) > 0.0 ? n.z : 1.0), -1.0, 1.0);
  t.steepness = 1.0 / max(abs(n.z), 0.5);

  vec3 at = (p0 - volume.low.xyz) * scale;
  t.p0 = axis_last(at, t.axis);
  t.p1 = axis_last(at + e1, t.axis);
  t.p2 = axis_last(at + e2, t.axis);
  order_by_last(t.p0, t.p1);
  order_by_last(t.p1, t.p2);
  order_by_last(t.p0, t.p1);
  vec3 low = min(t.p0, min(t.p1, t.p2)), high = max(t.p0, max(t.p1, t.p2));
  vec3 counts = vec3(axis_last(voxel_counts(volume), t.axis));
  t.low = ivec3(floor(clamp(low, vec3(0.0), counts - 1.0)));
  t.high = ivec3(floor(clamp(high, vec3(0.0), counts - 1.0)));
  t.single = t.low == t.high && all(greaterThanEqual(low, vec3(0.0))) && all(lessThan(high, counts));
  return t.area > 0.0 && all(lessThan(low, counts)) && all(greaterThanEqual(high, vec3(0.0)));
}

// First and last voxel along the axis that the triangle's plane meets in a column.
ivec2 depths_of(Placed t, ivec2 column) {
  vec2 to = vec2(column) + 0.5 - t.p1.xy;
  float middle = t.p1.z + dot(t.slope, to);
  // Half of what the plane rises by in the column, and what rounding may put it off by.
  float reach = 0.5 * (abs(t.slope.x) + abs(t.slope.y)) + 1.0e-3 +
                min(1.0e-6 * (abs(to.x) + abs(to.y) + abs(t.p1.z)), 1.0);
  vec2 range = clamp(vec2(middle - reach, middle + reach), vec2(float(t.low.z) - 0.5),
                     vec2(float(t.high.z) + 0.5));
  return clamp(ivec2(floor(range)), ivec2(t.low.z), ivec2(t.high.z));
}

// The integral of clamp(x, 0, 1) over y in 0 .. 1 along a line from p to q: what the line adds to the
// area within the unit square of a polygon that it is an edge of.
float area_beside(vec2 p, vec2 q) {
  float from = clamp(p.y, 0.0, 1.0), to = clamp(q.y, 0.0, 1.0), rise = q.y - p.y;
  float slope = rise != 0.0 ? (q.x - p.x) / rise : 0.0;
  float a = p.x + (from - p.y) * slope, b = p.x + (to - p.y) * slope;
  float inner_a = clamp(a, 0.0, 1.0), inner_b = clamp(b, 0.0, 1.0), run = b - a;
  float mean = abs(run) > 1.0e-3
                   ? (inner_b * (b - 0.5 * inner_b) - inner_a * (a - 0.5 * inner_a)) / run
                   : clamp(0.5 * (a + b), 0.0, 1.0);
  return (to - from) * mean;
}

// How far `z` lies from a to b, 0 .. 1.
float share_of(float z, float a, float b) { return clamp((z - a) / max(b - a, 1.0e-20), 0.0, 1.0); }

// The triangle between the two planes across the axis that bound a voxel: a polygon of five corners,
// relative to the voxel's lowest one, as seen along the axis. Some fall together.
void cut_to_layer(Placed t, ivec3 voxel, out vec2 corners[5]) {
  vec3 a = t.p0 - vec3(voxel), b = t.p1 - vec3(voxel), c = t.p2 - vec3(voxel);
  vec2 bent0 = b.z > 0.0 ? mix(a.xy, b.xy, share_of(0.0, a.z, b.z))
                         : mix(b.xy, c.xy, share_of(0.0, b.z, c.z));
  vec2 bent1 = b.z > 1.0 ? mix(a.xy, b.xy, share_of(1.0, a.z, b.z))
                         : mix(b.xy, c.xy, share_of(1.0, b.z, c.z));
  corners[0] = mix(a.xy, c.xy, share_of(0.0, a.z, c.z));
  corners[1] = mix(a.xy, c.xy, share_of(1.0, a.z, c.z));
  corners[2] = bent1;
  corners[3] = b.z < 0.0 ? bent0 : b.z > 1.0 ? bent1 : b.xy;
  corners[4] = bent0;
}

// Area of the triangle within a voxel, in faces of a voxel.
float area_within(Placed t, ivec3 voxel) {
  vec2 corners[5];
  cut_to_layer(t, voxel, corners);
  float sum = 0.0;
  for (int i = 0; i < 5; ++i) sum += area_beside(corners[i], corners[(i + 1) % 5]);
  return abs(sum) * t.steepness;
}
