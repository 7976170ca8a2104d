// The catalogue of hard cases for whatever meets geometry along rays: scenes and rays as data.
//
// A row is one entry of hard_cases(): its geometry, its rays and what they must meet. Test programs
// are the columns: each runs every row through a technique and judges by `due`, and by the oracle
// (rays/oracle.h) where a row leaves rays open. test_ray_hard_cases.cpp is the column of all ray
// tracers.
#pragma once

#include "rays/ray_sets.h"

#include <vector>

namespace panoptes::test {

// Entries of HardCase::due beside primitives and NO_PRIMITIVE.
constexpr uint32_t kSomething = 0xfffffffeu;  // whatever, but not nothing
constexpr uint32_t kOpen = 0xfffffffdu;       // the oracle decides

struct HardCase {
  Triangles triangles;
  std::vector<TracedRay> rays;
  std::vector<uint32_t> due;  // for each ray; empty: all open

  void add(const TracedRay& ray, uint32_t what = kOpen) {
    rays.push_back(ray);
    due.push_back(what);
  }
};

// A row: made when it runs.
struct HardCaseMaker {
  const char* name;  // letters and digits only
  HardCase (*make)();
};
const std::vector<HardCaseMaker>& hard_cases();

// The rows by subject, for hard_cases() alone.
std::vector<HardCaseMaker> hard_scales();     // sizes and places
std::vector<HardCaseMaker> hard_triangles();  // broken, degenerate and crowded geometry
std::vector<HardCaseMaker> hard_rays();       // limits, directions, masks

// `count` rays between points of the box that is `margin` times the bounds' size larger on each
// side, and as many of each set of aimed_rays().
void add_rays_of_all_kinds(HardCase& to, uint32_t count, float margin = 0.2f);

}  // namespace panoptes::test
