// The tree that paths choose lights by, records of lights and the world's distribution: all that needs
// no GL.
#include "path_tracer/light_records.h"
#include "path_tracer/light_tree.h"
#include "path_tracer/world_map.h"
#include "support.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <limits>
#include <random>

namespace panoptes::test {
namespace {

using path_tracer::build_light_tree;
using path_tracer::describe;
using path_tracer::DescribedLight;
using path_tracer::LightBounds;
using path_tracer::LightTree;
using shared::LightNode;

LightBounds bounds_at(const glm::vec3& place, float intensity = 1) {
  LightBounds b;
  b.box = {place, place};
  b.intensity = intensity;
  return b;
}

std::vector<LightBounds> random_lights(size_t count, bool suns = false) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> u(-1, 1);
  const auto vec = [&] { return glm::vec3(u(random), u(random), u(random)); };
  std::vector<LightBounds> lights;
  for (size_t i = 0; i < count; ++i) {
    LightBounds b = bounds_at(100.0f * vec(), 1 + u(random) * 0.9f);
    b.box.add(b.box.low + glm::abs(vec()));
    b.axis = glm::normalize(vec() + glm::vec3(0, 0, 0.01f));
    b.cosine_o = i % 3 ? 1.0f : u(random);
    b.two_sided = i % 2;
    b.infinite = suns && i % 5 == 0;
    lights.push_back(b);
  }
  return lights;
}

// The leaf that a trail leads to, and the nodes on the way.
std::vector<uint32_t> walk(const LightTree& tree, uint32_t trail) {
  std::vector<uint32_t> way{0};
  while (!(tree.nodes[way.back()].child & shared::NODE_LEAF)) {
    way.push_back(trail & 1 ? tree.nodes[way.back()].child & shared::NODE_INDEX : way.back() + 1);
    trail >>= 1;
  }
  return way;
}

void expect_leaves(const LightTree& tree, size_t count) {
  ASSERT_EQ(tree.nodes.size(), 2 * count - 1);
  for (uint32_t light = 0; light < count; ++light) {
    const std::vector<uint32_t> way = walk(tree, tree.trails[light]);
    ASSERT_LE(way.size(), size_t(shared::MOST_LEVELS) + 1);
    EXPECT_EQ(tree.nodes[way.back()].child & shared::NODE_INDEX, light);
  }
}

TEST(LightTree, TrailsLeadToTheirLights) {
  for (size_t count : {1, 2, 3, 1000}) expect_leaves(build_light_tree(random_lights(count)), count);
  EXPECT_TRUE(build_light_tree({}).nodes.empty());
}

TEST(LightTree, NodesHoldWhatIsBelowThem) {
  const std::vector<LightBounds> lights = random_lights(500);
  const LightTree tree = build_light_tree(lights);
  std::vector<double> sums(tree.nodes.size(), 0);
  for (uint32_t i = 0; i < lights.size(); ++i)
    for (uint32_t node : walk(tree, tree.trails[i])) {
      const LightNode& n = tree.nodes[node];
      sums[node] += lights[i].intensity;
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE((&n.low_x)[axis], lights[i].box.low[axis]);
        EXPECT_GE((&n.high_x)[axis], lights[i].box.high[axis]);
      }
      EXPECT_LE(n.cosine_e, lights[i].cosine_e);
      EXPECT_TRUE(!lights[i].two_sided || (n.child & shared::NODE_TWO_SIDED));
    }
  for (size_t i = 0; i < sums.size(); ++i) EXPECT_NEAR(tree.nodes[i].intensity, sums[i], 1e-4 * sums[i]);
}

