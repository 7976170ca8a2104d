// Light in small parts of large scenes: volumes that are chosen by what the camera sees, against paths.
#include "support.h"

#include <cmath>

namespace panoptes::test {
namespace {

using film::Pass;

constexpr int kWidth = 32, kHeight = 24;

// Two coloured walls and a white block of two metres on a plane of four hundred.
TestScene stall() {
  TestScene s;
  const Id grey = s.add_material(lambert(glm::vec3(0.5f)));
  s.add_object(floor_at(0, 200), {grey});
  s.add_object(box({-1.1f, 0, 0.8f}, {0.1f, 1.2f, 0.8f}), {s.add_material(lambert({0.8f, 0.1f, 0.1f}))});
  s.add_object(box({0, 1.1f, 0.8f}, {1.2f, 0.1f, 0.8f}), {s.add_material(lambert({0.1f, 0.7f, 0.1f}))});
  s.add_object(box({0.1f, 0, 0.3f}, {0.3f, 0.3f, 0.3f}), {s.add_material(lambert(glm::vec3(0.8f)))});
  s.lights = {sun({-0.5f, 0.6f, -1}, 3)};
  return s;
}

// Relative RMSE of indirect light, of squares of four pixels a side: paths are noisy.
double error(const Picture& found, const Picture& reference) {
  double sum = 0, mean = 0;
  for (int y = 0; y < kHeight; y += 4)
    for (int x = 0; x < kWidth; x += 4)
      for (int c = 0; c < 3; ++c) {
        double off = 0;
        for (int i = 0; i < 16; ++i) {
          const int px = x + i % 4, py = y + i / 4;
          off += found.value(Pass::kDiffInd, px, py, c) - reference.value(Pass::kDiffInd, px, py, c);
          mean += reference.value(Pass::kDiffInd, px, py, c) / 16;
        }
        sum += off * off / 256;
      }
  const double squares = kWidth * kHeight / 16 * 3;
  return std::sqrt(sum / squares) / (mean / squares);
}

struct Errors {
  double chosen, single;
};

Errors errors(const TestScene& s, const gpu_scene::Camera& camera) {
  engine::RenderRequest r = request(camera, {Pass::kDiffInd}, 1);
  r.method = engine::Method::kPrimitive;
  r.last_sample = 128;
  r.paths.bounces.total = 2;
  const Picture paths = render(s, r);
  r = request(camera, {Pass::kDiffInd}, 2);
  r.cache.enabled = true;
  r.cache.bounces = 2;
  const double chosen = error(render(s, r), paths);
  r.cache.cascades = 1;
  return {chosen, error(render(s, r), paths)};
}

TEST(CascadedLight, WhatIsSmallInALargeSceneHasCellsOfItsOwn) {
  const Errors e = errors(stall(), perspective({3, -4, 2.5}, {0, 0, 0.5}, 0.7, kWidth, kHeight));
  EXPECT_LT(e.chosen, 0.35);
  EXPECT_LT(e.chosen, 0.5 * e.single);
}

TEST(CascadedLight, SoItHasThroughALongLens) {
  const Errors e = errors(stall(), perspective({60, -80, 50}, {0, 0, 0.5}, 0.04, kWidth, kHeight));
  EXPECT_LT(e.chosen, 0.55);
  EXPECT_LT(e.chosen, 0.5 * e.single);
}

TEST(CascadedLight, AndWithoutPerspective) {
  const Errors e = errors(stall(), orthographic({60, -80, 50}, {0, 0, 0.5}, 2, kWidth, kHeight));
  EXPECT_LT(e.chosen, 0.55);
  EXPECT_LT(e.chosen, 0.5 * e.single);
}

}  // namespace
}  // namespace panoptes::test
