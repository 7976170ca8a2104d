// Lamps with an extent, over many samples: irradiance against closed forms and quadrature.
#include "support.h"

#include <cmath>
#include <functional>

namespace panoptes::test {
namespace {

using film::Pass;
using scene::AreaShape;

constexpr uint32_t kSamples = 256;
// A point set of n stratified points integrates smooth functions with an error of about
// (variation) * log(n) / n: 2 % of the variation at 256. The form factors below vary by less than
// half over the lamp, so 1 % is a bound with room for every seed.
constexpr double kMonteCarlo = 0.01;

const gpu_scene::Camera kAbove = orthographic({0, 0, 9}, {0, 0, 0}, 1.0, 12, 12);

TestScene lit_floor(const scene::Light& lamp) {
  TestScene s;
  s.add_object(floor_at(0, 3), {s.add_material(lambert())});
  s.lights = {lamp};
  return s;
}

engine::RenderRequest many(uint32_t samples = kSamples) {
  engine::RenderRequest r = request(kAbove, {Pass::kDiffDir}, samples);
  r.filter_width = 0.01f;  // so that each pixel is its centre
  r.shadow_resolution = 64;
  return r;
}

void expect_on_floor(const scene::Light& lamp, const std::function<double(glm::dvec3)>& expected,
                     double tolerance = kMonteCarlo) {
  test::expect_on_floor(render(lit_floor(lamp), many()), kAbove, expected, tolerance);
}

// Irradiance / pi from a plane lamp of radiance P / (4 A) by 64 x 64 points of its shape.
double from_area(const scene::Light& lamp, double a, const glm::dvec3& p) {
  const bool disk = lamp.shape == AreaShape::kDisk || lamp.shape == AreaShape::kEllipse;
  const glm::dmat4 m(lamp.object_to_world);
  const glm::dvec3 axis = -glm::normalize(glm::dvec3(m[2]));
  const int n = 64;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double u = (i + 0.5) / n, v = (j + 0.5) / n;
      const glm::dvec2 q =
          disk ? 0.5 * std::sqrt(u) * glm::dvec2(std::cos(2 * kPi * v), std::sin(2 * kPi * v))
               : glm::dvec2(u - 0.5, v - 0.5);
      const bool same = lamp.shape == AreaShape::kSquare || lamp.shape == AreaShape::kDisk;
      const double size_y = same ? lamp.size_x : lamp.size_y;
      const glm::dvec3 at = glm::dvec3(m * glm::dvec4(q.x * lamp.size_x, q.y * size_y, 0, 1));
      const glm::dvec3 d = at - p;
      const double squared = glm::dot(d, d), distance = std::sqrt(squared);
      sum += std::max(-glm::dot(d, axis) / distance, 0.0) * std::max(d.z / distance, 0.0) / squared;
    }
  const double radiance = lamp.energy / (4 * a);
  return radiance * a * sum / (n * n) / kPi;
}

TEST(SoftLamps, AreasGiveRadianceTimesTheFormFactor) {
  struct Case {
    AreaShape shape;
    float x, y;
    double area;
  };
  for (const Case& c :
       {Case{AreaShape::kSquare, 1, 7, 1}, Case{AreaShape::kRectangle, 1, 0.4f, 0.4},
        Case{AreaShape::kDisk, 1, 7, kPi / 4}, Case{AreaShape::kEllipse, 1, 0.4f, kPi / 10}}) {
    const scene::Light lamp = area({0.2f, 0.1f, 1.5f}, {0.3f, 0.1f, -1}, 20, c.shape, c.x, c.y);
    expect_on_floor(lamp, [&](const glm::dvec3& p) { return from_area(lamp, c.area, p); });
  }
}

TEST(SoftLamps, AScaledAreaKeepsItsPower) {
  scene::Light lamp = area({0.2f, 0.1f, 1.5f}, {0, 0, -1}, 20, AreaShape::kSquare, 0.5f, 1);
  lamp.object_to_world[0] *= 2.0f;  // 1 m x .5 m
  expect_on_floor(lamp, [&](const glm::dvec3& p) { return from_area(lamp, 0.5, p); });
}

TEST(SoftLamps, ADiskAboveGivesTheClosedForm) {
  // Measured in Cycles: a disk of 1 m at 1 m gives L sin^2 = .0636627 a watt.
  const Picture picture =
      render(lit_floor(area({0, 0, 1}, {0, 0, -1}, 1, AreaShape::kDisk, 1, 1)), [] {
        engine::RenderRequest r = many();
        r.camera = orthographic({0, 0, 9}, {0, 0, 0}, 1e-3, 4, 4);
        return r;
      }());
  EXPECT_NEAR(mean(picture[Pass::kDiffDir]), 0.0636627, kMonteCarlo * 0.0636627);
}

TEST(SoftLamps, ASunWithAnAngleIsADisk) {
  // Axial: 2 (sqrt(1 + R^2) - 1) / R^2 of a sharp sun, R = tan(angle / 2).
  for (float angle : {0.2f, 1.0f}) {
    scene::Light lamp = sun({0, 0, -1}, 3);
    lamp.angle = angle;
    const double r2 = std::pow(std::tan(0.5 * angle), 2);
    expect_on_floor(
        lamp, [&](glm::dvec3) { return 3 / kPi * 2 * (std::sqrt(1 + r2) - 1) / r2; }, 2e-3);
  }
}

TEST(SoftLamps, APointWithARadiusIsADiskThatFacesTheSurface) {
  // Measured in Cycles, below the lamp: P / (4 pi) / (d^2 + r^2).
  for (float radius : {0.1f, 0.3f, 0.8f}) {
    engine::RenderRequest r = many();
    r.camera = orthographic({0, 0, 9}, {0, 0, 0}, 1e-3, 4, 4);
    const double expected = 10 / (4 * kPi) / (1 + radius * radius) / kPi;
    const Picture picture = render(lit_floor(point({0, 0, 1}, 10, radius)), r);
    EXPECT_NEAR(mean(picture[Pass::kDiffDir]), expected, kMonteCarlo * expected) << radius;
    scene::Light lamp = spot({0, 0, 1}, {0, 0, -1}, 10, 3.0f, 0);
    lamp.radius = radius;
    const Picture cone = render(lit_floor(lamp), r);
    EXPECT_NEAR(mean(cone[Pass::kDiffDir]), expected, kMonteCarlo * expected) << radius;
  }
}

TEST(SoftLamps, OneSampleShowsTheCentreOfTheLamp) {
  // A single sample of a small lamp is as bright as all of it.
  for (const scene::Light& lamp : {point({0, 0, 1}, 10, 0.05f),
                                   area({0, 0, 1}, {0, 0, -1}, 10, AreaShape::kDisk, 0.1f, 0.1f)}) {
    const double one = mean(render(lit_floor(lamp), many(1))[Pass::kDiffDir]);
    const double all = mean(render(lit_floor(lamp), many())[Pass::kDiffDir]);
    EXPECT_NEAR(one, all, 0.01 * all);
  }
}

// The share of a lamp that a point of the floor sees past a blocker at z = .5: |x|, |y| < .3.
double visible_share(const scene::Light& lamp, const glm::dvec3& p, bool disk) {
  const int n = 128;
  int seen = 0, all = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const glm::dvec2 q((i + 0.5) / n - 0.5, (j + 0.5) / n - 0.5);
      if (disk && glm::length(q) > 0.5) continue;
      const glm::dvec3 at = glm::dvec3(glm::dmat4(lamp.object_to_world) *
                                       glm::dvec4(q.x * lamp.size_x, q.y * lamp.size_x, 0, 1));
      const glm::dvec3 crossing = p + (at - p) * (0.5 / at.z);
      ++all;
      seen += std::abs(crossing.x) > 0.3 || std::abs(crossing.y) > 0.3;
    }
  return double(seen) / all;
}

