// Which views ambient occlusion chooses by what they tell about probes. No GL.
#include "ambient_occlusion/choice.h"
#include "support.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>

namespace panoptes::test {
namespace {

using ambient_occlusion::Estimate;
using Estimates = std::vector<Estimate>;
using ambient_occlusion::choose_views;
using ambient_occlusion::coverage;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Estimates random_estimates(int probes, int views, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform;
  Estimates all;
  for (int i = 0; i < probes * views; ++i) {
    const float weight = uniform(random);
    all.push_back({uniform(random), weight < 0.3f ? 0.0f : weight});
  }
  return all;
}

// (4.1) of one probe, written down again.
double occlusion_of(const Estimates& all, int views, int probe, const std::vector<int>& chosen) {
  const Estimate* e = &all[size_t(probe * views)];
  double sum = double(e[0].occlusion) * e[0].weight, weights = e[0].weight;
  for (int v : chosen) {
    sum += double(e[v].occlusion) * e[v].weight;
    weights += e[v].weight;
  }
  return weights > 0 ? sum / weights : e[0].occlusion;
}

double contribution(const Estimates& all, int views, std::vector<int> chosen, int added) {
  const int probes = int(all.size()) / views;
  double sum = 0;
  for (int p = 0; p < probes; ++p) {
    const double without = occlusion_of(all, views, p, chosen);
    chosen.push_back(added);
    sum += std::abs(occlusion_of(all, views, p, chosen) - without);
    chosen.pop_back();
  }
  return sum / probes;
}

TEST(OcclusionChoice, EachViewIsTheOneThatAddsTheMost) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const int views = 7, probes = 60;
    const Estimates all = random_estimates(probes, views, seed);
    const std::vector<int> chosen = choose_views(all, views, 4, 0);
    ASSERT_EQ(chosen.size(), 4u);
    for (size_t n = 0; n < chosen.size(); ++n) {
      const std::vector<int> before(chosen.begin(), chosen.begin() + int(n));
      const double taken = contribution(all, views, before, chosen[n]);
      for (int v = 1; v < views; ++v) {
        if (std::find(before.begin(), before.end(), v) != before.end()) continue;
        EXPECT_LE(contribution(all, views, before, v), taken + 1e-12) << seed << " " << v;
      }
    }
  }
}

TEST(OcclusionChoice, DoesNotDependOnTheOrderOfProbesOrViews) {
  const int views = 6, probes = 50;
  const Estimates all = random_estimates(probes, views, 3);
  const std::vector<int> chosen = choose_views(all, views, 3, 0);
  std::mt19937 random(8);
  std::vector<int> probe_order(probes), view_order(views);
  std::iota(probe_order.begin(), probe_order.end(), 0);
  std::iota(view_order.begin(), view_order.end(), 0);
  for (int turn = 0; turn < 10; ++turn) {
    std::shuffle(probe_order.begin(), probe_order.end(), random);
    std::shuffle(view_order.begin() + 1, view_order.end(), random);
    Estimates mixed;
    for (int p : probe_order)
      for (int v : view_order) mixed.push_back(all[size_t(p * views + v)]);
    std::vector<int> again;
    for (int v : choose_views(mixed, views, 3, 0)) again.push_back(view_order[size_t(v)]);
    EXPECT_EQ(again, chosen);
    std::vector<int> places;
    for (int v : chosen)
      places.push_back(
          int(std::find(view_order.begin(), view_order.end(), v) - view_order.begin()));
    EXPECT_EQ(coverage(mixed, views, places), coverage(all, views, chosen));
  }
}

