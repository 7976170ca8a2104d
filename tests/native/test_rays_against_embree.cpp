// Every ray tracer against Embree, on generated scenes and all sets of rays.
#include "rays/comparison.h"
#include "rays/shared_device.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace panoptes::test {
namespace {

constexpr uint32_t kRays = 20'000;  // a set
constexpr uint32_t kJudged = 60;    // differences of a set that are looked into

std::string describe(const Comparison& c) {
  std::string words = fmt::format("{} of {} rays differ; of {} judged {} are structural",
                                  c.mismatches, c.rays, c.judged, c.structural);
  for (int d = 0; d < kDifferenceCount; ++d)
    words += fmt::format(", {} {}", c.differences[size_t(d)], name_of(Difference(d)));
  for (const std::string& example : c.examples) words += "\n  " + example;
  return words;
}

class RaysAgainstEmbree : public ::testing::TestWithParam<std::string> {};

// Rays of a set that is not aimed at edges, but come within rounding of one by chance. The blades
// of grass have 16 km of edges over some 20 m2 of picture: float32 makes each 1e-6 m wide, .08 % in
// all.
uint32_t near_edges(const std::string& scene) { return scene == "grass" ? 8 * kRays / 10'000 : 1; }

// All tracers find the same bits of rays that chance aims, and no difference from Embree is without
// an excuse by rounding.
TEST_P(RaysAgainstEmbree, DifferOnlyByRounding) {
  const RayScene scene = generated_scene(GetParam());
  const EmbreeScene embree(scene.triangles);
  const std::vector<RaySet> sets = all_rays(scene, embree, kRays);
  TracingDevice& device = tracing_device();
  device.assign(scene.triangles);
  std::vector<std::vector<TracedHit>> first;  // of the first tracer that is fast enough, by set
  for (const TracerEntry& entry : tracers()) {
    if (entry.slow && scene.triangles.size() > 1000) continue;
    const auto tracer = entry.make(device.device());
    device.build(*tracer);
    for (size_t s = 0; s < sets.size(); ++s) {
      const RaySet& set = sets[s];
      SCOPED_TRACE(entry.name + ", " + set.name);
      ASSERT_EQ(set.rays.size(), kRays);
      const std::vector<TracedHit> ours =
          device.trace(*tracer, set.rays, {.any_hit = set.any_hit}).hits;
      const std::vector<TracedHit> theirs = embree.trace(set.rays, set.any_hit);
      const Comparison c = compare_with_embree(device, scene.triangles, set, ours, theirs, kJudged);
      if (first.size() == s) first.push_back(ours);
      EXPECT_TRUE(set.aimed || count_unlike(ours, first[s], set.any_hit) == 0);
      EXPECT_EQ(c.structural, 0u) << describe(c);
      EXPECT_EQ(c.of(Difference::kFirst), 0u) << describe(c);
      EXPECT_EQ(c.of(Difference::kBoth), 0u) << describe(c);
      EXPECT_TRUE(set.aimed || c.mismatches <= near_edges(scene.name)) << describe(c);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, RaysAgainstEmbree, ::testing::ValuesIn(generated_scene_names()),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::erase(name, '_');
                           return name;
                         });

// The sets are what they say: rays that start at surfaces meet none at their own start.
TEST(RaySets, StartOffTheirSurfaces) {
  for (const std::string name : {"atrium", "blob", "grass"}) {
    const RayScene scene = generated_scene(name);
    const EmbreeScene embree(scene.triangles);
    for (const RaySet& set : secondary_rays(scene, embree, 10'000)) {
      SCOPED_TRACE(name + ", " + set.name);
      const std::vector<TracedHit> hits = embree.trace(set.rays);
      size_t at_start = 0;
      for (size_t i = 0; i < hits.size(); ++i) {
        const float way = hits[i].t * glm::length(direction_of(set.rays[i]));
        at_start += hits[i].primitive != shared::NO_PRIMITIVE && way < 1e-6f;
      }
      EXPECT_EQ(at_start, 0u);
    }
  }
}

// The oracle and the comparison see what they are there for.
TEST(RayOracle, TellsRoundingFromMistakes) {
  Triangles t{make_triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0}),
              make_triangle({-1, -1, -1}, {1, -1, -1}, {0, 1, -1})};
  const Oracle oracle(t);
  const TracedHit nothing{kFarAway, shared::NO_PRIMITIVE, 0, 0}, first{2, 0, 0, 0},
      second{3, 1, 0, 0};
  const TracedRay inside = make_ray({0, 0, 2}, {0, 0, -1});
  EXPECT_TRUE(oracle.allows(inside, first));
  EXPECT_FALSE(oracle.allows(inside, second));
  EXPECT_FALSE(oracle.allows(inside, nothing));
  EXPECT_FALSE(oracle.allows(inside, {2.001f, 0, 0, 0}));
  EXPECT_EQ(oracle.explain(inside, nothing, first), Difference::kFirst);
  EXPECT_EQ(oracle.explain(inside, first, second), Difference::kSecond);
  EXPECT_EQ(oracle.explain(inside, second, nothing), Difference::kBoth);

  const TracedRay edge = make_ray({0, -1, 2}, {0, 0, -1});
  for (const TracedHit& hit : {first, second, nothing}) EXPECT_TRUE(oracle.allows(edge, hit));
  EXPECT_EQ(oracle.explain(edge, first, nothing), Difference::kEdge);
  const TracedRay beside = make_ray({0, -1.0001f, 2}, {0, 0, -1});
  EXPECT_FALSE(oracle.allows(beside, first));

  const TracedRay start = make_ray({0, 0, 0}, {0, 0, -1});
  EXPECT_EQ(oracle.explain(start, {1, 1, 0, 0}, {0, 0, 0, 0}), Difference::kStart);
  const TracedRay end = make_ray({0, 0, 2}, {0, 0, -1}, 0, 2);
  EXPECT_EQ(oracle.explain(end, first, {2, shared::NO_PRIMITIVE, 0, 0}), Difference::kEnd);
  TracedRay blind = inside;
  blind.seen_by = 0;
  EXPECT_TRUE(oracle.allows(blind, nothing));
  EXPECT_FALSE(oracle.allows(blind, first));
}

}  // namespace
}  // namespace panoptes::test
