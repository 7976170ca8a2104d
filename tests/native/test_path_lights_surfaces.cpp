// Light sampling of the path tracer: glowing triangles and the world.
#include "path_lights_fixture.h"

namespace panoptes::test {
namespace {

// As kTriangleDensities, of the world; texels are thin, so that rounding may put a few into the next.
constexpr const char* kWorldDensities = R"(
vec4 run(vec3 position, vec3 normal, uint index) {
  LightSample s;
  if (!light_sample(position, normal, random3(), s)) return vec4(0.0);
  float pdf = light_pdf_world(position, normal, s.direction);
  for (int i = 0; i < 9 && abs(pdf - s.pdf) > 1.0e-3 * s.pdf; ++i) {
    vec3 near = vec3(float(i % 3 - 1), float(i / 3 - 1), 0.0) * 2.0e-6;
    pdf = light_pdf_world(position, normal, normalize(s.direction + near));
  }
  return vec4(0.0, abs(pdf - s.pdf) <= 1.0e-3 * s.pdf ? 0.0 : 1.0, 0.0, 0.0);
}
)";

// x: the density's integral, by evenly spread directions.
constexpr const char* kWorldWhole = R"(
vec4 run(vec3 position, vec3 normal, uint index) {
  vec2 u = random3().xy;
  float z = 2.0 * u.x - 1.0, r = sqrt(max(1.0 - z * z, 0.0)), phi = 6.28318530718 * u.y;
  return vec4(light_pdf_world(position, normal, vec3(r * cos(phi), r * sin(phi), z)) * 12.56637061436);
}
)";

// --- glowing triangles ---------------------------------------------------------------------------

TEST_F(PathLights, TrianglesGlowByLambertsFormula) {
  constexpr uint32_t kInvocations = 64, kRuns = 256;
  const std::vector<Place> receivers = places(16, 2);
  // A patch on both sides of the receivers and a bumpy strip; no two shade each other here.
  const Geometry patch = quad({0.5f, 0.3f, 3}, {1, 0, 0.2f}, {0, 1.5f, 0});
  const Geometry strip = quad({-3, 0, 0}, {0, 0.1f, 0.3f}, {0.1f, 2, 0});
  for (bool mirrored : {false, true}) {
    TestScene s;
    s.add_object(patch, {s.add_material(glow({2, 3, 4}, false))});
    s.add_object(strip, {s.add_material(glow({5, 6, 7}, false))},
                 mirrored ? glm::scale(glm::mat4(1), {1, -1, 1}) : glm::mat4(1));
    install(s);
    EXPECT_EQ(lights.triangle_count(), 4u);
    EXPECT_FALSE(lights.emitters_vary());
    std::vector<double> due;
    Geometry other = strip;
    if (mirrored)
      for (glm::vec3& p : other.positions) p.y = -p.y;
    for (const Place& place : receivers)
      due.push_back(irradiance(patch, 3, place) + irradiance(other, 6, place));
    expect_unbiased(run(kIrradiance, receivers, kInvocations, kRuns), due, kInvocations * kRuns, 1e-4);
  }
}

TEST_F(PathLights, AHitOnATriangleHasTheDensityOfItsSamples) {
  TestScene s;
  const Id glowing = s.add_material(glow({1, 2, 3}, true)), dark = s.add_material(lambert());
  s.add_object(floor_at(-3, 5), {dark});
  s.add_object(sphere({1, 2, 0}, 0.5f, 24), {glowing});
  Geometry both = quad({-2, 0, 1}, {0, 1, 0}, {0, 0, 1});
  both.add(quad({-2, 0, -1}, {0, 1, 0}, {0, 0, 0.1f}), 1);
  s.add_object(both, {dark, glowing}, glm::scale(glm::mat4(1), {1, 2, -1}));
  s.lights = one_of_each();
  install(s);
  EXPECT_TRUE(lights.emitters_vary());
  const std::vector<glm::dvec4> means = run(kTriangleDensities, places(32, 3), 32, 64);
  double triangles = 0;
  for (const glm::dvec4& mean : means) {
    EXPECT_EQ(mean.y, 0);
    triangles += mean.z;
  }
  EXPECT_GT(triangles, 1);
}

