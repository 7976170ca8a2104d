// Light of the radiance cache where scenes, lamps and materials are unusual.
#include "support.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <limits>

namespace panoptes::test {
namespace {

using film::Pass;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

// A table on a floor under a lamp and a grey sky, of a size and about a place.
struct Place {
  double size = 1;
  glm::dvec3 middle{0};
};

TestScene table(const Place& place) {
  TestScene s;
  const Id grey = s.add_material(lambert(glm::vec3(0.5f)));
  Geometry g = floor_at(0, 2);
  g.add(box({0, 0, 0.5f}, {0.6f, 0.6f, 0.1f}));
  const glm::dmat4 to_world =
      glm::scale(glm::translate(glm::dmat4(1), place.middle), glm::dvec3(place.size));
  s.add_object(g, {grey}, glm::mat4(to_world));
  // As bright at any size.
  s.lights = {point(glm::vec3(place.middle + place.size * glm::dvec3(1, 0, 1.5)),
                    float(100 * place.size * place.size))};
  s.world = constant_world(glm::vec3(0.3f));
  return s;
}

engine::RenderRequest cached(const Place& place = {}) {
  engine::RenderRequest r =
      request(perspective(place.middle + place.size * glm::dvec3(3, -4, 3), place.middle, 0.7, 16, 16,
                          0.01 * place.size, 1000 * place.size),
              {Pass::kDiffDir, Pass::kDiffInd});
  r.cache.enabled = true;
  r.occlusion.strength = 0;
  return r;
}

double mean_of(const Picture& p, Pass pass) {
  double sum = 0;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) sum += p.value(pass, x, y, 1) / (p.width * p.height);
  return sum;
}

// render() has seen that all is finite.
void expect_none_negative(const Picture& p) {
  for (Pass pass : {Pass::kDiffDir, Pass::kDiffInd})
    for (float value : p[pass]) ASSERT_GE(value, 0);
}

void expect_as_at_home(const Place& place, double tolerance) {
  const Picture home = render(table({}), cached()), there = render(table(place), cached(place));
  expect_none_negative(there);
  const double all = mean_of(home, Pass::kDiffDir) + mean_of(home, Pass::kDiffInd);
  for (Pass pass : {Pass::kDiffDir, Pass::kDiffInd})
    EXPECT_NEAR(mean_of(there, pass), mean_of(home, pass), tolerance * all)
        << place.size << " m at " << place.middle.x;
}

TEST(CacheHardCases, AMillionMetresFromTheOrigin) {
  expect_as_at_home({1, {1048576, -1048576, 1048576}}, 0.02);
}

TEST(CacheHardCases, ScenesOfAMillimetreAndOfAHundredKilometres) {
  // Cells come in eight sizes to an octave: the same lattice about scenes of any power of two.
  for (double size : {1.0 / 1024, 65536.0}) expect_as_at_home({size, glm::dvec3(0)}, 0.02);
}

TEST(CacheHardCases, AFlatSceneAndASingleTriangle) {
  for (bool single : {false, true}) {
    TestScene s;
    Geometry g = floor_at(0, 2);
    if (single) {
      g.triangles.resize(1);
      g.loops.resize(1);
      g.slots.resize(1);
    }
    s.add_object(g, {s.add_material(lambert(glm::vec3(0.5f)))});
    s.world = constant_world(glm::vec3(0.3f));
    engine::RenderRequest r = cached();
    r.camera = orthographic({0.5, -0.5, 4}, {0.5, -0.5, 0}, 0.3, 8, 8);  // of the triangle that is left
    const Picture p = render(s, r);
    expect_none_negative(p);
    EXPECT_NEAR(mean_of(p, Pass::kDiffDir), 0.3, 0.015);
    EXPECT_LT(mean_of(p, Pass::kDiffInd), 0.006);
  }
}

TEST(CacheHardCases, NothingButLamps) {
  TestScene s = table({});
  s.instances.clear();
  const Picture p = render(s, cached());
  EXPECT_NEAR(mean_of(p, Pass::kCombined), 0.3, 1e-6);
  for (Pass pass : {Pass::kDiffDir, Pass::kDiffInd})
    for (float value : p[pass]) EXPECT_EQ(value, 0);
}

TEST(CacheHardCases, MoreRaysThanThereMayBe) {
  engine::RenderRequest r = cached();
  r.cache.occupancy = radiance_cache::Occupancy::kGeometry;
  const Picture all = render(table({}), r);
  EXPECT_TRUE(all.stats.warnings.empty());
  r.cache.most_rays = 20 * all.stats.cache.cells + 1;
  const Picture few = render(table({}), r);
  ASSERT_EQ(few.stats.warnings.size(), 1u);
  EXPECT_NE(few.stats.warnings[0].find("20 directions"), std::string::npos);
  EXPECT_NEAR(mean_of(few, Pass::kDiffDir), mean_of(all, Pass::kDiffDir), 0.1 * mean_of(all, Pass::kDiffDir));
  // There is always one.
  r.cache.most_rays = 1;
  EXPECT_GT(mean_of(render(table({}), r), Pass::kDiffDir), 0);
}

TEST(CacheHardCases, ACameraInsideOfThings) {
  engine::RenderRequest r = cached();
  r.camera = perspective({0, 0, 0.5}, {0.5, 0.1, 0.5}, 1, 16, 16);
  expect_none_negative(render(table({}), r));
}

TEST(CacheHardCases, AMirroredInstanceIsAsItsImage) {
  const Picture home = render(table({}), cached());
  for (const glm::vec3& scale : {glm::vec3(-1, 1, 1), glm::vec3(-1, -1, 1)}) {
    TestScene mirrored = table({});
    mirrored.instances[0].object_to_world = glm::scale(glm::mat4(1), scale);
    const Picture p = render(mirrored, cached());
    for (Pass pass : {Pass::kDiffDir, Pass::kDiffInd})
      EXPECT_NEAR(mean_of(p, pass), mean_of(home, pass), 0.03 * mean_of(home, pass)) << scale.y;
  }
}

TEST(CacheHardCases, BrokenMaterialsAndLamps) {
  for (float broken : {kNan, kInf, -kInf, 1e38f, -1.0f}) {
    TestScene s = table({});
    s.materials[0] = lambert(glm::vec3(broken));
    expect_none_negative(render(s, cached()));
    s = table({});
    s.world = constant_world(glm::vec3(broken));
    render(s, cached());
    s = table({});
    s.lights[0].energy = broken;
    render(s, cached());
  }
}

TEST(CacheHardCases, ALampWithoutPowerAddsNothing) {
  TestScene s = table({});
  const double home = mean_of(render(s, cached()), Pass::kDiffInd);
  s.lights.push_back(point({-1, 0, 1}, 0));
  EXPECT_NEAR(mean_of(render(s, cached()), Pass::kDiffInd), home, 1e-3 * home);
}

TEST(CacheHardCases, TwoHundredLampsAreAsBrightAsTheirSum) {
  TestScene s = table({});
  const double home = mean_of(render(s, cached()), Pass::kDiffInd);
  s.lights[0].energy /= 200;
  s.lights.resize(200, s.lights[0]);
  EXPECT_NEAR(mean_of(render(s, cached()), Pass::kDiffInd), home, 0.01 * home);
}

TEST(CacheHardCases, WhatIsNotThereTakesNoLight) {
  TestScene s;
  s.add_object(floor_at(0, 2), {s.add_material(lambert(glm::vec3(0.5f)))});
  s.world = constant_world(glm::vec3(0.3f));
  engine::RenderRequest r = cached();
  r.camera = orthographic({0, 0, 0.2}, {0, 0, 0}, 0.3, 8, 8);
  s.add_object(floor_at(0.6f, 2), {s.add_material(alpha_card(glm::vec4(0)))});
  EXPECT_NEAR(mean_of(render(s, r), Pass::kDiffDir), 0.3, 0.015);
}

TEST(CacheHardCases, AsManyCellsAsThereCanBe) {
  engine::RenderRequest r = cached();
  r.cache.resolution = 64;
  r.cache.cascades = 3;
  const Picture fine = render(table({}), r), home = render(table({}), cached());
  expect_none_negative(fine);
  EXPECT_NEAR(mean_of(fine, Pass::kDiffDir), mean_of(home, Pass::kDiffDir), 0.1 * mean_of(home, Pass::kDiffDir));
}

}  // namespace
}  // namespace panoptes::test
