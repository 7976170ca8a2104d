#include "rays/comparison.h"

#include "rays/brute_force.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace panoptes::test {

namespace {

constexpr size_t kExamples = 5;

bool met(const TracedHit& hit) { return hit.primitive != shared::NO_PRIMITIVE; }

// Indices of at most `count` of `items`, spread evenly.
std::vector<uint32_t> spread(const std::vector<uint32_t>& items, uint32_t count) {
  if (items.size() <= count) return items;
  std::vector<uint32_t> few;
  for (uint64_t i = 0; i < count; ++i) few.push_back(items[size_t(i * items.size() / count)]);
  return few;
}

std::vector<TracedHit> brute_force(TracingDevice& device, const RaySet& set,
                                   const std::vector<uint32_t>& which) {
  std::vector<TracedRay> rays;
  for (uint32_t i : which) rays.push_back(set.rays[i]);
  BruteForceTracer tracer;
  device.build(tracer);
  return device.trace(tracer, rays, {.any_hit = set.any_hit}).hits;
}

}  // namespace

bool agree(const TracedRay& ray, const TracedHit& a, const TracedHit& b, bool any_hit) {
  if (met(a) != met(b)) return false;
  if (any_hit || !met(a)) return true;
  const double length = glm::length(glm::dvec3(direction_of(ray)));
  const glm::vec3 size = glm::abs(origin_of(ray));
  const double reach = double(std::max({size.x, size.y, size.z})) + length * std::abs(double(a.t));
  return length * std::abs(double(a.t) - b.t) <= 1e-5 * reach;
}

bool identical(const TracedHit& a, const TracedHit& b, bool any_hit) {
  return any_hit ? met(a) == met(b)
                 : a.t == b.t && a.primitive == b.primitive && a.u == b.u && a.v == b.v;
}

std::string describe(const TracedRay& r, const TracedHit& hit) {
  const std::string found =
      met(hit) ? fmt::format("meets {} at t {:.9g}", hit.primitive, hit.t) : "meets nothing";
  return fmt::format("origin ({:.9g}, {:.9g}, {:.9g}), direction ({:.9g}, {:.9g}, {:.9g}), t in "
                     "({:.9g}, {:.9g}] {}",
                     r.origin_x, r.origin_y, r.origin_z, r.direction_x, r.direction_y,
                     r.direction_z, r.t_min, r.t_max, found);
}

Comparison compare_with_embree(TracingDevice& device, const Triangles& triangles, const RaySet& set,
                               const std::vector<TracedHit>& ours,
                               const std::vector<TracedHit>& embree, uint32_t judge_at_most) {
  Comparison result;
  std::vector<uint32_t> disputed;
  for (uint32_t i = 0; i < set.rays.size(); ++i)
    if (!agree(set.rays[i], ours[i], embree[i], set.any_hit)) disputed.push_back(i);
  result.rays = uint32_t(set.rays.size());
  result.mismatches = uint32_t(disputed.size());
  const std::vector<uint32_t> judged = spread(disputed, judge_at_most);
  result.judged = uint32_t(judged.size());
  if (judged.empty()) return result;

  const std::vector<TracedHit> due = brute_force(device, set, judged);
  const Oracle oracle(triangles);
  for (size_t k = 0; k < judged.size(); ++k) {
    const uint32_t i = judged[k];
    const bool lost =
        met(ours[i]) != met(due[k]) || (!identical(ours[i], due[k], set.any_hit) &&
                                        !oracle.allows(set.rays[i], ours[i], set.any_hit));
    Difference difference = Difference::kFirst;
    if (lost) {
      ++result.structural;
    } else {
      difference = oracle.explain(set.rays[i], ours[i], embree[i], set.any_hit);
      ++result.differences[size_t(difference)];
    }
    const bool wrong = difference == Difference::kFirst || difference == Difference::kBoth;
    if (wrong && result.examples.size() < kExamples)
      result.examples.push_back(
          fmt::format("{} {}: {}; brute force {}, Embree {}", set.name,
                      lost ? "structural" : "wrong", describe(set.rays[i], ours[i]),
                      met(due[k]) ? fmt::format("{} at {:.9g}", due[k].primitive, due[k].t)
                                  : "nothing",
                      met(embree[i]) ? fmt::format("{} at {:.9g}", embree[i].primitive, embree[i].t)
                                     : "nothing"));
  }
  return result;
}

size_t count_unlike(const std::vector<TracedHit>& a, const std::vector<TracedHit>& b,
                    bool any_hit) {
  size_t unlike = 0;
  for (size_t i = 0; i < a.size(); ++i) unlike += !identical(a[i], b[i], any_hit);
  return unlike;
}

}  // namespace panoptes::test
