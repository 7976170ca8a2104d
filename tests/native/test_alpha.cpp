// Alpha by thresholds: coverage over many samples, clean edges in one, and in shadows.
#include "support.h"

#include <cmath>

namespace panoptes::test {
namespace {

using film::Pass;

const gpu_scene::Camera kAbove = orthographic({0, 0, 5}, {0, 0, 0}, 0.9, 32, 32);

// A red card (or several, each below the last) over a green floor.
TestScene cards(const std::vector<float>& alphas) {
  TestScene s;
  s.add_object(floor_at(0, 2), {s.add_material(lambert({0, 1, 0}))});
  for (size_t i = 0; i < alphas.size(); ++i)
    s.add_object(floor_at(2 - 0.25f * float(i), 1),
                 {s.add_material(alpha_card({1, 0, 0, alphas[i]}))});
  return s;
}

engine::RenderRequest still(uint32_t samples, std::vector<Pass> passes = {Pass::kDiffCol}) {
  engine::RenderRequest r = request(kAbove, passes, samples);
  r.filter_width = 0.01f;
  return r;
}

// Largest and mean deviation of a channel from a value.
void expect_share(const Picture& p, Pass pass, int channel, double due, double each, double mean) {
  Worst worst;
  double sum = 0;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) {
      worst.compare(p.value(pass, x, y, channel) - due, 0, 1, x, y);
      sum += p.value(pass, x, y, channel);
    }
  EXPECT_WORST_BELOW(worst, each);
  EXPECT_NEAR(sum / (p.width * p.height), due, mean);
}

// Standard deviation of the mean of n yes-or-no samples.
double binomial(double share, double n) { return std::sqrt(share * (1 - share) / n); }

TEST(Alpha, ManySamplesShowTheCoverage) {
  for (float alpha : {0.1f, 0.3f, 0.5f, 0.9f}) {
    const Picture p = render(cards({alpha}), still(64));
    // Stratified thresholds: far inside the four sigmas of independent ones.
    expect_share(p, Pass::kDiffCol, 0, alpha, 4 * binomial(alpha, 64),
                 4 * binomial(alpha, 64 * 1024));
    expect_share(p, Pass::kDiffCol, 1, 1 - double(alpha), 4 * binomial(alpha, 64),
                 4 * binomial(alpha, 64 * 1024));
  }
}

TEST(Alpha, LayersBehindEachOtherMultiply) {
  // Two cards of one half: a quarter of the floor is seen, in each pixel alike.
  const Picture p = render(cards({0.5f, 0.5f}), still(256));
  expect_share(p, Pass::kDiffCol, 1, 0.25, 4.5 * binomial(0.25, 256),
               4 * binomial(0.25, 256 * 1024));
}

TEST(Alpha, OneSampleHasOneThreshold) {
  const Picture thin = render(cards({0.3f}), still(1)), thick = render(cards({0.7f}), still(1));
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      EXPECT_EQ(thin.rgb(Pass::kDiffCol, x, y), glm::dvec3(0, 1, 0));
      EXPECT_EQ(thick.rgb(Pass::kDiffCol, x, y), glm::dvec3(1, 0, 0));
    }
}

TEST(Alpha, NothingAndEverythingAreExact) {
  for (uint32_t samples : {1u, 64u}) {
    const Picture none = render(cards({0.0f}), still(samples)),
                  full = render(cards({1.0f}), still(samples));
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x) {
        EXPECT_EQ(none.rgb(Pass::kDiffCol, x, y), glm::dvec3(0, 1, 0));
        EXPECT_EQ(full.rgb(Pass::kDiffCol, x, y), glm::dvec3(1, 0, 0));
      }
  }
}

TEST(Alpha, ShadowsLetTheRestThrough) {
  // The sun stands low enough that the floor in view lies in the shadow of a card out of view.
  TestScene s;
  s.add_object(floor_at(0, 2), {s.add_material(lambert())});
  s.add_object(floor_at(1, 2), {s.add_material(alpha_card({1, 1, 1, 0.3f}))},
               glm::mat4(glm::vec4(1, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 1, 0),
                         glm::vec4(4, 0, 0, 1)));
  s.lights = {sun({-4, 0, -1}, float(kPi))};
  const double full = 1 / std::sqrt(17.0);
  const Picture p = render(s, still(256, {Pass::kDiffDir}));
  expect_share(p, Pass::kDiffDir, 0, 0.7 * full, 4.5 * binomial(0.3, 256) * full,
               4 * binomial(0.3, 256 * 1024) * full);
  // One sample: a thin card casts none, a thick one all of its shadow.
  const Picture thin = render(s, still(1, {Pass::kDiffDir}));
  s.materials[1].params[0].a = 0.7f;
  const Picture thick = render(s, still(1, {Pass::kDiffDir}));
  expect_share(thin, Pass::kDiffDir, 0, full, 1e-5, 1e-5);
  expect_share(thick, Pass::kDiffDir, 0, 0, 0, 0);
}

