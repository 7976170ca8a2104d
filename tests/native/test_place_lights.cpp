// Where shadow maps look and how lamps are shared out among batches. No GL.
#include "rasterize/shadow_maps.h"
#include "support.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace panoptes::test {
namespace {

using rasterize::LightSet;
using Points = std::vector<rasterize::LightSamplePoint>;

scene::Bounds bounds_of(const glm::vec3& low, const glm::vec3& high) {
  scene::Bounds b;
  b.add(low);
  b.add(high);
  return b;
}

const scene::Bounds kRoom = bounds_of({-3, -1, 0}, {5, 2, 4});

std::vector<glm::dvec3> corners(const scene::Bounds& b) {
  std::vector<glm::dvec3> all;
  for (int i = 0; i < 8; ++i)
    all.push_back(
        {i & 1 ? b.high.x : b.low.x, i & 2 ? b.high.y : b.low.y, i & 4 ? b.high.z : b.low.z});
  return all;
}

LightSet place_lights(const std::vector<scene::Light>& lamps, bool shadows, const Points& points,
                      const scene::Bounds& bounds, const glm::dvec3& camera, int resolution,
                      int layers, const std::vector<rasterize::MeshLight>& mesh_lights = {}) {
  return rasterize::place_lights(lamps, points, mesh_lights,
                                 {shadows, bounds, {}, camera, resolution, layers});
}

size_t drawn_views(const rasterize::PlacedLight& placed) {
  return size_t(std::count_if(placed.views.begin(), placed.views.end(),
                              [](const auto& view) { return view.has_value(); }));
}

LightSet place(const std::vector<scene::Light>& lamps, const scene::Bounds& bounds = kRoom,
               int resolution = 512, int layers = 12, const glm::dvec3& camera = {0.5, -7, 1.25}) {
  return place_lights(lamps, true, {}, bounds, camera, resolution, layers);
}

// Place in the map (-1..1) and stored depth of a point, as lights_shared.h describes a face.
glm::dvec3 ndc_of(const shared::ShadowFace& face, const glm::dvec3& point, const glm::dvec3& camera,
                  double* along = nullptr) {
  const glm::dvec3 p = point - camera - glm::dvec3(face.origin);
  const bool perspective = face.axis.w > 0.5f;
  const double depth = glm::dot(p, glm::dvec3(face.axis)), spread = perspective ? depth : 1.0;
  if (along) *along = depth;
  return {glm::dot(p, glm::dvec3(face.x)) / spread - face.x.w,
          glm::dot(p, glm::dvec3(face.y)) / spread - face.y.w,
          perspective ? face.depth.x / depth + face.depth.y : face.depth.x * depth + face.depth.y};
}

TEST(PlaceLights, FacesReadTheMapsAsTheyAreDrawn) {
  // What shaders read with must be the transform that the map's view is rasterised with.
  const glm::dvec3 camera(0.5, -7, 1.25);
  const LightSet set =
      place_lights({sun({0.2f, 0.5f, -1}, 1), spot({1, 0, 3}, {0.1f, 0.2f, -1}, 1, 1.0f, 0),
                    point({2, 1, 3}, 1)},
                   true, Points(3, {0.5f, 0.5f, {0.3f, -0.4f}}),
                   kRoom, camera, 64, 12);
  size_t face = 0;
  for (const rasterize::PlacedLight& placed : set.lights)
    for (const auto& drawn_view : placed.views) {
      if (!drawn_view) {
        EXPECT_LT(set.faces[face++].half_extent.z, 0);
        continue;
      }
      const gpu_scene::LightView& view = *drawn_view;
      const shared::View drawn = gpu_scene::light_view(view, {64, 64});
      for (const glm::dvec3& p : corners(kRoom)) {
        const glm::dvec4 clip =
            glm::dmat4(drawn.clip_from_relative) * glm::dvec4(p - view.origin, 1);
        if (clip.w <= 0) continue;
        const glm::dvec3 read = ndc_of(set.faces[face], p, camera);
        for (int i = 0; i < 3; ++i)
          EXPECT_NEAR(read[i], clip[i] / clip.w, 2e-6 * (1 + std::abs(clip[i] / clip.w)));
      }
      EXPECT_NEAR(set.faces[face].half_extent.x, view.half_x, 1e-6 * view.half_x);
      EXPECT_NEAR(set.faces[face].origin.w, 2 * view.half_x / 64, 0.5 * view.half_x / 64);
      ++face;
    }
  EXPECT_EQ(face, set.faces.size());
}

TEST(PlaceLights, GivesEachKindItsFaces) {
  scene::Light silent = point({0, 0, 3}, 1);
  silent.cast_shadow = false;
  const LightSet set =
      place({point({0, 0, 3}, 1), sun({0, 0, -1}, 1), spot({0, 0, 3}, {0, 0, -1}, 1, 1.0f, 0),
             spot({0, 0, 3}, {0, 0, -1}, 1, 3.0f, 0),
             area({0, 0, 3}, {0, 0, -1}, 1, scene::AreaShape::kDisk, 1, 1), silent},
            kRoom, 512, 100);
  const size_t faces[6] = {6, 1, 1, 6, 6, 0};
  ASSERT_EQ(set.lights.size(), 6u);
  uint32_t first = 0;
  for (size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(set.lights[i].views.size(), faces[i]) << "lamp " << i;
    if (faces[i]) {
      EXPECT_EQ(set.lights[i].light.shadow, first);
      EXPECT_EQ(set.lights[i].light.faces, faces[i]);
    } else {
      EXPECT_EQ(set.lights[i].light.shadow, shared::NO_SHADOW);
    }
    first += uint32_t(faces[i]);
  }
  EXPECT_EQ(set.faces.size(), first);
}

TEST(PlaceLights, CastsNothingWithoutShadowsOrGeometry) {
  const std::vector<scene::Light> lamps{point({0, 0, 3}, 1), sun({0, 0, -1}, 1)};
  EXPECT_TRUE(place_lights(lamps, false, {}, kRoom, {0, 0, 0}, 512, 12).faces.empty());
  EXPECT_TRUE(place(lamps, scene::Bounds()).faces.empty());
  EXPECT_EQ(place(lamps, scene::Bounds()).lights.size(), 2u);
}

TEST(PlaceLights, SharesLampsOutAmongBatches) {
  std::mt19937 random(3);
  for (int layers : {6, 7, 12, 32}) {
    std::vector<scene::Light> lamps;
    for (int i = 0; i < 60; ++i) {
      const int kind = int(random() % 4);
      lamps.push_back(kind == 0   ? point({0, 0, 3}, 1)
                      : kind == 1 ? sun({0, 0.1f, -1}, 1)
                      : kind == 2 ? spot({0, 0, 3}, {0, 0, -1}, 1, 1, 0)
                                  : point({1, 0, 3}, 1));
      lamps.back().cast_shadow = kind != 3;
    }
    const LightSet set = place(lamps, kRoom, 64, layers);
    std::vector<int> seen(lamps.size(), 0);
    for (const rasterize::LightBatch& batch : set.batches) {
      EXPECT_LE(batch.layers, uint32_t(layers));
      EXPECT_GT(batch.light_count, 0u);
      uint32_t next_layer = 0;
      for (uint32_t i = batch.first_light; i < batch.first_light + batch.light_count; ++i) {
        ASSERT_LT(i, lamps.size());
        ++seen[i];
        const shared::Light& light = set.lights[i].light;
        if (light.shadow == shared::NO_SHADOW) continue;
        for (uint32_t f = light.shadow; f < light.shadow + light.faces; ++f)
          if (set.faces[f].half_extent.z >= 0)
            EXPECT_EQ(set.faces[f].half_extent.z, float(next_layer++));
      }
      EXPECT_EQ(next_layer, batch.layers);
    }
    for (int count : seen) EXPECT_EQ(count, 1);
  }
}

TEST(PlaceLights, NoBatchOutrunsLlvmpipesLoops) {
  // An invocation is cut off after 65 535 iterations; a lamp with a shadow takes five.
  const LightSet set = place_lights(std::vector<scene::Light>(30000, sun({0, 0, -1}, 1)), false, {},
                                    kRoom, {0, 0, 0}, 64, 12);
  uint32_t sum = 0;
  for (const rasterize::LightBatch& batch : set.batches) {
    EXPECT_LT(5 * batch.light_count, 65000u);
    sum += batch.light_count;
  }
  EXPECT_EQ(sum, 30000u);
}

TEST(PlaceLights, SunMapsHoldTheWholeScene) {
  std::mt19937 random(4);
  std::normal_distribution<float> normal;
  const glm::dvec3 camera(0.5, -7, 1.25);
  const scene::Bounds scenes[] = {kRoom, bounds_of({-1, -1, 2}, {1, 1, 2}),
                                  bounds_of({1, 2, 3}, {1, 2, 3.5f}),
                                  bounds_of({-900, -900, -900}, {900, 900, 900})};
  for (const scene::Bounds& bounds : scenes)
    for (int i = 0; i < 40; ++i) {
      const glm::vec3 direction =
          i < 6 ? glm::vec3(i == 0, i == 1, i == 2) - glm::vec3(i == 3, i == 4, i == 5)
                : glm::vec3(normal(random), normal(random), normal(random));
      // A shifted grid must not lose the border either.
      for (float shift : {0.0f, 0.5f, -0.5f}) {
        const LightSet set = place_lights({sun(direction, 1)}, true,
                                          {{0.5f, 0.5f, glm::vec2(shift)}}, bounds, camera, 64, 12);
        ASSERT_EQ(set.faces.size(), 1u);
        for (const glm::dvec3& corner : corners(bounds)) {
          const glm::dvec3 ndc = ndc_of(set.faces[0], corner, camera);
          ASSERT_LE(std::abs(ndc.x), 1 + 1e-5);
          ASSERT_LE(std::abs(ndc.y), 1 + 1e-5);
          ASSERT_GE(ndc.z, 0);
          ASSERT_LE(ndc.z, 1);
        }
      }
    }
}

TEST(PlaceLights, SunMapsAreNotMuchLargerThanTheScene) {
  const LightSet set = place({sun({0, 0, -1}, 1)}, kRoom, 512);
  double reach = 0;
  for (const glm::dvec3& corner : corners(kRoom)) {
    const glm::dvec3 ndc = ndc_of(set.faces[0], corner, {0.5, -7, 1.25});
    reach = std::max({reach, std::abs(ndc.x), std::abs(ndc.y)});
  }
  EXPECT_GT(reach, 0.98);
}

uint32_t cube_face(const glm::dvec3& d) {  // the rule of direct_light.comp
  const glm::dvec3 a = glm::abs(d);
  if (a.x >= a.y && a.x >= a.z) return d.x >= 0 ? 0 : 1;
  if (a.y >= a.z) return d.y >= 0 ? 2 : 3;
  return d.z >= 0 ? 4 : 5;
}

TEST(PlaceLights, CubesCoverAllDirections) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const glm::dvec3 lamp(1, 0.5, 3), camera(0.5, -7, 1.25);
  for (int resolution : {16, 512}) {
    const LightSet set = place({point(glm::vec3(lamp), 1)}, kRoom, resolution);
    for (int i = 0; i < 5000; ++i) {
      glm::dvec3 d(normal(random), normal(random), normal(random));
      if (i < 500) d = glm::dvec3(int(i % 3) - 1, int(i / 3 % 3) - 1, int(i / 9 % 3) - 1);
      if (d == glm::dvec3(0)) continue;
      d = glm::normalize(d) * 2.0;
      double w = 0;
      const shared::ShadowFace& face = set.faces[cube_face(d)];
      if (face.half_extent.z < 0) {  // then nothing of the room lies there
        for (const glm::dvec3& corner : corners(kRoom)) EXPECT_NE(cube_face(corner - lamp), cube_face(d));
        continue;
      }
      const glm::dvec3 ndc = ndc_of(face, lamp + d, camera, &w);
      EXPECT_GT(w, 0);
      EXPECT_LE(std::abs(ndc.x), 1);
      EXPECT_LE(std::abs(ndc.y), 1);
      EXPECT_GE(ndc.z, 0);
      EXPECT_LE(ndc.z, 1);
    }
    // What lies in the scene lies before the far plane.
    for (const glm::dvec3& corner : corners(kRoom)) {
      const glm::dvec3 ndc = ndc_of(set.faces[cube_face(corner - lamp)], corner, camera);
      EXPECT_GT(ndc.z, 0);
      EXPECT_LT(ndc.z, 1);
    }
  }
}