TEST(OcclusionChoice, ViewsThatRevealNothingAreLeftOut) {
  // The camera; a view that agrees with it; one without weight; one that changes it by a quarter,
  // after which the one that agreed would change it by an eighth.
  Estimates all;
  for (int p = 0; p < 8; ++p)
    all.insert(all.end(), {{0.5f, 0.5f}, {0.5f, 1.0f}, {1.0f, 0.0f}, {1.0f, 0.5f}});
  const std::vector<int> none, last{3}, both{3, 1};
  EXPECT_EQ(choose_views(all, 4, 3, 0.26f), none);
  EXPECT_EQ(choose_views(all, 4, 3, 0.25f), last);
  EXPECT_EQ(choose_views(all, 4, 3, 0.13f), last);
  EXPECT_EQ(choose_views(all, 4, 3, 0.12f), both);
  EXPECT_EQ(choose_views(all, 4, 3, 0), both) << "the third has no weight anywhere";
  EXPECT_EQ(choose_views(all, 4, 1, 0), last);
  EXPECT_EQ(choose_views(all, 4, 0, 0), none);
}

TEST(OcclusionChoice, OfEqualsTheFirstIsTaken) {
  Estimates all;
  for (int p = 0; p < 5; ++p)
    all.insert(all.end(), {{0.2f, 0.5f}, {0.3f, 0.5f}, {0.9f, 0.5f}, {0.9f, 0.5f}});
  EXPECT_EQ(choose_views(all, 4, 1, 0), std::vector<int>{2});
}

TEST(OcclusionChoice, WhereTheCameraHasNoWeightItsEstimateStandsUntilAnotherHasSome) {
  const Estimates all{{0.25f, 0}, {0.75f, 0.125f}, {0.875f, 0}};
  EXPECT_EQ(choose_views(all, 3, 2, 0.49f), std::vector<int>{1});
  EXPECT_EQ(choose_views(all, 3, 2, 0.51f), std::vector<int>{});
}

TEST(OcclusionChoice, NumbersThatAreNotFiniteSayNothing) {
  const int views = 4, probes = 40;
  Estimates sane = random_estimates(probes, views, 12);
  for (int p = 0; p < probes; ++p) sane[size_t(p * views + 2)].weight = 0;
  const std::vector<int> chosen = choose_views(sane, views, 3, 0);
  EXPECT_EQ(chosen.size(), 2u);
  const float share = coverage(sane, views, {1, 2});
  for (const Estimate& broken : {Estimate{kNan, 1}, Estimate{1, kNan}, Estimate{kInfinity, 1},
                                 Estimate{1, kInfinity}, Estimate{1, -1}}) {
    Estimates all = sane;
    for (int p = 0; p < probes; ++p) all[size_t(p * views + 2)] = broken;
    EXPECT_EQ(choose_views(all, views, 3, 0), chosen);
    EXPECT_EQ(coverage(all, views, {1, 2}), share);
  }
  // Probes that the camera knows nothing about are not there.
  Estimates more = sane;
  for (int i = 0; i < 100; ++i) more.insert(more.end(), {{kNan, 1}, {0, 1}, {0, 1}, {1, 1}});
  EXPECT_EQ(choose_views(more, views, 3, 0), chosen);
  EXPECT_EQ(coverage(more, views, {1, 2}), share);
}

TEST(OcclusionChoice, NothingToChooseFromIsNoError) {
  EXPECT_TRUE(choose_views({}, 5, 3, 0).empty());
  EXPECT_TRUE(choose_views({}, 0, 3, 0).empty());
  EXPECT_TRUE(choose_views(Estimates{{0.5f, 1}, {0.25f, 1}}, 1, 3, 0).empty());
  EXPECT_EQ(coverage({}, 5, {}), 1);
}

TEST(OcclusionChoice, CoverageIsTheShareOfProbesThatAnotherViewSeesAsWell) {
  // Four probes; the first view sees one of them, the second sees that and another one.
  const Estimates all{{0, 0.5f}, {0, 0.5f},  {0, 0.5f},  {0, 0.25f}, {0, 0},     {0, 0.2f},
                      {0, 1},    {0, 0.25f}, {0, 0.25f}, {0, 0.8f},  {0, 0.01f}, {0, 0.25f}};
  EXPECT_EQ(coverage(all, 3, {}), 0) << "the camera alone covers nothing that it hides";
  EXPECT_EQ(coverage(all, 3, {1}), 0.25f);
  EXPECT_EQ(coverage(all, 3, {2}), 0.5f);
  EXPECT_EQ(coverage(all, 3, {1, 2}), 0.5f);
}

}  // namespace
}  // namespace panoptes::test