TEST(LightTree, SkipsLeadPastWhatIsBelow) {
  const LightTree tree = build_light_tree(random_lights(300), 1000);
  // Met everywhere, every node follows; skipped at the root, the end does.
  EXPECT_EQ(tree.nodes[0].skip, 1000 + tree.nodes.size());
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    const LightNode& n = tree.nodes[i];
    if (n.child & shared::NODE_LEAF) {
      EXPECT_EQ(n.skip, 1000 + i + 1);
    } else {
      EXPECT_EQ(tree.nodes[i + 1].skip, n.child & shared::NODE_INDEX);
      EXPECT_EQ(tree.nodes[(n.child & shared::NODE_INDEX) - 1000].skip, n.skip);
    }
  }
}

TEST(LightTree, ConesHoldBothCones) {
  const std::vector<LightBounds> lights = random_lights(200);
  std::mt19937 random(7);
  for (int i = 0; i < 2000; ++i) {
    const LightBounds &a = lights[random() % 200], &b = lights[random() % 200];
    const LightBounds both = path_tracer::merge(a, b);
    for (const LightBounds* part : {&a, &b}) {
      float between = glm::dot(part->axis, both.axis);
      if (both.two_sided) between = std::abs(between);
      const double reach = std::acos(std::clamp(between, -1.0f, 1.0f)) +
                           std::acos(std::clamp(part->cosine_o, -1.0f, 1.0f));
      EXPECT_LE(std::min(reach, kPi), std::acos(std::clamp(both.cosine_o, -1.0f, 1.0f)) + 2e-3);
    }
  }
}

// What a trail's bits can hold is never exceeded, however lopsided the best splits would be.
TEST(LightTree, IsNeverDeeperThanATrailIsLong) {
  std::vector<LightBounds> nested;
  for (int i = 0; i < 5000; ++i)
    nested.push_back(bounds_at(glm::vec3(std::ldexp(1.0f, 100 - i % 200), 0, 0), std::ldexp(1.0f, i % 90)));
  expect_leaves(build_light_tree(nested), nested.size());
  const std::vector<LightBounds> heap(100'000, bounds_at({1, 2, 3}));
  expect_leaves(build_light_tree(heap), heap.size());
}

TEST(LightTree, SunsLieBelowTheSecondChildOfTheRoot) {
  const std::vector<LightBounds> lights = random_lights(100, true);
  const LightTree tree = build_light_tree(lights);
  expect_leaves(tree, lights.size());
  for (uint32_t i = 0; i < lights.size(); ++i) {
    EXPECT_EQ(tree.trails[i] & 1, uint32_t(lights[i].infinite));
    const std::vector<uint32_t> way = walk(tree, tree.trails[i]);
    EXPECT_EQ(bool(tree.nodes[way[1]].child & shared::NODE_INFINITE), lights[i].infinite);
  }
}

TEST(LightTree, SaysWhenThereAreTooManyLights) {
  const std::vector<LightBounds> lights = random_lights(3);
  EXPECT_NO_THROW(build_light_tree(lights, shared::NODE_INDEX - 6));
  expect_error([&] { build_light_tree(lights, shared::NODE_INDEX - 5); }, "paths can choose among 2");
}

// --- records -------------------------------------------------------------------------------------

TEST(LightRecords, OfLampsWithoutLightThereAreNone) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (float energy : {0.0f, kNan, kInfinity, -kInfinity, 1e38f})
    for (scene::Light lamp : {sun({0, 0, -1}, energy), point({0, 0, 0}, energy, 1),
                              area({0, 0, 0}, {0, 0, 1}, energy, scene::AreaShape::kDisk, 1, 1)})
      EXPECT_FALSE(describe(lamp, glm::dvec3(0)).has_value()) << energy;
  for (float place : {kNan, kInfinity, 1e20f})
    EXPECT_FALSE(describe(point({place, 0, 0}, 1), glm::dvec3(0)).has_value()) << place;
  EXPECT_TRUE(describe(point({0, 0, 0}, -5), glm::dvec3(0)).has_value());
}

