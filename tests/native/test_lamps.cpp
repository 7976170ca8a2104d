// Lamps without extent on white Lambert planes: the light that arrives, against Cycles' conventions
// in closed form. DiffDir is irradiance / pi.
#include "support.h"

#include <cmath>
#include <functional>

namespace panoptes::test {
namespace {

using film::Pass;

// Single precision along the way: positions, distances squared, a handful of products.
constexpr double kRounding = 1e-5;

// A white floor at z = 0 that every pixel shows. Lamps cast no shadow: that the floor does not
// shade itself is a law of its own (test_shadow_acne.cpp).
TestScene lit_floor(std::vector<scene::Light> lamps) {
  TestScene s;
  s.add_object(floor_at(0, 6), {s.add_material(lambert())});
  s.lights = std::move(lamps);
  for (scene::Light& lamp : s.lights) lamp.cast_shadow = false;
  return s;
}

const gpu_scene::Camera kOblique = perspective({0.4, -4, 3}, {0.2, 0, 0}, 0.55, 40, 32);
const gpu_scene::Camera kAbove = orthographic({0.3, 0.2, 5}, {0.3, 0.2, 0}, 1.5, 40, 32);

// Renders the floor from both cameras and compares each pixel's DiffDir with expected(position).
void expect_on_floor(const TestScene& s, const std::function<double(glm::dvec3)>& expected,
                     double tolerance = kRounding, double floor = 1e-6) {
  for (const gpu_scene::Camera& camera : {kOblique, kAbove}) {
    const Picture picture = render(s, request(camera, {Pass::kDiffDir}));
    Worst worst;
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x) {
        const glm::dvec3 p = on_plane(pixel_ray(camera, x, y), {0, 0, 0}, {0, 0, 1});
        worst.compare(picture.value(Pass::kDiffDir, x, y), expected(p), floor, x, y);
      }
    EXPECT_WORST_BELOW(worst, tolerance);
  }
}

TEST(Lamps, ASunGivesItsStrengthTimesTheCosine) {
  for (const glm::dvec3& direction :
       {glm::dvec3(0, 0, -1), glm::dvec3(0.3, 0.4, -1), glm::dvec3(-1, 0, -0.2)}) {
    const double cosine = -glm::normalize(direction).z;
    expect_on_floor(lit_floor({sun(glm::vec3(direction), 2.5f)}),
                    [&](glm::dvec3) { return 2.5 / kPi * cosine; });
  }
}

TEST(Lamps, ASunFromBelowGivesNothing) {
  expect_on_floor(
      lit_floor({sun({0.1f, 0, 1}, 2)}), [](glm::dvec3) { return 0.0; }, 0);
}

TEST(Lamps, ColoursMultiply) {
  scene::Light lamp = sun({0, 0, -1}, 2);
  lamp.color = {1, 0.5f, 0.125f};
  const Picture picture = render(lit_floor({lamp}), request(kAbove, {Pass::kDiffDir}));
  const glm::dvec3 c = picture.rgb(Pass::kDiffDir, 20, 16);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(c[i], 2 / kPi * lamp.color[i], 1e-5);
}

TEST(Lamps, APointFallsOffWithTheSquareOfTheDistance) {
  for (const glm::dvec3& lamp :
       {glm::dvec3(0, 0, 1), glm::dvec3(0.7, -0.4, 0.3), glm::dvec3(-1, 1, 20)})
    expect_on_floor(lit_floor({point(glm::vec3(lamp), 10)}), [&](const glm::dvec3& p) {
      const glm::dvec3 d = glm::dvec3(glm::vec3(lamp)) - p;
      const double squared = glm::dot(d, d);
      return 10 / (4 * kPi * kPi * squared) * d.z / std::sqrt(squared);
    });
}

TEST(Lamps, APointBelowTheFloorGivesNothing) {
  expect_on_floor(
      lit_floor({point({0, 0, -1}, 10)}), [](glm::dvec3) { return 0.0; }, 0);
}

double smoothstep(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

TEST(Lamps, ASpotHasCyclesProfile) {
  const glm::dvec3 lamp(0.25, 0.5, 2), axis = glm::normalize(glm::dvec3(0.2, -0.3, -1));
  for (const auto& [size, blend] :
       {std::pair(0.9, 0.25), {0.9, 1.0}, {2.0, 0.5}, {3.0, 0.15}, {kPi, 1.0}}) {
    const double outer = std::cos(0.5 * float(size)), width = (1 - outer) * blend;
    expect_on_floor(
        lit_floor({spot(glm::vec3(lamp), glm::vec3(axis), 20, float(size), float(blend))}),
        [&, outer = outer, width = width](const glm::dvec3& p) {
          const glm::dvec3 d = lamp - p;
          const double squared = glm::dot(d, d), cosine = -glm::dot(d, axis) / std::sqrt(squared);
          return 20 / (4 * kPi * kPi * squared) * d.z / std::sqrt(squared) *
                 (cosine <= outer ? 0 : cosine * smoothstep((cosine - outer) / width));
        },
        // The profile divides a difference of cosines, good to 1e-7, by the blend's width, .025 at
        // least here, and its slope is 1.5 at most: 6e-6 of the brightest value, which is .1.
        2e-5, 0.1);
  }
}

TEST(Lamps, ASpotWithoutBlendHasAHardEdge) {
  const glm::dvec3 lamp(0, 0, 2);
  const TestScene s = lit_floor({spot(glm::vec3(lamp), {0, 0, -1}, 20, 0.8f, 0)});
  const Picture picture = render(s, request(kAbove, {Pass::kDiffDir}));
  int inside = 0, outside = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const glm::dvec3 p = on_plane(pixel_ray(kAbove, x, y), {0, 0, 0}, {0, 0, 1});
      const double r = std::hypot(p.x, p.y), edge = 2 * std::tan(0.4);
      if (std::abs(r - edge) < 1e-4) continue;  // on the edge itself
      const double squared = r * r + 4;
      // The lamp looks straight down: the cosines at the floor and at the lamp are the same.
      const double full = 20 / (4 * kPi * kPi * squared) * 4 / squared;
      const double value = picture.value(Pass::kDiffDir, x, y);
      EXPECT_NEAR(value, r < edge ? full : 0.0, kRounding * full) << x << " " << y;
      ++(r < edge ? inside : outside);
    }
  EXPECT_GT(inside, 50);
  EXPECT_GT(outside, 50);
}

TEST(Lamps, AnAreaLampIsOneSidedAndLambertian) {
  // Tiny, so that its centre stands for all of it: far field P / (4 d^2) cos cos, over pi.
  const glm::dvec3 lamp(0.3, 0.2, 1.5), axis = glm::normalize(glm::dvec3(0.8, -0.1, -1));
  expect_on_floor(
      lit_floor(
          {area(glm::vec3(lamp), glm::vec3(axis), 30, scene::AreaShape::kDisk, 1e-3f, 1e-3f)}),
      [&](const glm::dvec3& p) {
        const glm::dvec3 d = lamp - p;
        const double squared = glm::dot(d, d), distance = std::sqrt(squared);
        const double cosine = std::max(-glm::dot(d, axis) / distance, 0.0);
        return 30 / (4 * kPi * squared) * cosine * d.z / distance;
      },
      // The cosine at the lamp falls to 0 inside the picture: absolute there.
      kRounding, 0.02);
}

TEST(Lamps, SpreadNarrowsAnAreaLamp) {
  const glm::dvec3 lamp(0.3, 0.2, 2);
  for (const float spread : {0.5f, 1.5707963f, 2.5f}) {
    scene::Light light =
        area(glm::vec3(lamp), {0, 0, -1}, 30, scene::AreaShape::kDisk, 1e-3f, 1e-3f);
    light.spread = spread;
    const double half = 0.5 * spread;
    expect_on_floor(
        lit_floor({light}),
        [&](const glm::dvec3& p) {
          const glm::dvec3 d = lamp - p;
          const double squared = glm::dot(d, d), cosine = d.z / std::sqrt(squared);
          const double t = std::acos(std::min(cosine, 1.0));
          return 30 / (4 * kPi * squared) * cosine * cosine *
                 std::max(std::tan(half) - std::tan(t), 0.0) / (std::tan(half) - half);
        },
        // The tangent comes from the cosine: next to the axis a rounding of 1e-7 there is up
        // to 5e-5 of the narrowest cone's tangent, .25.
        2e-4, 0.02);
  }
}

TEST(Lamps, ANegativeLampTakesLightAway) {
  expect_on_floor(lit_floor({sun({0, 0, -1}, 3), sun({0, 0, -1}, -1)}),
                  [](glm::dvec3) { return 2 / kPi; });
}

TEST(Lamps, AddUp) {
  // 40 lamps of all kinds whose maps need several batches: the sum of the single renders.
  std::vector<scene::Light> lamps;
  for (int i = 0; i < 40; ++i) {
    const float a = 0.7f * float(i), r = 0.2f + 0.05f * float(i);
    const glm::vec3 place(r * std::cos(a), r * std::sin(a), 1.5f + 0.02f * float(i));
    const glm::vec3 down(-0.3f * place.x, 0.2f, -1);
    lamps.push_back(i % 5 == 0   ? point(place, 3 + float(i))
                    : i % 5 == 1 ? area(place, down, 5, scene::AreaShape::kSquare, 0.1f, 0.1f)
                    : i % 5 == 2 ? spot(place, down, 9, 1.2f, 0.5f)
                                 : sun(down, 0.1f));
  }
  TestScene s;
  const Id white = s.add_material(lambert());
  s.add_object(floor_at(0, 6), {white});
  s.add_object(box({0, 0, 0.4f}, {0.3f, 0.2f, 0.2f}), {white});
  engine::RenderRequest r = request(kAbove, {Pass::kDiffDir});
  // 16 MiB a map: 32 of them make a batch, and these lamps need 8 * 12 + 24 maps.
  r.shadow_resolution = 2048;
  s.lights = lamps;
  const Picture all = render(s, r);
  std::vector<double> sum(all[Pass::kDiffDir].size(), 0);
  for (const scene::Light& lamp : lamps) {
    s.lights = {lamp};
    const std::vector<float> one = render(s, r)[Pass::kDiffDir];
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += one[i];
  }
  Worst worst;
  for (size_t i = 0; i < sum.size(); ++i)
    worst.compare(all[Pass::kDiffDir][i], sum[i], 1e-3, int(i / 3 % 40), int(i / 120));
  EXPECT_WORST_BELOW(worst, kRounding);
}

}  // namespace
}  // namespace panoptes::test