TEST(PlaceLights, SpotMapsHoldTheirCone) {
  const glm::dvec3 lamp(1, 0.5, 3), camera(0.5, -7, 1.25);
  const glm::vec3 axis = glm::normalize(glm::vec3(0.3f, -0.4f, -1));
  for (float size : {0.05f, 0.8f, 2.0f, 2.5f, 3.14159f}) {
    const LightSet set = place({spot(glm::vec3(lamp), axis, 1, size, 0)}, kRoom, 64);
    const glm::dvec3 z(axis), x = glm::normalize(glm::cross(z, glm::dvec3(0, 0, 1))),
                              y = glm::cross(z, x);
    for (int i = 0; i < 64; ++i) {
      const double phi = 2 * kPi * i / 64, theta = 0.5 * size * 0.9999;
      const glm::dvec3 d =
          2.0 * (std::cos(theta) * z + std::sin(theta) * (std::cos(phi) * x + std::sin(phi) * y));
      const size_t face = set.faces.size() == 6 ? cube_face(d) : 0;
      const glm::dvec3 ndc = ndc_of(set.faces[face], lamp + d, camera);
      EXPECT_LE(std::max(std::abs(ndc.x), std::abs(ndc.y)), 1) << "cone " << size;
    }
  }
}

TEST(PlaceLights, LampsOutsideSeeTheSceneThroughOneFittedView) {
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  for (double distance : {20.0, 5e3, 1e4, 1e7}) {
    for (int i = 0; i < 40; ++i) {
      const glm::dvec3 d = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
      const glm::dvec3 lamp = glm::dvec3(1, 0.5, 2) + distance * d;
      const LightSet set = place({point(glm::vec3(lamp), 1)}, kRoom, 64, 12, {0, 0, 0});
      ASSERT_EQ(set.faces.size(), 1u);
      double reach = 0;
      for (const glm::dvec3& corner : corners(kRoom)) {
        // The lamp as the float matrix has it, since far away that is another place.
        const glm::dvec3 ndc = ndc_of(set.faces[0], corner, {0, 0, 0});
        reach = std::max({reach, std::abs(ndc.x), std::abs(ndc.y)});
        ASSERT_GE(ndc.z, 0);
        ASSERT_LE(ndc.z, 1);
      }
      EXPECT_LE(reach, 1);
      EXPECT_GT(reach, 0.6);
    }
  }
}

