// What the radiance cache keeps from frame to frame of a 3D View.
#include "support.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace panoptes::test {
namespace {

using film::Pass;

class CacheFrames : public ::testing::Test {
 protected:
  CacheFrames() {
    const Id white = scene.add_material(lambert(glm::vec3(0.7f)));
    scene.add_object(box({0, 0, 1}, {2, 2, 1}), {white});
    scene.add_object(box({0, 0, 0}, {0.3f, 0.3f, 0.3f}), {white}, glm::translate(glm::mat4(1), {0.6f, 0.2f, 0.3f}));
    scene.lights = {point({-1, -0.5f, 1.5f}, 50)};
    look(0);
  }

  void look(double turn) {
    const glm::dvec3 eye(-1.5, -1.5, 1.2);
    r = request(perspective(eye, eye + glm::dvec3(std::cos(0.8 + turn), std::sin(0.8 + turn), -0.4), 1.0, 32, 32),
                {Pass::kDiffInd}, 2);
    r.cache.enabled = true;
    r.viewport = true;
  }
  Picture fresh() {
    engine::RenderRequest alone = r;
    alone.viewport = false;
    alone.cache.occupancy = radiance_cache::Occupancy::kGeometry;  // as in frames that follow each other
    return render(scene, alone);
  }
  template <class F>
  Picture follow(F&& edit) {
    shared_engine().edit(edit);
    return render(r);
  }
  static bool ran(const Picture& p, const std::string& pass) {
    return std::any_of(p.stats.passes.begin(), p.stats.passes.end(), [&](const auto& time) { return time.first == pass; });
  }
  static double mean(const Picture& p) {
    double sum = 0;
    for (float v : p[Pass::kDiffInd]) sum += v;
    return sum / double(p[Pass::kDiffInd].size());
  }
  // The largest difference of a pixel, relative to the mean.
  static double apart(const Picture& a, const Picture& b) {
    double most = 0;
    for (size_t i = 0; i < a[Pass::kDiffInd].size(); ++i)
      most = std::max(most, double(std::abs(a[Pass::kDiffInd][i] - b[Pass::kDiffInd][i])));
    return most / mean(b);
  }

  TestScene scene;
  engine::RenderRequest r;
};

TEST_F(CacheFrames, NothingIsGatheredWhileNothingChanges) {
  const Picture first = render(scene, r);
  EXPECT_TRUE(ran(first, "radiance_cache_march"));
  const Picture second = follow([](scene::Scene&) {});
  for (const char* pass : {"radiance_cache_march", "radiance_cache_gather", "cache_first_bounce", "cache_bounces",
                           "radiance_cache_voxels", "radiance_cache_surfels"})
    EXPECT_FALSE(ran(second, pass)) << pass;
  EXPECT_EQ(first[Pass::kDiffInd], second[Pass::kDiffInd]);
}

TEST_F(CacheFrames, ATurnedViewKeepsTheLight) {
  render(scene, r);
  look(0.1);
  const Picture turned = follow([](scene::Scene&) {});
  EXPECT_FALSE(ran(turned, "radiance_cache_gather"));
  EXPECT_LT(apart(turned, fresh()), 1e-3);
}

TEST_F(CacheFrames, AnotherLightShowsAtOnce) {
  render(scene, r);
  scene.lights[0].energy *= 2;
  const Picture brighter = follow([&](scene::Scene& s) { s.set_lights(scene.lights); });
  EXPECT_TRUE(ran(brighter, "radiance_cache_blend"));
  EXPECT_LT(apart(brighter, fresh()), 1e-4);
}

TEST_F(CacheFrames, FlickerIsHeldBackUntilTheViewRests) {
  constexpr float kFlicker = 0.02f;
  const double before = mean(render(scene, r));
  scene.lights[0].energy *= 1 + kFlicker;
  // Of two samples the first keeps its share of the light before.
  const double shown = mean(follow([&](scene::Scene& s) { s.set_lights(scene.lights); }));
  const double all = mean(fresh());
  EXPECT_NEAR((shown - before) / (all - before), 1 - r.cache.blend / 2, 0.02);
  // At rest the next frame is whole.
  render(scene, r);
  EXPECT_NEAR(mean(follow([](scene::Scene&) {})), all, 1e-4 * all);
}

TEST_F(CacheFrames, FinalPicturesKeepNothing) {
  r.viewport = false;
  const Picture first = render(scene, r);
  scene.lights[0].energy *= 1.02f;
  const Picture second = follow([&](scene::Scene& s) { s.set_lights(scene.lights); });
  EXPECT_FALSE(ran(second, "radiance_cache_blend"));
  EXPECT_NEAR(mean(second) / mean(first), 1.02, 1e-3);
}

TEST_F(CacheFrames, AVolumeThatLagsBehindCatchesUp) {
  r.cache.rebuild_every = 4;
  r.last_sample = 8;
  const Picture before = render(scene, r);
  scene.instances[1].object_to_world = glm::translate(glm::mat4(1), {0.6f, -1.2f, 0.3f});
  const Picture moved = follow([&](scene::Scene& s) { s.set_instances(scene.instances, scene.table); });
  EXPECT_TRUE(ran(moved, "radiance_cache_voxels"));
  const Picture whole = fresh();
  EXPECT_GT(apart(before, whole), 0.2);
  // No more than the first of eight samples was behind.
  EXPECT_LT(apart(moved, whole), apart(before, whole) / 8 + 0.01);
}

TEST_F(CacheFrames, WhatReachesVoxelsFollowsAWallThatMoves) {
  const Id white = scene.add_material(lambert(glm::vec3(0.7f)));
  scene.add_object(box({0, 0, 0}, {0.02f, 1.4f, 0.7f}), {white}, glm::translate(glm::mat4(1), {-0.5f, 0, 0.9f}));
  r.cache.blend = 0;
  Picture shown = render(scene, r);
  for (float x : {-0.1f, 0.35f, -0.5f}) {
    const Picture before = shown;
    scene.instances[2].object_to_world = glm::translate(glm::mat4(1), {x, 0, 0.9f});
    shown = follow([&](scene::Scene& s) { s.set_instances(scene.instances, scene.table); });
    EXPECT_GT(apart(before, shown), 0.1) << x;
    EXPECT_LT(apart(shown, fresh()), 1e-4) << x;
  }
}

}  // namespace
}  // namespace panoptes::test
