// What a ray may be said to meet, given that coordinates are float32 and arithmetic rounds: exact
// geometry in double precision, with bounds for the error of a float32 test on top.
//
// A double has 29 bits more than the coordinates: its own rounding vanishes beside the bounds.
#pragma once

#include "rays/triangles.h"

#include <string>
#include <vector>

namespace panoptes::test {

using shared::TracedHit;
using shared::TracedRay;

// One ray with one triangle.
struct Meeting {
  enum Certainty { kNever, kPerhaps, kCertainly } certainty = kNever;
  double t = 0,
         t_error =
             0;  // where the ray meets the triangle's plane, and how far off a float32 test may be
  bool near_edge = false;   // rounding decides whether the ray passes inside
  bool near_start = false;  // rounding decides whether it lies behind t_min
  bool near_end = false;    // rounding decides whether it lies before t_max
};
Meeting meet(const TracedRay& ray, uint32_t primitive, const TracedTriangle& triangle);

// Why two tracers may differ about a ray.
enum class Difference {
  kEdge,    // rounding decides whether the ray passes an edge
  kDepth,   // two surfaces, or two formulas for one, nearer together than the rounding of t
  kStart,   // a surface at the ray's own start
  kEnd,     // a surface at t_max
  kFirst,   // the first answer is wrong beyond rounding
  kSecond,  // the second is
  kBoth,    // both are
};
constexpr int kDifferenceCount = 7;
const char* name_of(Difference difference);

class Oracle {
 public:
  explicit Oracle(const Triangles& triangles) : triangles_(triangles) {}

  // Whether rounding excuses `hit` as what is closest on `ray`: nothing certain lies before it, and
  // it lies where the triangle is. With any_hit: whether something is met at all.
  bool allows(const TracedRay& ray, const TracedHit& hit, bool any_hit = false) const;
  // Explains two answers that differ.
  Difference explain(const TracedRay& ray, const TracedHit& first, const TracedHit& second,
                     bool any_hit = false) const;

 private:
  struct Found {
    double certain_by;              // no answer beyond this t is right
    std::vector<Meeting> possible;  // by triangle
  };
  Found find(const TracedRay& ray) const;
  bool allows(const TracedRay& ray, const Found& found, const TracedHit& hit, bool any_hit) const;

  const Triangles& triangles_;
};

}  // namespace panoptes::test
