// Rays, and the watertight test of a ray with a triangle (Woop, Benthin and Wald 2013).
//
// The ray is sheared onto the axis of its largest component; there each edge function is the
// difference of two products of coordinates that neighbours share bit by bit. Rounding is monotonic,
// so the difference has the right sign or is zero, and zero counts as inside: no ray slips between
// triangles that share vertices. That needs each product rounded by itself: `precise`.
// Beside a triangle smaller than the rounding of its distance from the ray all differences may come
// out as zero, so the ray must lie within the triangle's bounds there too.
//
// SURFACES says which triangles are there at all: 0 all, 1 the opaque ones, 2 those with an alpha.
#include "tracing/triangles.glsl"

struct Ray {
  vec3 origin;
  float t_min;
  vec3 direction;
  float t_max;
  uint after, seen_by, seed;
  // Derived: the axis of the largest component of the direction, and the shear along it.
  int axis;
  vec3 shear;
};

#if COUNT_WORK
TracedWork work = TracedWork(0u, 0u, 0u, 0u);
#define COUNT_STEP ++work.steps;
#define COUNT_TEST ++work.tests;
// A list of `length` triangles in `cell` is about to be tested.
#define COUNT_LIST(cell_, length_) \
  work.longest = max(work.longest, length_); \
  work.cell = cell_;
#else
#define COUNT_STEP
#define COUNT_TEST
#define COUNT_LIST(cell_, length_)
#endif

Ray make_ray(vec3 origin, float t_min, vec3 direction, float t_max, uint after, uint seen_by,
             uint seed) {
  Ray ray;
  ray.origin = origin;
  ray.t_min = t_min;
  ray.direction = direction;
  ray.t_max = t_max;
  ray.after = after;
  ray.seen_by = seen_by;
  ray.seed = seed;
  vec3 size = abs(direction);
  ray.axis = size.z >= size.x && size.z >= size.y ? 2 : size.y >= size.x ? 1 : 0;
  vec3 d = axis_last(direction, ray.axis);
  ray.shear = vec3(d.xy, 1.0) / d.z;
  return ray;
}

// Whether 0 lies between the least and the greatest of three. By comparisons: minima and maxima that
// mind NaN take three instructions each, and these are what a test of a triangle mostly does.
bool around_zero(float a, float b, float c) {
  return (a <= 0.0 || b <= 0.0 || c <= 0.0) && (a >= 0.0 || b >= 0.0 || c >= 0.0);
}
bool same_sign(float a, float b, float c) {
  return (a >= 0.0 && b >= 0.0 && c >= 0.0) || (a <= 0.0 && b <= 0.0 && c <= 0.0);
}

// Tests primitive `primitive`, which has these corners, and keeps it in `hit` if it is closer; of
// several at the same t the one with the lowest number, so that the result does not depend on the
// order of tests.
void intersect_corners(Ray ray, uint primitive, Corners corners, inout TracedHit hit) {
  COUNT_TEST
  vec3 from_origin = corners.p0 - ray.origin;
  vec3 a = axis_last(from_origin, ray.axis);
  vec3 b = axis_last(corners.p1 - ray.origin, ray.axis);
  vec3 c = axis_last(corners.p2 - ray.origin, ray.axis);
  precise vec2 a2 = a.xy - ray.shear.xy * a.z;
  precise vec2 b2 = b.xy - ray.shear.xy * b.z;
  precise vec2 c2 = c.xy - ray.shear.xy * c.z;
  precise float u = c2.x * b2.y - c2.y * b2.x;
  precise float v = a2.x * c2.y - a2.y * c2.x;
  precise float w = b2.x * a2.y - b2.y * a2.x;
  float determinant = u + v + w;
  float inverse = 1.0 / determinant;
  // Where the ray meets the plane, which for walls and floors along the axes is exact near the origin
  // too; not beyond the corners, since the plane of a sliver is uncertain. With the same bits in every
  // program, or a ray that goes on behind a surface would meet it again.
  vec3 edge1 = corners.p1 - corners.p0, edge2 = corners.p2 - corners.p0;
  precise vec3 normal = edge1.yzx * edge2.zxy - edge1.zxy * edge2.yzx;
  vec3 along = vec3(a.z, b.z, c.z) * ray.shear.z;
  float nearest = min(along.x, min(along.y, along.z)), farthest = max(along.x, max(along.y, along.z));
  precise float facing = ray.direction.x * normal.x + ray.direction.y * normal.y +
                         ray.direction.z * normal.z;
  precise float distance = from_origin.x * normal.x + from_origin.y * normal.y +
                           from_origin.z * normal.z;
  float t = clamp(distance / facing, nearest, farthest);
  bool inside = same_sign(u, v, w);
  bool around = around_zero(a2.x, b2.x, c2.x) && around_zero(a2.y, b2.y, c2.y);
  bool ahead = t > ray.t_min || (t == ray.t_min && primitive > ray.after);
  bool closer = t < hit.t || (t == hit.t && primitive < hit.primitive);
  bool seen = (corners.flags & ray.seen_by) != 0u;
#if SURFACES == 1
  seen = seen && (corners.flags & TRIANGLE_HAS_ALPHA) == 0u;
#elif SURFACES == 2
  seen = seen && (corners.flags & TRIANGLE_HAS_ALPHA) != 0u;
#endif
  if (inside && around && determinant != 0.0 && facing != 0.0 && ahead && closer && seen)
    hit = TracedHit(t, primitive, v * inverse, w * inverse);
}

// The same with the corners that the list has.
void intersect(Ray ray, uint primitive, inout TracedHit hit) {
  intersect_corners(ray, primitive, fetch_corners(primitive), hit);
}