TEST_F(PathLights, DarkAndHiddenTrianglesAreNoLights) {
  TestScene s;
  const Id black = s.add_material(glow({0, 0, 0}, true)), bright = s.add_material(glow({1, 1, 1}, false));
  s.add_object(floor_at(0, 1), {black});
  s.add_object(floor_at(1, 1), {bright});
  s.instances.back().visibility = shared::SEEN_BY_CAMERA | shared::SEEN_BY_SHADOW;
  s.add_object(floor_at(2, 0), {bright});
  install(s);
  EXPECT_EQ(lights.triangle_count(), 0u);
  EXPECT_FALSE(lights.any());
  EXPECT_EQ(lights.bytes(), int64_t(sizeof(shared::LightConstants)));
}

// --- the world -----------------------------------------------------------------------------------

TEST_F(PathLights, TheWorldGivesItsIrradiance) {
  constexpr uint32_t kInvocations = 64, kRuns = 400;
  TestScene s;
  s.world = world(kSkyWithSun);
  install(s);
  EXPECT_TRUE(lights.world_sampled());
  const std::vector<Place> receivers = places(16, 1);
  std::vector<double> due;
  for (const Place& place : receivers) {
    const glm::dvec3 n(place.normal);
    // Of .2 + .2 z: pi / 5 + the clamped cosine's first harmonic, 2 pi / 3.
    due.push_back(kPi * 0.2 + 0.2 * 2 * kPi / 3 * n.z +
                  20000 * kPi * 0.01 * 0.01 * std::max(0.0, glm::dot(n, glm::dvec3(0, 0.6, 0.8))));
  }
  const std::vector<glm::dvec4> means = run(kIrradiance, receivers, kInvocations, kRuns);
  expect_unbiased(means, due, kInvocations * kRuns, 0.002);
  // The sun is found at once: by even samples the standard deviation would be a hundred times the mean.
  for (size_t i = 0; i < due.size(); ++i)
    EXPECT_LT(std::sqrt(means[i].y - means[i].x * means[i].x), 6 * due[i] + 2);
  expect_unbiased(run(kBothWays, receivers, kInvocations, kRuns), due, kInvocations * kRuns, 0.002);
  for (const glm::dvec4& mean : run(kWorldDensities, receivers, 32, 64)) EXPECT_EQ(mean.y, 0);
  s.world = world("vec3 evaluate_world(vec3 direction) { return vec3(1.0 + direction.x); }\n");
  install(s);
  for (const glm::dvec4& mean : run(kWorldWhole, {receivers[0]}, 256, 400)) EXPECT_NEAR(mean.x, 1, 0.01);
}

TEST_F(PathLights, TheWorldAndLampsShareSamples) {
  constexpr uint32_t kInvocations = 64, kRuns = 400;
  TestScene s;
  s.world = world("vec3 evaluate_world(vec3 direction) { return vec3(1.0 + direction.z); }\n");
  s.lights = one_of_each();
  s.add_object(quad({0.5f, 0.3f, 3}, {1, 0, 0.2f}, {0, 1.5f, 0}), {s.add_material(glow({2, 3, 4}, false))});
  install(s);
  const std::vector<Place> receivers = places(16, 1.5f);
  std::vector<double> due;
  for (const Place& place : receivers) {
    due.push_back(kPi + 2 * kPi / 3 * place.normal.z +
                  irradiance(quad({0.5f, 0.3f, 3}, {1, 0, 0.2f}, {0, 1.5f, 0}), 3, place));
    for (const scene::Light& lamp : s.lights) due.back() += irradiance(lamp, place);
  }
  expect_unbiased(run(kIrradiance, receivers, kInvocations, kRuns), due, kInvocations * kRuns);
}

TEST_F(PathLights, AWorldOfOneColourIsLeftToScatteredRays) {
  TestScene s;
  s.world = constant_world({1, 1, 1});
  install(s);
  EXPECT_FALSE(lights.any());
  EXPECT_FALSE(lights.world_sampled());
}

}  // namespace
}  // namespace panoptes::test
