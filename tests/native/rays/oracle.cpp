#include "rays/oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace panoptes::test {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kUnit = 0x1p-24;  // of rounding, relative

// Roundings that one coordinate goes through: the difference to the origin, the shear and its
// product, the sum; twice as many, since other formulas than ours (Embree's) round elsewhere.
constexpr double kRoundings = 16;

double largest(const glm::dvec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

}  // namespace

Meeting meet(const TracedRay& ray, uint32_t primitive, const TracedTriangle& triangle) {
  Meeting m;
  if ((triangle.flags & ray.seen_by & shared::TRIANGLE_SEEN_BY) == 0) return m;
  const glm::dvec3 origin(ray.origin_x, ray.origin_y, ray.origin_z);
  const glm::dvec3 d(ray.direction_x, ray.direction_y, ray.direction_z);
  const double length = glm::length(d);
  // A frame with the ray along its third axis, at the origin.
  const glm::dvec3 axis = d / length;
  const glm::dvec3 other = std::abs(axis.x) > 0.5 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(axis, other)), y = glm::cross(axis, x);
  const glm::dvec3 sizes = glm::abs(d);
  const int major = sizes.z >= sizes.x && sizes.z >= sizes.y ? 2 : sizes.y >= sizes.x ? 1 : 0;
  glm::dvec3 p[3];
  double reach = 0, nearest = kInfinity, farthest = -kInfinity;
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 offset = glm::dvec3(corner(triangle, k)) - origin;
    p[k] = {glm::dot(offset, x), glm::dot(offset, y), glm::dot(offset, axis)};
    reach = std::max(reach, largest(offset));
    // Along the ray, and where watertight tests see the vertex: along the axis nearest to it.
    const double along = offset[major] / axis[major];
    nearest = std::min({nearest, p[k].z, along});
    farthest = std::max({farthest, p[k].z, along});
  }
  if (!(reach < kInfinity)) return m;  // a vertex that is not finite

  // Twice the areas that the ray makes with each edge, and by how much they may be off: each vertex
  // may lie `moved` away from where it is, across the ray.
  const double moved = kRoundings * kUnit * reach;
  const auto cross = [](const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.y - a.y * b.x; };
  double area[3], error[3];
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 &a = p[(k + 1) % 3], &b = p[(k + 2) % 3];
    area[k] = cross(a, b);
    const double size = glm::length(glm::dvec2(a)) + glm::length(glm::dvec2(b));
    error[k] = moved * (size + moved) + 4 * kUnit * (std::abs(a.x * b.y) + std::abs(a.y * b.x));
  }
  const bool front = area[0] >= -error[0] && area[1] >= -error[1] && area[2] >= -error[2];
  const bool back = area[0] <= error[0] && area[1] <= error[1] && area[2] <= error[2];
  if (!front && !back) return m;
  const bool inside = (area[0] > error[0] && area[1] > error[1] && area[2] > error[2]) ||
                      (area[0] < -error[0] && area[1] < -error[1] && area[2] < -error[2]);
  m.near_edge = !inside;

  const double whole = area[0] + area[1] + area[2];
  const double whole_error = error[0] + error[1] + error[2];
  if (std::abs(whole) > 2 * whole_error) {
    const double depth = (area[0] * p[0].z + area[1] * p[1].z + area[2] * p[2].z) / whole;
    double off = 0;
    for (int k = 0; k < 3; ++k) off += error[k] * std::abs(p[k].z - depth);
    // Formulas that take the plane from the edges' cross product round it by the edges' size.
    const glm::dvec3 ab = p[1] - p[0], ac = p[2] - p[0];
    const double plane = kRoundings * kUnit * glm::length(ab) * glm::length(ac) * reach;
    m.t = depth / length;
    m.t_error =
        (2 * (off + plane) / std::abs(whole) + kRoundings * kUnit * std::abs(depth)) / length;
  } else {
    // Seen so nearly edge-on that t may be anywhere along the triangle.
    m.t = 0.5 * (nearest + farthest) / length;
    m.t_error = (0.5 * (farthest - nearest) + kRoundings * kUnit * reach) / length;
  }

  const bool starts_here = ray.after != shared::NO_PRIMITIVE && primitive > ray.after;
  const double t_min = ray.t_min, t_max = ray.t_max;
  const bool surely_after =
      m.t - m.t_error > t_min || (m.t_error == 0 && m.t == t_min && starts_here);
  const bool surely_before = m.t + m.t_error <= t_max;
  if (m.t + m.t_error < t_min || m.t - m.t_error > t_max) return m;
  m.near_start = !surely_after;
  m.near_end = !surely_before;
  m.certainty = inside && surely_after && surely_before ? Meeting::kCertainly : Meeting::kPerhaps;
  return m;
}

const char* name_of(Difference difference) {
  constexpr const char* kNames[kDifferenceCount] = {"edge",  "depth",     "start",  "end",
                                                    "wrong", "reference", "neither"};
  return kNames[int(difference)];
}

Oracle::Found Oracle::find(const TracedRay& ray) const {
  Found found{kInfinity, std::vector<Meeting>(triangles_.size())};
  for (size_t i = 0; i < triangles_.size(); ++i) {
    const Meeting m = found.possible[i] = meet(ray, uint32_t(i), triangles_[i]);
    if (m.certainty == Meeting::kCertainly)
      found.certain_by = std::min(found.certain_by, m.t + m.t_error);
  }
  return found;
}

bool Oracle::allows(const TracedRay& ray, const Found& found, const TracedHit& hit,
                    bool any_hit) const {
  if (hit.primitive == shared::NO_PRIMITIVE) return found.certain_by == kInfinity;
  if (any_hit)
    return std::any_of(found.possible.begin(), found.possible.end(),
                       [](const Meeting& m) { return m.certainty != Meeting::kNever; });
  if (hit.primitive >= found.possible.size()) return false;
  const Meeting& m = found.possible[hit.primitive];
  return m.certainty != Meeting::kNever && m.t - m.t_error <= found.certain_by &&
         std::abs(hit.t - m.t) <= m.t_error + kUnit * std::abs(m.t) && hit.t >= ray.t_min &&
         hit.t <= ray.t_max;
}

bool Oracle::allows(const TracedRay& ray, const TracedHit& hit, bool any_hit) const {
  return allows(ray, find(ray), hit, any_hit);
}

Difference Oracle::explain(const TracedRay& ray, const TracedHit& first, const TracedHit& second,
                           bool any_hit) const {
  const Found found = find(ray);
  const bool first_right = allows(ray, found, first, any_hit);
  const bool second_right = allows(ray, found, second, any_hit);
  if (!first_right) return second_right ? Difference::kFirst : Difference::kBoth;
  if (!second_right) return Difference::kSecond;
  // Both are excused: by what is uncertain about the triangles before the first certain one.
  bool start = false, end = false, edge = false;
  for (const Meeting& m : found.possible) {
    if (m.certainty != Meeting::kPerhaps || m.t - m.t_error > found.certain_by) continue;
    start |= m.near_start;
    end |= m.near_end;
    edge |= m.near_edge;
  }
  return start  ? Difference::kStart
         : end  ? Difference::kEnd
         : edge ? Difference::kEdge
                : Difference::kDepth;
}

}  // namespace panoptes::test
