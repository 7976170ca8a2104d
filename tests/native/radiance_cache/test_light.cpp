// What the radiance cache lights, against what is known of open floors and closed boxes.
#include "support.h"

#include <cmath>

namespace panoptes::test {
namespace {

using film::Pass;

engine::RenderRequest cached(const gpu_scene::Camera& camera, uint32_t samples = 1) {
  engine::RenderRequest r = request(camera, {Pass::kDiffDir, Pass::kDiffInd}, samples);
  r.cache.enabled = true;
  r.occlusion.strength = 0;
  return r;
}

double mean(const Picture& p, Pass pass) {
  double sum = 0;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) sum += p.value(pass, x, y, 1);
  return sum / (p.width * p.height);
}

TEST(CacheLight, AnOpenFloorSeesAllOfTheSky) {
  TestScene s;
  s.add_object(floor_at(0, 2), {s.add_material(lambert(glm::vec3(0.5f)))});
  s.world = constant_world(glm::vec3(0.75f));
  const Picture p = render(s, cached(orthographic({0, 0, 4}, {0, 0, 0}, 1.0, 16, 16)));
  EXPECT_NEAR(mean(p, Pass::kDiffDir), 0.75, 0.01);
  EXPECT_NEAR(mean(p, Pass::kDiffInd), 0, 0.002);
}

TEST(CacheLight, WallsTakeTheirShareOfTheSky) {
  // The middle of a floor between two walls as high as their distance sees sin(63.4 degrees) of what it
  // would see without: the cosine over a trench.
  TestScene s;
  const Id black = s.add_material(lambert(glm::vec3(0.01f)));
  s.add_object(quad({0, 0, 0}, {1, 0, 0}, {0, 20, 0}), {black});
  for (float side : {-1.0f, 1.0f})
    s.add_object(box({side * 1.1f, 0, 0.5f}, {0.1f, 20, 0.5f}), {black});
  s.world = constant_world(glm::vec3(1));
  engine::RenderRequest r = cached(orthographic({0, 0, 4}, {0, 0, 0}, 0.1, 8, 8));
  r.cache.resolution = 64;
  r.cache.cascades = 1;
  const Picture p = render(s, r);
  EXPECT_NEAR(mean(p, Pass::kDiffDir), 1 / std::sqrt(2.0), 0.1);
}

// In a closed box every bounce has on average the albedo of the one before.
TEST(CacheLight, BouncesInAClosedBoxAreAGeometricSeries) {
  constexpr double kAlbedo = 0.5;
  TestScene s;
  Geometry walls = box({0, 0, 0}, {1, 1, 1});
  s.add_object(walls, {s.add_material(lambert(glm::vec3(float(kAlbedo))))});
  scene::Light lamp;
  lamp.type = scene::LightType::kPoint;
  lamp.energy = 10;
  s.lights = {lamp};
  for (int bounces = 1; bounces <= 3; ++bounces) {
    // All of a wall, which is like every other: its mean is that over all.
    engine::RenderRequest r = cached(orthographic({0, 0, 0}, {0, 0.9, 0}, 0.97, 24, 24));
    r.cache.bounces = bounces;
    const Picture p = render(s, r);
    const double series = kAlbedo * (1 - std::pow(kAlbedo, bounces)) / (1 - kAlbedo);
    EXPECT_NEAR(mean(p, Pass::kDiffInd) / mean(p, Pass::kDiffDir), series, 0.1 * series) << bounces;
  }
}

}  // namespace
}  // namespace panoptes::test