TEST(SoftLamps, PenumbraeAreTheShareOfTheLampThatIsSeen) {
  for (const AreaShape shape : {AreaShape::kSquare, AreaShape::kDisk}) {
    // High above, so that distance and cosines hardly vary over the lamp.
    const scene::Light lamp = area({0, 0, 4}, {0, 0, -1}, 100, shape, 2, 2);
    TestScene s;
    const Id white = s.add_material(lambert());
    s.add_object(floor_at(0, 2), {white});
    s.lights = {lamp};
    engine::RenderRequest r = many();
    r.shadow_resolution = 512;
    r.camera = orthographic({0, 0, 0.4}, {0, 0, 0}, 0.8, 32, 32);
    const std::vector<float> open = render(s, r)[Pass::kDiffDir];
    s.add_object(floor_at(0.5f, 0.3f), {white});
    const std::vector<float> blocked = render(s, r)[Pass::kDiffDir];
    double squares = 0, worst = 0;
    int half_lit = 0;
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x) {
        const size_t i = size_t(y * 32 + x) * 3;
        const glm::dvec3 p = on_plane(pixel_ray(r.camera, x, y), {0, 0, 0}, {0, 0, 1});
        const double due = visible_share(lamp, p, shape == AreaShape::kDisk);
        const double error = blocked[i] / open[i] - due;
        half_lit += due > 0.1 && due < 0.9;
        squares += error * error;
        worst = std::max(worst, std::abs(error));
      }
    EXPECT_GT(half_lit, 200);
    // 256 stratified visibility tests: an edge through 16 x 16 strata crosses 16 to 32 of them,
    // each of which errs by half at most: sqrt(32) / 2 / 256 = .011 expected, thrice that allowed.
    EXPECT_LT(std::sqrt(squares / 1024), 0.011);
    EXPECT_LT(worst, 0.035);
  }
}

