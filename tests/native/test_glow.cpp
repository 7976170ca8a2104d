// Light of glowing surfaces on others: against quadrature, with its shadows and its sides.
#include "support.h"

#include <cmath>
#include <functional>

namespace panoptes::test {
namespace {

using film::Pass;

const gpu_scene::Camera kAbove = orthographic({0, 0, 9}, {0, 0, 0}, 1.0, 12, 12);

engine::RenderRequest many(uint32_t samples) {
  engine::RenderRequest r = request(kAbove, {Pass::kDiffDir}, samples);
  r.filter_width = 0.01f;  // so that each pixel is its centre
  r.shadow_resolution = 512;
  return r;
}

// Irradiance / pi at `p` on a floor that faces up, from a parallelogram center ± u ± v of radiance 1
// on both sides.
double from_plate(const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v,
                  const glm::dvec3& p) {
  const int n = 64;
  const glm::dvec3 area = 4.0 * glm::cross(u, v);
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const glm::dvec3 d = center + ((2 * i + 1.0) / n - 1) * u + ((2 * j + 1.0) / n - 1) * v - p;
      const double squared = glm::dot(d, d);
      sum += std::max(d.z, 0.0) * std::abs(glm::dot(d, area)) / (squared * squared);
    }
  return sum / (n * n) / kPi;
}

void expect_on_floor(const TestScene& scene, uint32_t samples,
                     const std::function<double(glm::dvec3)>& expected, double tolerance) {
  test::expect_on_floor(render(scene, many(samples)), kAbove, expected, tolerance);
}

// Out of the camera's sight: to the side of the part of the floor that it looks at.
struct Plate {
  glm::vec3 center{2.5f, 0, 1.5f}, u{0.5f, 0, 0.5f}, v{0, 0.75f, 0};
  double on(const glm::dvec3& p) const { return from_plate(center, u, v, p); }
};

TestScene glowing(const Plate& plate, const glm::vec3& radiance = glm::vec3(1)) {
  TestScene s;
  s.add_object(floor_at(0, 3), {s.add_material(lambert())});
  s.add_object(quad(plate.center, plate.u, plate.v), {s.add_material(emitter(radiance))});
  return s;
}

// The integrand varies by less than half over the plate; a (0,2)-sequence of 8 * 64 points leaves
// less than a hundredth of that, a smooth integral over whole powers of two much less.
constexpr double kStratified = 0.005;

TEST(Glow, ShinesByItsAreaAndItsRadiance) {
  const Plate plate;
  expect_on_floor(glowing(plate), 64, [&](auto p) { return plate.on(p); }, kStratified);
}

TEST(Glow, OneSampleIsCloseAlready) {
  // Eight points of an integrand that varies by half: .5 / sqrt(8) if they were random.
  const Plate plate;
  expect_on_floor(glowing(plate), 1, [&](auto p) { return plate.on(p); }, 0.18);
}

TEST(Glow, ScalesWithTheObject) {
  const Plate plate;
  for (const glm::vec3& scale : {glm::vec3(2, 2, 2), glm::vec3(-1, 2, 0.5f)}) {
    TestScene s;
    s.add_object(floor_at(0, 3), {s.add_material(lambert())});
    glm::mat4 place(1.0f);
    for (int i = 0; i < 3; ++i) place[i] *= scale[i];
    s.add_object(quad(plate.center / scale, plate.u / scale, plate.v / scale),
                 {s.add_material(emitter(glm::vec3(1)))}, place);
    expect_on_floor(s, 64, [&](auto p) { return plate.on(p); }, kStratified);
  }
}

TEST(Glow, SidesMayDiffer) {
  // Emission param(0) on the front, param(1) on the back; the plate's normal u x v points at the
  // part of the floor that is seen, or away from it when its edges are swapped.
  const char* const code =
      "void evaluate_material(const Hit hit, inout Surface surface) {\n"
      "  closure_emission(surface, vec3(1.0), param(hit.backfacing ? 1 : 0).rgb);\n"
      "}\n";
  Plate plate;
  for (bool swapped : {false, true}) {
    if (swapped) std::swap(plate.u, plate.v);
    const bool front = glm::dot(glm::cross(plate.u, plate.v), -plate.center) > 0;
    TestScene s;
    s.add_object(floor_at(0, 3), {s.add_material(lambert())});
    s.add_object(quad(plate.center, plate.u, plate.v),
                 {s.add_material(material(code, {glm::vec4(3), glm::vec4(0.25f)},
                                          {.emission = true, .glossy = false}))});
    expect_on_floor(s, 64, [&](auto p) { return (front ? 3 : 0.25) * plate.on(p); }, kStratified);
  }
}

TEST(Glow, AClosedSurfaceShinesOutwardsOnly) {
  // A small sphere far away: radiance times pi r^2 / d^2, the cosine on the floor.
  TestScene s;
  s.add_object(floor_at(0, 3), {s.add_material(lambert())});
  const glm::vec3 center(4, 0, 5);
  s.add_object(sphere(center, 0.25f, 48), {s.add_material(emitter(glm::vec3(10)))});
  // Points on a sphere show their side or do not: half of the variance of a coin, stratified.
  expect_on_floor(
      s, 64,
      [&](const glm::dvec3& p) {
        const glm::dvec3 d = glm::dvec3(center) - p;
        const double squared = glm::dot(d, d);
        return 10 * 0.0625 * d.z / std::sqrt(squared) / squared;
      },
      0.04);
}

TEST(Glow, CastsShadows) {
  // A wall between plate and floor keeps everything away from what the camera sees.
  TestScene s = glowing(Plate{});
  s.add_object(box({1.5f, 0, 2}, {0.05f, 4, 3}), {s.add_material(lambert())});
  const Picture picture = render(s, many(16));
  for (float value : picture[Pass::kDiffDir]) EXPECT_EQ(value, 0);
}

TEST(Glow, ManyEmittersShareTheirPoints) {
  // 64 small plates, one of them ten times as bright, against the sum of their exact light.
  TestScene s;
  s.add_object(floor_at(0, 3), {s.add_material(lambert())});
  const Id dim = s.add_material(emitter(glm::vec3(1))), bright = s.add_material(emitter(glm::vec3(10)));
  const glm::vec3 u{0.1f, 0, 0.1f}, v{0, 0.1f, 0};
  std::vector<glm::vec3> centers;
  for (int i = 0; i < 64; ++i) centers.push_back({2.5f + 0.25f * float(i % 4), -2 + 0.25f * float(i / 4), 2});
  for (size_t i = 0; i < centers.size(); ++i) s.add_object(quad(centers[i], u, v), {i == 9 ? bright : dim});
  expect_on_floor(
      s, 64,
      [&](const glm::dvec3& p) {
        double sum = 0;
        for (size_t i = 0; i < centers.size(); ++i)
          sum += (i == 9 ? 10 : 1) * from_plate(centers[i], u, v, p);
        return sum;
      },
      0.03);
}

TEST(Glow, DoesNotDependOnTheOrderOfInstances) {
  // Known objects keep their places on the GPU when the list is sent in another order.
  TestScene s = glowing(Plate{});
  s.add_object(quad({-2.5f, 0, 2}, {0.3f, 0, 0.3f}, {0, 0.3f, 0}), {s.add_material(emitter({5, 1, 2}))});
  const Picture first = render(s, many(4));
  std::swap(s.instances.front(), s.instances.back());
  EXPECT_EQ(render(s, many(4))[Pass::kDiffDir], first[Pass::kDiffDir]);
}

TEST(Glow, BlackEmittersCostNoShadowMaps) {
  const Picture picture = render(glowing(Plate{}, glm::vec3(0)), many(2));
  for (float value : picture[Pass::kDiffDir]) EXPECT_EQ(value, 0);
  for (const auto& [name, ms] : picture.stats.passes) EXPECT_NE(name, "emissive_shadows");
}

TEST(Glow, TouchingSurfacesStayBounded) {
  // The floor itself glows in one corner: the rest of it must not catch infinities.
  TestScene s = glowing(Plate{{0.5f, 0.5f, 1e-4f}, {0.25f, 0, 0}, {0, 0.25f, 0}});
  const Picture picture = render(s, many(16));
  // Irradiance from a plate of radiance 1 cannot exceed pi, so DiffDir cannot exceed 1; points
  // that stand for areas overshoot where they lie closest.
  for (float value : picture[Pass::kDiffDir]) EXPECT_LT(value, 20);
}

}  // namespace
}  // namespace panoptes::test
