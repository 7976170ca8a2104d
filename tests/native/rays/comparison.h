// Compares what two tracers found, and says of each difference where it comes from.
#pragma once

#include "rays/oracle.h"
#include "rays/ray_sets.h"
#include "rays/tracing_device.h"

#include <array>
#include <string>
#include <vector>

namespace panoptes::test {

struct Comparison {
  uint32_t rays = 0;
  uint32_t mismatches = 0;
  uint32_t judged = 0;  // of the mismatches, those that the rest is about
  // Lost or made up: the same test of all triangles finds something else, and rounding is no
  // excuse. It may be one for two hits: the t of a needle that is seen edge-on is anywhere along
  // it, so that structures pass it in different orders.
  uint32_t structural = 0;
  std::array<uint32_t, kDifferenceCount> differences{};  // of those that are not structural
  std::vector<std::string> examples;  // of structural and wrong ones, to reproduce them

  uint32_t of(Difference d) const { return differences[size_t(d)]; }
};

// Whether two answers name one point, but for rounding: both or none met, t equal within 1e-5 of
// the coordinates' size. With any_hit: both or none met.
bool agree(const TracedRay& ray, const TracedHit& a, const TracedHit& b, bool any_hit);
// Whether two answers are the same, bit by bit; with any_hit: both or none met.
bool identical(const TracedHit& a, const TracedHit& b, bool any_hit);

// Compares a tracer's hits with Embree's. At most `judge_at_most` of the differences are judged,
// spread evenly: each costs a test of all triangles, once on the device and once in the oracle.
// `triangles` must be what `device` holds.
Comparison compare_with_embree(TracingDevice& device, const Triangles& triangles, const RaySet& set,
                               const std::vector<TracedHit>& ours,
                               const std::vector<TracedHit>& embree, uint32_t judge_at_most);

// Answers that are not the same bits: none, where both tracers share intersect() and lose nothing.
size_t count_unlike(const std::vector<TracedHit>& a, const std::vector<TracedHit>& b, bool any_hit);

// A ray and an answer in words, with all bits of their numbers.
std::string describe(const TracedRay& ray, const TracedHit& hit);

}  // namespace panoptes::test