TEST(SoftLamps, FilteredPenumbraeFollowTheBlockersDistance) {
  // A straight edge half way between a disk and the floor: its penumbra is as wide as the disk, and
  // the light across it is the share of a disk beyond a chord.
  scene::Light lamp = area({0, 0, 4}, {0, 0, -1}, 100, AreaShape::kDisk, 0.5f, 0.5f);
  TestScene s;
  const Id white = s.add_material(lambert());
  s.add_object(floor_at(0, 2), {white});
  s.lights = {lamp};
  engine::RenderRequest r = request(orthographic({0, 0, 0.4}, {0, 0, 0}, 0.5, 32, 32), {Pass::kDiffDir});
  r.shadow_resolution = 1024;
  const std::vector<float> open = render(s, r)[Pass::kDiffDir];
  for (const double height : {0.5, 1.0, 2.0}) {
    TestScene with = s;
    with.add_object(quad({-2, 0, float(height)}, {2, 0, 0}, {0, 2, 0}), {white});
    engine::RenderRequest above = r;
    above.camera = orthographic({0, 0, 0.4}, {0, 0, 0}, 0.5, 32, 32);
    const std::vector<float> blocked = render(with, above)[Pass::kDiffDir];
    double squares = 0;
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x) {
        const size_t i = size_t(y * 32 + x) * 3;
        const glm::dvec3 p = on_plane(pixel_ray(above.camera, x, y), {0, 0, 0}, {0, 0, 1});
        // Where the line from p past the edge meets the lamp's plane, in radii from its centre.
        const double chord = glm::clamp((p.x * (1 - 4 / height)) / 0.25, -1.0, 1.0);
        const double due = (std::acos(chord) - chord * std::sqrt(1 - chord * chord)) / kPi;
        const double error = blocked[i] / open[i] - due;
        squares += error * error;
      }
    // A disk of 16 taps of four texels is off by a 16th at a time; blockers' mean distance is exact
    // for a plane that is parallel to the floor.
    EXPECT_LT(std::sqrt(squares / 1024), 0.05) << "blocker at " << height;
  }
}

TEST(SoftLamps, SoftShadowsCanBeSwitchedOff) {
  scene::Light lamp = area({0, 0, 4}, {0, 0, -1}, 100, AreaShape::kSquare, 2, 2);
  TestScene s;
  const Id white = s.add_material(lambert());
  s.add_object(floor_at(0, 2), {white});
  s.add_object(floor_at(0.5f, 0.3f), {white});
  s.lights = {lamp};
  engine::RenderRequest r = many(16);
  r.camera = orthographic({0, 0, 0.4}, {0, 0, 0}, 0.8, 32, 32);
  r.soft_shadows = false;
  const Picture hard = render(s, r);
  s.lights[0].size_x = s.lights[0].size_y = 0;
  const Picture tiny = render(s, r);
  EXPECT_LT(relative_rmse(hard[Pass::kDiffDir], tiny[Pass::kDiffDir]), 1e-6);
}

}  // namespace
}  // namespace panoptes::test