TEST(LightRecords, WhatHasNoExtentIsSingular) {
  const auto singular = [](const scene::Light& lamp) {
    const auto light = describe(lamp, glm::dvec3(0));
    EXPECT_TRUE(light.has_value());
    EXPECT_EQ(light->seen, !(light->flags() & shared::RECORD_SINGULAR));
    return !light->seen;
  };
  using scene::AreaShape;
  EXPECT_TRUE(singular(point({1, 2, 3}, 5)));
  EXPECT_TRUE(singular(point({1, 2, 3}, 5, 1e-20f)));
  EXPECT_FALSE(singular(point({1, 2, 3}, 5, 0.1f)));
  EXPECT_TRUE(singular(sun({0, 0, -1}, 5)));
  EXPECT_TRUE(singular(area({0, 0, 0}, {0, 0, 1}, 5, AreaShape::kRectangle, 1, 0)));
  EXPECT_FALSE(singular(area({0, 0, 0}, {0, 0, 1}, 5, AreaShape::kRectangle, 1, 1e-3f)));
}

TEST(LightRecords, AShearedAreaShinesOutOfItsPlane) {
  scene::Light lamp = area({0, 0, 0}, {0, 0, -1}, 8, scene::AreaShape::kRectangle, 2, 1);
  lamp.object_to_world[2] = {0.5f, 0.3f, 2, 0};
  const auto light = describe(lamp, glm::dvec3(0));
  ASSERT_TRUE(light.has_value());
  EXPECT_NEAR(std::abs(light->bounds.axis.z), 1, 1e-6);
  EXPECT_GT(glm::dot(light->bounds.axis, lamp.direction()), 0);
  EXPECT_NEAR(light->record.axis.w, 2, 1e-5);
  EXPECT_NEAR(light->record.front.x, 1, 1e-5);  // P / (4 A)
}

TEST(LightRecords, TrianglesThatShineOnOneSideFaceThatWay) {
  path_tracer::GlowingTriangle triangle;
  triangle.corners = {glm::dvec3(0), {1, 0, 0}, {0, 1, 0}};
  triangle.back = glm::vec3(1);
  auto light = describe(triangle);
  ASSERT_TRUE(light.has_value());
  EXPECT_EQ(light->bounds.axis, glm::vec3(0, 0, -1));
  EXPECT_FALSE(light->bounds.two_sided);
  EXPECT_EQ(light->bounds.intensity, 0.5f);
  triangle.mirrored = true;
  EXPECT_EQ(describe(triangle)->bounds.axis, glm::vec3(0, 0, 1));
  triangle.front = glm::vec3(2);
  EXPECT_TRUE(describe(triangle)->bounds.two_sided);
  triangle.corners[2] = {0.5, 0, 0};
  EXPECT_FALSE(describe(triangle).has_value());
  triangle.corners[2] = {0, std::numeric_limits<double>::infinity(), 0};
  EXPECT_FALSE(describe(triangle).has_value());
}

// --- the world's distribution --------------------------------------------------------------------

TEST(WorldDistribution, IsCumulativeAndNowhereWithoutAChance) {
  constexpr int kWidth = 64, kHeight = 32;
  std::vector<float> brightness(kWidth * kHeight, 0.0f);
  brightness[10 * kWidth + 20] = 3;
  brightness[10 * kWidth + 21] = 1;
  const std::vector<float> sums = path_tracer::world_distribution(brightness, kWidth, kHeight);
  const auto share = [&](int x, int y) {
    const size_t row = (kHeight + 1) + size_t(y) * (kWidth + 1);
    return double(sums[size_t(y) + 1] - sums[size_t(y)]) * (sums[row + size_t(x) + 1] - sums[row + size_t(x)]);
  };
  double total = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      EXPECT_GT(share(x, y), 0);
      total += share(x, y);
    }
  EXPECT_NEAR(total, 1, 1e-6);
  EXPECT_NEAR(share(20, 10) / share(21, 10), 3, 0.01);
  EXPECT_NEAR(share(20, 10) + share(21, 10), 0.95, 0.001);
}

}  // namespace
}  // namespace panoptes::test
