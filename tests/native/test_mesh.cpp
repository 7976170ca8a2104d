// What becomes of Blender's mesh arrays.
#include "base/error.h"
#include "support.h"

#include <cmath>
#include <limits>
#include <random>

namespace panoptes::test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

// The inverse of pack_unit, written anew from the octahedral map's definition.
glm::dvec3 unpack(uint32_t word) {
  const auto half = [](uint32_t bits) {
    return std::max(double(int16_t(uint16_t(bits))) / 32767.0, -1.0);
  };
  const double x = half(word & 0xffff), y = half(word >> 16);
  glm::dvec3 n{x, y, 1.0 - std::abs(x) - std::abs(y)};
  if (n.z < 0) {
    n.x = (1.0 - std::abs(y)) * (x >= 0 ? 1 : -1);
    n.y = (1.0 - std::abs(x)) * (y >= 0 ? 1 : -1);
  }
  return glm::normalize(n);
}

double degrees_between(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180 / kPi;
}

TEST(PackUnit, ErrsByLessThanFourThousandthsOfADegree) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  double worst = 0;
  for (int i = 0; i < 400000; ++i) {
    const glm::dvec3 n = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    worst = std::max(worst, degrees_between(n, unpack(scene::pack_unit(glm::vec3(n)))));
  }
  EXPECT_LT(worst, 0.004);
  EXPECT_GT(worst, 0.001) << "the grid of 16 bits cannot be finer: this test measures nothing";
}

TEST(PackUnit, KeepsTheAxesExactly) {
  for (int axis = 0; axis < 3; ++axis)
    for (float sign : {1.0f, -1.0f}) {
      glm::vec3 n(0);
      n[axis] = sign;
      EXPECT_EQ(unpack(scene::pack_unit(n)), glm::dvec3(n));
    }
}

TEST(PackUnit, IgnoresTheLength) {
  for (float length : {1e-30f, 1e-3f, 1.0f, 1e30f})
    EXPECT_LT(degrees_between(unpack(scene::pack_unit(length * glm::vec3(1, -2, -3))),
                              glm::normalize(glm::dvec3(1, -2, -3))),
              0.004);
}

TEST(PackUnit, TurnsWhatHasNoDirectionToTheZenith) {
  for (const glm::vec3& n :
       {glm::vec3(0), glm::vec3(kNaN, 1, 0), glm::vec3(0, kInf, 0), glm::vec3(0, 0, -kInf)})
    EXPECT_EQ(unpack(scene::pack_unit(n)), glm::dvec3(0, 0, 1));
}

// A strip of `count` separate triangles; triangle t has vertices and loops 3t .. 3t + 2.
Geometry strip(const std::vector<int>& slots) {
  Geometry g;
  for (size_t t = 0; t < slots.size(); ++t) {
    const float x = float(t);
    const int i = int(3 * t);
    for (const glm::vec3& p : {glm::vec3(x, 0, 0), glm::vec3(x + 1, 0, 0), glm::vec3(x, 1, 0)}) {
      g.positions.push_back(p);
      g.normals.push_back({0, 0, 1});
      g.uv.insert(g.uv.end(), {float(g.positions.size()), float(t)});
    }
    g.triangles.push_back({i, i + 1, i + 2});
    g.loops.push_back({i, i + 1, i + 2});
    g.slots.push_back(slots[t]);
  }
  return g;
}

TEST(MakeMesh, SortsTrianglesBySlotAndKeepsTheirOrderWithin) {
  const scene::Mesh mesh = strip({2, 0, 2, 1, 0, 2}).mesh();
  ASSERT_EQ(mesh.triangles.size(), 6u);
  const uint32_t order[6] = {1, 4, 3, 0, 2, 5};
  for (size_t i = 0; i < 6; ++i) EXPECT_EQ(mesh.triangles[i].x, 3 * order[i]);
  ASSERT_EQ(mesh.ranges.size(), 3u);
  const scene::MaterialRange expected[3] = {{0, 0, 2}, {1, 2, 1}, {2, 3, 3}};
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(mesh.ranges[i].slot, expected[i].slot);
    EXPECT_EQ(mesh.ranges[i].first, expected[i].first);
    EXPECT_EQ(mesh.ranges[i].count, expected[i].count);
  }
  EXPECT_TRUE(mesh.warning.empty());
}

TEST(MakeMesh, TreatsNegativeSlotsAsTheFirst) {
  const scene::Mesh mesh = strip({-3, 0}).mesh();
  ASSERT_EQ(mesh.ranges.size(), 1u);
  EXPECT_EQ(mesh.ranges[0].slot, 0);
  EXPECT_EQ(mesh.ranges[0].count, 2u);
}

TEST(MakeMesh, GathersLoopsToCornersInTheSortedOrder) {
  Geometry g = strip({1, 0});
  // Loops need not be in the vertices' order: reverse those of the second triangle.
  g.loops[1] = {5, 4, 3};
  g.normals[4] = {1, 0, 0};
  const scene::Mesh mesh = g.mesh();
  ASSERT_EQ(mesh.attributes.size(), 1u);
  const std::vector<float> expected{6, 1, 5, 1, 4, 1, 1, 0, 2, 0, 3, 0};
  EXPECT_EQ(mesh.attributes[0].values, expected);
  EXPECT_EQ(mesh.corner_normals[0].y, scene::pack_unit({1, 0, 0}));
  EXPECT_EQ(mesh.corner_normals[0].x, scene::pack_unit({0, 0, 1}));
  EXPECT_EQ(mesh.corner_normals[1].y, scene::pack_unit({0, 0, 1}));
}

