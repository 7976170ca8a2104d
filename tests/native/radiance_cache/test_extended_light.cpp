// Light of lamps and glowing surfaces that have a size, bounced by the cache: whatever points of them a
// picture's samples take, it is about that of all of them.
#include "support.h"

#include <algorithm>
#include <cmath>

namespace panoptes::test {
namespace {

using film::Pass;

constexpr int kSide = 16;

// A room of four by four by three metres with a table in it, lit by `light`.
TestScene room(const std::function<void(TestScene&)>& light) {
  TestScene s;
  const Id grey = s.add_material(lambert(glm::vec3(0.6f)));
  s.add_object(quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}), {grey});
  s.add_object(quad({0, 0, 3}, {2, 0, 0}, {0, 2, 0}), {grey});
  s.add_object(quad({-2, 0, 1.5f}, {0, 2, 0}, {0, 0, 1.5f}), {s.add_material(lambert({0.8f, 0.2f, 0.2f}))});
  s.add_object(quad({2, 0, 1.5f}, {0, 2, 0}, {0, 0, 1.5f}), {s.add_material(lambert({0.2f, 0.8f, 0.2f}))});
  s.add_object(quad({0, 2, 1.5f}, {2, 0, 0}, {0, 0, 1.5f}), {grey});
  s.add_object(box({0.3f, 0.4f, 0.7f}, {0.8f, 0.5f, 0.05f}), {grey});
  light(s);
  return s;
}

TestScene lit_by_window() {
  return room([](TestScene& s) {
    s.lights = {area({-1.9f, 0.3f, 1.6f}, {1, 0, 0}, 60, scene::AreaShape::kRectangle, 1.4f, 2)};
  });
}

TestScene lit_by_tube() {
  return room([](TestScene& s) {
    s.add_object(box({0, 0.5f, 2.8f}, {1.6f, 0.05f, 0.05f}), {s.add_material(emitter(glm::vec3(12)))});
  });
}

TestScene lit_by_wall() {
  return room([](TestScene& s) {
    s.add_object(quad({0, 1.95f, 1.5f}, {1.5f, 0, 0}, {0, 0, 1}), {s.add_material(emitter(glm::vec3(2)))});
  });
}

engine::RenderRequest look(uint32_t samples, uint32_t seed) {
  engine::RenderRequest r = request(perspective({0, -5, 1.5}, {0, 0, 1.5}, 0.7, kSide, kSide), {Pass::kDiffInd}, samples);
  r.seed = seed;
  return r;
}

struct Off {
  double mean = 0, rmse = 0;  // beside the reference, of squares of four pixels
};

Off off(const Picture& found, const Picture& reference) {
  double mean = 0, wrong = 0, sum = 0;
  for (int y = 0; y < kSide; y += 4)
    for (int x = 0; x < kSide; x += 4)
      for (int c = 0; c < 3; ++c) {
        double a = 0, b = 0;
        for (int i = 0; i < 16; ++i) {
          a += found.value(Pass::kDiffInd, x + i % 4, y + i / 4, c) / 16;
          b += reference.value(Pass::kDiffInd, x + i % 4, y + i / 4, c) / 16;
        }
        mean += a, sum += b, wrong += (a - b) * (a - b);
      }
  const double squares = kSide * kSide / 16 * 3;
  return {mean / sum - 1, std::sqrt(wrong / squares) / (sum / squares)};
}

// The largest errors of pictures of so many samples, by whichever points.
Off largest(const TestScene& s, uint32_t samples) {
  engine::RenderRequest r = look(128, 99);
  r.method = engine::Method::kPrimitive;
  r.paths.bounces.total = 2;
  const Picture paths = render(s, r);
  Off most;
  for (uint32_t seed : {0u, 3u, 5u}) {
    r = look(samples, seed);
    r.cache.enabled = true;
    r.cache.bounces = 2;
    const Off o = off(render(s, r), paths);
    most = {std::max(most.mean, std::abs(o.mean)), std::max(most.rmse, o.rmse)};
  }
  return most;
}

TEST(ExtendedLight, OfAnAreaLamp) {
  const Off o = largest(lit_by_window(), 16);
  EXPECT_LT(o.mean, 0.04);
  EXPECT_LT(o.rmse, 0.06);
}

TEST(ExtendedLight, OfAGlowingTubeUnderACeiling) {
  const Off o = largest(lit_by_tube(), 16);
  EXPECT_LT(o.mean, 0.1);
  EXPECT_LT(o.rmse, 0.14);
}

TEST(ExtendedLight, OfAGlowingWall) {
  const Off o = largest(lit_by_wall(), 16);
  EXPECT_LT(o.mean, 0.04);
  EXPECT_LT(o.rmse, 0.09);
}

TEST(ExtendedLight, IsTheSameInEveryRangeOfSamples) {
  const TestScene s = lit_by_window();
  engine::RenderRequest r = look(2, 0);
  r.cache.enabled = true;
  r.pieces = true;
  r.passes.set(size_t(Pass::kCombined));  // it alone is a mean over samples
  const Picture whole = render(s, r);
  r.last_sample = 1;
  const Picture first = render(s, r);
  r.first_sample = 1, r.last_sample = 2;
  const Picture second = render(s, r);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      EXPECT_NEAR(whole.value(Pass::kCombined, x, y, 1),
                  0.5 * (first.value(Pass::kCombined, x, y, 1) + second.value(Pass::kCombined, x, y, 1)),
                  1e-5 * whole.value(Pass::kCombined, x, y, 1));
}

}  // namespace
}  // namespace panoptes::test