TEST(PlaceLights, AreasAndGlowingSurfacesSkipWhatLiesBehindThem) {
  // In the middle of the room, shining down: the face that looks up has nothing to show.
  const LightSet lamp =
      place({area({1, 0.5f, 2}, {0, 0, -1}, 1, scene::AreaShape::kSquare, 1, 1)}, kRoom, 64, 12);
  ASSERT_EQ(lamp.lights[0].views.size(), 6u);
  EXPECT_EQ(drawn_views(lamp.lights[0]), 5u);
  EXPECT_FALSE(lamp.lights[0].views[4]);

  rasterize::MeshLight glow{{1, 0.5, 2}, {1, 0, 0}, glm::vec3(1), glm::vec3(0), 0.1f};
  EXPECT_FALSE(place_lights({}, true, {}, kRoom, {0, 0, 0}, 64, 12, {glow}).lights[0].views[1]);
  std::swap(glow.front, glow.back);
  EXPECT_FALSE(place_lights({}, true, {}, kRoom, {0, 0, 0}, 64, 12, {glow}).lights[0].views[0]);
  glow.front = glm::vec3(1);
  EXPECT_EQ(drawn_views(place_lights({}, true, {}, kRoom, {0, 0, 0}, 64, 12, {glow}).lights[0]), 6u);
}