TEST(MakeMesh, GathersFourChannelColours) {
  Geometry g = strip({0});
  for (int i = 0; i < 12; ++i) g.color.push_back(float(i));
  const scene::Mesh mesh = g.mesh();
  ASSERT_EQ(mesh.attributes.size(), 2u);
  EXPECT_EQ(mesh.attributes[1].channels, 4);
  EXPECT_EQ(mesh.attributes[1].values, g.color);
}

TEST(MakeMesh, BoundsWhatItsTrianglesUse) {
  Geometry g = strip({0, 0});
  g.positions.push_back({100, 100, 100});  // no triangle uses it
  const scene::Mesh mesh = g.mesh();
  EXPECT_EQ(mesh.bounds.low, glm::vec3(0, 0, 0));
  EXPECT_EQ(mesh.bounds.high, glm::vec3(2, 1, 0));
}

TEST(MakeMesh, DropsTrianglesOfBrokenVerticesWithAWarning) {
  for (const float broken : {kNaN, kInf, -kInf})
    for (int axis = 0; axis < 3; ++axis) {
      Geometry g = strip({0, 1, 0});
      g.positions[4][axis] = broken;
      const scene::Mesh mesh = g.mesh("knot");
      ASSERT_EQ(mesh.triangles.size(), 2u);
      EXPECT_EQ(mesh.triangles[0].x, 0u);
      EXPECT_EQ(mesh.triangles[1].x, 6u);
      ASSERT_EQ(mesh.ranges.size(), 1u);  // slot 1 is left without triangles
      EXPECT_EQ(mesh.attributes[0].values.size(), 12u);
      EXPECT_EQ(mesh.attributes[0].values[6], 7.0f);
      EXPECT_EQ(mesh.bounds.high, glm::vec3(3, 1, 0));
      EXPECT_NE(mesh.warning.find("'knot'"), std::string::npos) << mesh.warning;
      EXPECT_NE(mesh.warning.find("1 of its triangles"), std::string::npos) << mesh.warning;
      for (const glm::vec3& p : mesh.positions)
        EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    }
}

TEST(MakeMesh, LeavesAMeshOfBrokenVerticesEmpty) {
  Geometry g = strip({0, 3});
  for (glm::vec3& p : g.positions) p.x = kNaN;
  const scene::Mesh mesh = g.mesh();
  EXPECT_TRUE(mesh.triangles.empty());
  EXPECT_TRUE(mesh.ranges.empty());
  EXPECT_TRUE(mesh.bounds.empty());
  EXPECT_FALSE(mesh.warning.empty());
}

TEST(MakeMesh, AcceptsNoTriangles) {
  const scene::Mesh mesh = Geometry().mesh();
  EXPECT_TRUE(mesh.triangles.empty());
  EXPECT_TRUE(mesh.warning.empty());
}

TEST(MakeMesh, TurnsAttributesThatAreNotFiniteToZero) {
  Geometry g = strip({0});
  g.uv = {kNaN, 1, kInf, 2, -kInf, 3};
  EXPECT_EQ(g.mesh().attributes[0].values, (std::vector<float>{0, 1, 0, 2, 0, 3}));
}

TEST(MakeMesh, ThrowsOnIndicesOutOfRange) {
  for (int bad : {-1, 3, std::numeric_limits<int>::max()})
    for (int corner = 0; corner < 3; ++corner) {
      Geometry vertex = strip({0}), loop = strip({0});
      vertex.triangles[0][corner] = bad;
      loop.loops[0][corner] = bad;
      expect_error([&] { vertex.mesh("cube"); }, "'cube'");
      expect_error([&] { loop.mesh("cube"); }, "'cube'");
    }
}

TEST(MakeMesh, ThrowsOnArraysThatDoNotFitTogether) {
  Geometry slots = strip({0}), loops = strip({0, 0}), attribute = strip({0});
  slots.slots.clear();
  loops.loops.pop_back();
  attribute.uv.pop_back();
  expect_error([&] { slots.mesh(); }, "lengths");
  expect_error([&] { loops.mesh(); }, "lengths");
  expect_error([&] { attribute.mesh(); }, "'uv'");
}

TEST(PlacedBounds, EncloseTheCornersAfterTheTransform) {
  const glm::mat4 m(glm::vec4(0, 2, 0, 0), glm::vec4(-1, 0, 0, 0), glm::vec4(0, 0, -3, 0),
                    glm::vec4(10, 20, 30, 1));
  scene::Bounds bounds;
  bounds.add({-1, -2, -3});
  bounds.add({1, 2, 5});
  const scene::Bounds placed = scene::placed_bounds(bounds, m);
  EXPECT_EQ(placed.low, glm::vec3(8, 18, 15));
  EXPECT_EQ(placed.high, glm::vec3(12, 22, 39));
  EXPECT_TRUE(scene::placed_bounds({}, m).empty());
}

}  // namespace
}  // namespace panoptes::test
