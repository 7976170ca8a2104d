// What settings do to ambient occlusion in pictures, and what must not matter.
#include "occlusion_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace panoptes::test {
namespace {

using ambient_occlusion::Filter;
using film::Pass;

constexpr int kSize = 32;

TEST(OcclusionSettings, WithoutStrengthThePictureIsAsWithout) {
  const gpu_scene::Camera camera = perspective({4, -1, 2.5}, {0.3, 0, 0.3}, 0.5, kSize, kSize);
  TestScene s = corner();
  s.world = world("vec3 evaluate_world(vec3 d) { return d * 0.5 + 0.5; }\n");
  s.lights = {point({3, 0, 3}, 10)};
  engine::RenderRequest r = occluded(camera, 1, 2);
  r.occlusion.strength = 0;
  r.occlusion.secondary_views = 2;
  const Picture with = render(s, r);
  EXPECT_TRUE(effect_of(with, "ambient_occlusion").runs);
  r.passes.reset(size_t(Pass::kAo));
  const Picture without = render(s, r);
  EXPECT_FALSE(effect_of(without, "ambient_occlusion").runs);
  EXPECT_TRUE(with[Pass::kCombined] == without[Pass::kCombined]);
  r.occlusion.strength = 1;
  EXPECT_GT(rmse(render(s, r)[Pass::kCombined], without[Pass::kCombined]), 0.02);
}

TEST(OcclusionSettings, LampsCountAlikeInAnyOrder) {
  const gpu_scene::Camera camera = perspective({0.7, 0, 3}, {0.7, 0, 0}, 0.4, kSize, kSize);
  TestScene s = corner();
  s.lights = {sun({-1, 0.25f, -1}, 1), point({3, 0, 3}, 10),
              spot({3, 1, 3}, {-1, 0, -1}, 10, 1.2f, 0), point({1, 0, 4}, 10)};
  for (Estimator estimator : kEstimators) {
    engine::RenderRequest r = occluded(camera, 1);
    r.occlusion.estimator = estimator;
    r.occlusion.secondary_views = 3;
    std::vector<float> first;
    for (const auto& order : {std::array{0, 1, 2, 3}, {3, 2, 1, 0}, {1, 3, 0, 2}}) {
      TestScene shuffled = s;
      for (size_t i = 0; i < order.size(); ++i) shuffled.lights[i] = s.lights[size_t(order[i])];
      const std::vector<float> found = render(shuffled, r)[Pass::kAo];
      if (first.empty()) first = found;
      double worst = 0;
      for (size_t i = 0; i < found.size(); ++i)
        worst = std::max<double>(worst, std::abs(found[i] - first[i]));
      EXPECT_LE(worst, 1e-3) << int(estimator);
    }
  }
}

TEST(OcclusionSettings, NoMoreViewsAreTakenThanAllowed) {
  const gpu_scene::Camera camera = perspective({0.7, 0, 3}, {0.7, 0, 0}, 0.4, kSize, kSize);
  TestScene s = corner();
  for (int i = 0; i < 10; ++i)
    s.lights.push_back(point({1 + 0.25f * i, -2 + 0.5f * i, 2 + 0.125f * i}, 10));
  for (int most = 0; most <= ambient_occlusion::kMostSecondaryViews; most += 2) {
    engine::RenderRequest r = occluded(camera, 1);
    r.occlusion.secondary_views = most;
    const plan::Effect lamps = effect_of(render(s, r), "occlusion_lamp_views");
    EXPECT_EQ(lamps.runs, most > 0);
    if (most > 0) {
      EXPECT_LE(std::stoi(lamps.reason), most) << lamps.reason;
    }
    if (most > 0 && most <= 4) {
      EXPECT_EQ(std::stoi(lamps.reason), most) << "there are as many worth it";
    }
  }
}

TEST(OcclusionSettings, ImportanceSamplingKeepsTheMean) {
  const gpu_scene::Camera camera = perspective({4, -1, 2.5}, {0.3, 0, 0.3}, 0.5, kSize, kSize);
  TestScene s = corner();
  s.lights = {sun({-1, 0.25f, -1}, 1)};
  for (Estimator estimator : {Estimator::kAlchemy, Estimator::kSsao}) {
    engine::RenderRequest r = occluded(camera, 1, 32);
    r.occlusion.estimator = estimator;
    r.occlusion.secondary_views = 1;
    std::vector<float> found[2];
    for (int with : {0, 1}) {
      r.occlusion.importance_sampling = with == 1;
      found[with] = render(s, r)[Pass::kAo];
    }
    // Views of which few samples are taken weigh as much as with many, so what bias there is comes
    // of weights and estimates of the same few samples.
    EXPECT_NEAR(mean(found[1]), mean(found[0]), 1e-3) << int(estimator);
  }
}

TEST(OcclusionSettings, TheFilterSmoothsAreasAndKeepsEdges) {
  // A shelf over a floor, seen from above; the floor beside it is occluded, the shelf is not.
  TestScene s;
  const Id white = s.add_material(lambert());
  s.add_object(floor_at(0, 8), {white});
  s.add_object(box({0, 0, 0.5f}, glm::vec3(0.5f)), {white});
  const gpu_scene::Camera camera = perspective({0.3, -0.2, 5}, {0, 0, 0}, 0.35, kSize, kSize);
  engine::RenderRequest r = occluded(camera, 1);
  r.passes.set(size_t(Pass::kDepth));
  r.occlusion.estimator = Estimator::kSsao;
  const Picture rough = render(s, r);
  r.occlusion.filter = Filter::kOn;
  const Picture smooth = render(s, r);
  const Picture exact = render(s, traced(r, 64));
  Worst top;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      if (smooth.value(Pass::kDepth, x, y) < 4.01)
        top.compare(smooth.value(Pass::kAo, x, y), 1, 1, x, y);
  EXPECT_GT(top.count(), 50);
  EXPECT_WORST_BELOW(top, 1e-3);
  EXPECT_LT(rmse(smooth[Pass::kAo], exact[Pass::kAo]),
            0.6 * rmse(rough[Pass::kAo], exact[Pass::kAo]));
  EXPECT_NEAR(mean(smooth[Pass::kAo]), mean(rough[Pass::kAo]), 0.003);
}

TEST(OcclusionSettings, DeepShadowsDarkenWhereLampsAreBlocked) {
  // A card in the sun, so high over the floor that it occludes nothing.
  TestScene s;
  const Id white = s.add_material(lambert());
  s.add_object(floor_at(0, 4), {white});
  s.add_object(floor_at(2, 0.5f), {white});
  s.world = constant_world(glm::vec3(1));
  s.lights = {sun({0, 0, -1}, 1e-6f)};
  const gpu_scene::Camera camera = perspective({0, -3, 1.5}, {0, 0, 0}, 0.9, kSize, kSize);
  engine::RenderRequest r = occluded(camera, 0.25f);
  const Picture without = render(s, r);
  EXPECT_FALSE(effect_of(without, "deep_shadows").runs);
  r.occlusion.deep_shadows = 1;
  const Picture with = render(s, r);
  EXPECT_TRUE(effect_of(with, "deep_shadows").runs);
  EXPECT_TRUE(with[Pass::kAo] == without[Pass::kAo]) << "the AO pass is physics";
  Worst lit, blocked;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const glm::dvec3 p = on_plane(pixel_ray(camera, x, y), {0, 0, 0}, {0, 0, 1});
      const double from_edge = std::max(std::abs(p.x), std::abs(p.y)) - 0.5;
      if (from_edge > 0.3)
        lit.compare(with.value(Pass::kCombined, x, y), without.value(Pass::kCombined, x, y), 1, x,
                    y);
      if (from_edge < -0.3) blocked.compare(with.value(Pass::kCombined, x, y), 0, 1, x, y);
    }
  EXPECT_GT(lit.count(), 100);
  EXPECT_GT(blocked.count(), 5);
  EXPECT_WORST_BELOW(lit, 0.0);
  EXPECT_WORST_BELOW(blocked, 0.02);
}

}  // namespace
}  // namespace panoptes::test