TEST(Alpha, ShadowsOfSeenThroughCardsStayIndependent) {
  // A card over the floor, both in view, and the card's shadow on that floor: the floor is seen
  // through the card in (1 - a) of the samples and lit in (1 - a) of them, whatever the pixel.
  TestScene s;
  s.add_object(floor_at(0, 4), {s.add_material(lambert())});
  s.add_object(floor_at(1, 4), {s.add_material(alpha_card({0, 0, 0, 0.5f}))});
  s.lights = {sun({0.3f, 0.2f, -1}, float(kPi))};
  const double full = 1 / std::sqrt(1.13);
  const Picture p = render(s, still(256, {Pass::kDiffDir}));
  Worst worst;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x)
      worst.compare(p.value(Pass::kCombined, x, y) / full, 0.25, 1, x, y);
  EXPECT_WORST_BELOW(worst, 4.5 * binomial(0.25, 256));
}

TEST(Alpha, EmissionIsScaledByIt) {
  TestScene s;
  s.add_object(floor_at(1, 1),
               {s.add_material(
                   material("void evaluate_material(const Hit hit, inout Surface surface) {\n"
                            "  Principled p = principled_defaults(hit);\n"
                            "  p.alpha = 0.5;\n"
                            "  p.emission = vec3(2.0, 4.0, 8.0);\n"
                            "  closure_principled_v3(surface, vec3(1.0), p);\n"
                            "}\n",
                            {}, {.alpha = true, .emission = true, .glossy = true}))});
  const Picture p = render(s, still(64, {Pass::kEmit, Pass::kDiffCol, Pass::kEnv}));
  expect_share(p, Pass::kEmit, 0, 1, 8 * binomial(0.5, 64), 0.02);
  expect_share(p, Pass::kEmit, 2, 4, 32 * binomial(0.5, 64), 0.08);
  expect_share(p, Pass::kDiffCol, 0, 0.4, 0.8 * 4 * binomial(0.5, 64), 0.005);
}

TEST(Alpha, IsCoverageOfATransparentFilm) {
  TestScene s;
  s.add_object(floor_at(1, 2), {s.add_material(alpha_card({1, 1, 1, 0.25f}))});
  s.world = constant_world(glm::vec3(1));
  engine::RenderRequest r = still(64);
  r.transparent_film = true;
  const Picture p = render(s, r);
  expect_share(p, Pass::kCombined, 3, 0.25, 4 * binomial(0.25, 64), 0.01);
}

TEST(Alpha, DepthIsThatOfTheFirstLayerFromOneHalfOn) {
  // Cycles: pass_alpha_threshold .5, whatever the number of samples.
  for (uint32_t samples : {1u, 16u}) {
    const Picture thin = render(cards({0.3f}), still(samples, {Pass::kDepth})),
                  thick = render(cards({0.7f}), still(samples, {Pass::kDepth}));
    expect_share(thin, Pass::kDepth, 0, 5, 1e-4, 1e-4);
    expect_share(thick, Pass::kDepth, 0, 3, 1e-4, 1e-4);
  }
}

TEST(Alpha, TransparencyHasNoColourInShadows) {
  TestScene s;
  s.add_object(floor_at(0, 2), {s.add_material(lambert())});
  s.add_object(floor_at(1, 2),
               {s.add_material(
                   material("void evaluate_material(const Hit hit, inout Surface surface) {\n"
                            "  closure_transparent(surface, vec3(1.0), vec3(1.0));\n"
                            "}\n",
                            {}, {.alpha = true, .glossy = false}))});
  s.lights = {sun({0, 0, -1}, float(kPi))};
  const Picture p = render(s, still(4, {Pass::kDiffDir}));
  expect_share(p, Pass::kDiffDir, 0, 1, 1e-5, 1e-5);
}

TEST(Alpha, MixesWithOpaqueObjectsOfTheSameMesh) {
  // Slots of one mesh: opaque left half, transparent right half.
  TestScene s;
  Geometry g = quad({-0.5f, 0, 1}, {0.5f, 0, 0}, {0, 1, 0});
  g.add(quad({0.5f, 0, 1}, {0.5f, 0, 0}, {0, 1, 0}), 1);
  s.add_object(floor_at(0, 2), {s.add_material(lambert({0, 0, 1}))});
  s.add_object(g,
               {s.add_material(lambert({1, 0, 0})), s.add_material(alpha_card({0, 1, 0, 0.7f}))});
  s.add_instance(2, {1, 3},
                 glm::mat4(glm::vec4(1, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 1, 0),
                           glm::vec4(0, 0, 1, 1)));
  const Picture p = render(s, still(1));
  EXPECT_EQ(p.rgb(Pass::kDiffCol, 4, 16), glm::dvec3(0, 0, 1));  // the second instance's slot 0
  EXPECT_EQ(p.rgb(Pass::kDiffCol, 28, 16), glm::dvec3(0, 1, 0));
}

}  // namespace
}  // namespace panoptes::test