TEST(PlaceLights, CubesSkipFacesThatHoldNothing) {
  // Just below a wide flat scene, so near that no fitted view will do.
  const scene::Bounds plate = bounds_of({-10, -10, 1}, {10, 10, 1.1f});
  const LightSet set = place({point({0, 0, 0.5f}, 1)}, plate, 64, 12);
  ASSERT_EQ(set.lights[0].views.size(), 6u);
  EXPECT_FALSE(set.lights[0].views[5]);
  EXPECT_TRUE(set.lights[0].views[4]);
}

TEST(PlaceLights, KeepsLampsRelativeToTheCamera) {
  const glm::dvec3 far(1048576.0, 0, 0);
  const scene::Bounds bounds = bounds_of({1048575, -1, 0}, {1048577, 1, 2});
  const LightSet set =
      place({point({1048576.125f, 0.5f, 1}, 4)}, bounds, 64, 12, far + glm::dvec3(1, 0, 0));
  EXPECT_EQ(glm::vec3(set.lights[0].light.position), glm::vec3(-0.875f, 0.5f, 1));
  EXPECT_NEAR(set.lights[0].light.power.x, 4 / (4 * kPi), 1e-6);
}

TEST(PlaceLights, UsesThePointsOfTheSample) {
  scene::Light lamp = area({0, 0, 3}, {0, 0, -1}, 1, scene::AreaShape::kSquare, 2, 2);
  const LightSet set =
      place_lights({lamp}, true, {{0.25f, 0.5f, glm::vec2(0)}}, kRoom, {0, 0, 0}, 64, 12);
  const glm::vec3 expected = scene::sample_light(lamp, 0.25f, 0.5f, {}).position;
  EXPECT_LT(glm::length(glm::vec3(set.lights[0].light.position) - expected), 1e-6f);
  EXPECT_LT(glm::length(glm::vec3(set.lights[0].views[0]->origin) - expected), 1e-6f);
}

}  // namespace
}  // namespace panoptes::test
