// Points on glowing surfaces: uniform over their area, whatever the transform. No GL.
#include "scene/emitters.h"
#include "support.h"

#include <cmath>
#include <random>

namespace panoptes::test {
namespace {

using scene::Emitter;
using scene::EmitterPoint;

scene::Scene scene_with(const Geometry& geometry, const glm::mat4& place) {
  TestScene setup;
  setup.add_object(geometry, {setup.add_material(emitter(glm::vec3(1)))}, place);
  scene::Scene scene;
  setup.install(scene);
  return scene;
}

glm::mat4 columns(const glm::vec3& x, const glm::vec3& y, const glm::vec3& z, const glm::vec3& t) {
  return {glm::vec4(x, 0), glm::vec4(y, 0), glm::vec4(z, 0), glm::vec4(t, 1)};
}

TEST(Emitters, AreaIsThatOfTheWorld) {
  const Geometry plate = quad({0, 0, 0}, {1, 0, 0}, {0, 0.5f, 0});  // 2 square metres
  const struct {
    glm::mat4 place;
    double area;
  } cases[] = {{glm::mat4(1.0f), 2},
               {columns({3, 0, 0}, {0, 3, 0}, {0, 0, 3}, {5, 6, 7}), 18},
               {columns({0, 3, 0}, {-3, 0, 0}, {0, 0, -3}, {0, 0, 0}), 18},
               {columns({2, 0, 0}, {0, 5, 0}, {0, 0, 1}, {0, 0, 0}), 20},
               {columns({1, 0, 0}, {1, 1, 0}, {0, 0, 1}, {0, 0, 0}), 2}};
  for (const auto& c : cases) {
    const auto found = scene::find_emitters(scene_with(plate, c.place));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(found[0].area(), c.area, 1e-6 * c.area);
  }
}

TEST(Emitters, PointsAreUniformOverTheArea) {
  // A chi-square test over cells of equal area: a box under a transform that stretches and shears,
  // whose faces have different areas, each split into cells by its own two triangles.
  const glm::mat4 place = columns({2, 0, 0}, {0.5f, 0.7f, 0}, {0, 0, -1.5f}, {10, 0, 3});
  const auto found = scene::find_emitters(scene_with(box({0, 0, 0}, {1, 0.5f, 0.25f}), place));
  ASSERT_EQ(found.size(), 1u);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform;
  const int samples = 40000;
  // Four cells of equal area a triangle, by its midlines.
  std::vector<double> count(12 * 4, 0), share(12, 0);
  for (int i = 0; i < samples; ++i) {
    const EmitterPoint p = found[0].sample(uniform(random), uniform(random));
    ASSERT_LT(p.triangle, 12u);
    const glm::vec2 b = p.barycentrics;
    ASSERT_GE(std::min(b.x, b.y), 0);
    ASSERT_LE(b.x + b.y, 1 + 1e-6);
    const int cell = b.x > 0.5f ? 1 : b.y > 0.5f ? 2 : b.x + b.y < 0.5f ? 0 : 3;
    ++count[p.triangle * 4 + size_t(cell)];
  }
  const scene::Mesh mesh = box({0, 0, 0}, {1, 0.5f, 0.25f}).mesh();
  double total = 0;
  for (size_t t = 0; t < 12; ++t) {
    const glm::mat3 linear(place);
    const glm::uvec3 v = mesh.triangles[t];
    share[t] = glm::length(glm::cross(linear * (mesh.positions[v.y] - mesh.positions[v.x]),
                                      linear * (mesh.positions[v.z] - mesh.positions[v.x])));
    total += share[t];
  }
  double chi_square = 0;
  for (size_t c = 0; c < count.size(); ++c) {
    const double expected = samples * share[c / 4] / total / 4;
    chi_square += (count[c] - expected) * (count[c] - expected) / expected;
  }
  EXPECT_LT(chi_square, 82.7);  // 47 degrees of freedom, exceeded once in a thousand times
}

TEST(Emitters, PointsLieOnTheirTriangleAndFaceItsFront) {
  for (float mirror : {1.0f, -1.0f}) {
    const glm::mat4 place = columns({2 * mirror, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1 << 20, 3, -5});
    const auto found = scene::find_emitters(scene_with(sphere({0, 0, 0}, 1, 16), place));
    ASSERT_EQ(found.size(), 1u);
    for (float u = 0.03f; u < 1; u += 0.05f) {
      const EmitterPoint p = found[0].sample(u, 1 - u);
      const glm::dvec3 outwards = p.position - glm::dvec3(1 << 20, 3, -5);
      EXPECT_NEAR(glm::length(outwards), 2, 0.1);  // the sphere has flat facets
      EXPECT_GT(glm::dot(glm::normalize(outwards), glm::dvec3(p.normal)), 0.95);
      EXPECT_NEAR(glm::length(p.normal), 1, 1e-6);
    }
  }
}

TEST(Emitters, SkipsWhatHasNoArea) {
  const Geometry plate = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  EXPECT_TRUE(scene::find_emitters(scene_with(plate, glm::mat4(0.0f))).empty());
  EXPECT_TRUE(scene::find_emitters(scene_with(quad({0, 0, 0}, {1, 0, 0}, {1, 0, 0}), glm::mat4(1)))
                  .empty());
  // Degenerate triangles at the end of the list are never chosen.
  Geometry mixed = plate;
  mixed.add(quad({0, 0, 0}, {1, 0, 0}, {1, 0, 0}));
  const auto found = scene::find_emitters(scene_with(mixed, glm::mat4(1)));
  ASSERT_EQ(found.size(), 1u);
  for (float u : {0.0f, 0.5f, 0.9999999f, 1.0f}) EXPECT_LT(found[0].sample(u, 0.5f).triangle, 2u);
}

TEST(Emitters, WhatNoScatteredRayMeetsLightsNothing) {
  TestScene setup;
  setup.add_object(quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                   {setup.add_material(emitter(glm::vec3(1)))});
  const auto found = [&](uint32_t visibility) {
    setup.instances[0].visibility = visibility;
    scene::Scene scene;
    setup.install(scene);
    return scene::find_emitters(scene).size();
  };
  EXPECT_EQ(found(shared::SEEN_BY_CAMERA | shared::SEEN_BY_SHADOW | shared::SEEN_BY_VOLUME_SCATTER), 0u);
  for (uint32_t kind : {shared::SEEN_BY_DIFFUSE, shared::SEEN_BY_GLOSSY, shared::SEEN_BY_TRANSMISSION})
    EXPECT_EQ(found(kind), 1u);
}

TEST(Emitters, SurfacesThatDoNotEmitAreNone) {
  TestScene setup;
  setup.add_object(floor_at(0, 1), {setup.add_material(lambert())});
  scene::Scene scene;
  setup.install(scene);
  EXPECT_TRUE(scene::find_emitters(scene).empty());
}

}  // namespace
}  // namespace panoptes::test
