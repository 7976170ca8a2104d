// Light sampling of the path tracer: lamps give the light that they should, with little noise, and cost little.
#include "path_lights_fixture.h"
#include "rays/tracing_device.h"

namespace panoptes::test {
namespace {

// x: probability of the index-th record.
constexpr const char* kProbability = R"(
vec4 run(vec3 position, vec3 normal, uint index) {
  return vec4(record_probability(fetch_record(index), position, normal), 0.0, 0.0, 0.0);
}
)";

// x: 1 where the walk ended at no light.
constexpr const char* kNothing = R"(
vec4 run(vec3 position, vec3 normal, uint index) {
  float probability;
  return vec4(choose_light(position, normal, next_random(), probability) == NO_LIGHT ? 1.0 : 0.0);
}
)";

// Of lamps' whole radiance, as rays see it whose scattering was singular.
constexpr const char* kRaysAlone = R"(
vec4 run(vec3 position, vec3 normal, uint index) {
  vec2 u = random3().xy;
  float z = 2.0 * u.x - 1.0, r = sqrt(max(1.0 - z * z, 0.0)), phi = 6.28318530718 * u.y;
  vec3 direction = vec3(r * cos(phi), r * sin(phi), z);
  float e = lamps_seen(position, normal, direction, FAR, 0.0).g * max(dot(normal, direction), 0.0) *
            12.56637061436;
  return vec4(e, e * e, 0.0, 0.0);
}
)";

TEST_F(PathLights, LampsOfEveryKindGiveTheirIrradiance) {
  constexpr uint32_t kInvocations = 64, kRuns = 256;
  const std::vector<Place> receivers = places(24, 1.5f);
  std::vector<std::vector<scene::Light>> sets;
  for (const scene::Light& lamp : one_of_each()) sets.push_back({lamp});
  sets.push_back(one_of_each());
  for (size_t i = 0; i < sets.size(); ++i) {
    SCOPED_TRACE(i);
    TestScene s;
    s.lights = sets[i];
    install(s);
    std::vector<double> due;
    for (const Place& place : receivers) {
      due.push_back(0);
      for (const scene::Light& lamp : sets[i]) due.back() += irradiance(lamp, place);
    }
    expect_unbiased(run(kIrradiance, receivers, kInvocations, kRuns), due, kInvocations * kRuns);
  }
}
TEST_F(PathLights, ProbabilitiesSumToOne) {
  const std::vector<Place> receivers = places(40, 30);
  // Points shine everywhere.
  install(strewn({point({0, 0, 0}, 100, 0.1f), point({1, 0, 0}, 1), sun({1, 1, -1}, 0.01f)}, 500, 30));
  for (const glm::dvec4& mean : run(kProbability, receivers, 15, 100))
    EXPECT_NEAR(mean.x * 1500, 1, 1e-4);
  // Cones leave places that nothing reaches, which only the walk finds out.
  install(strewn(one_of_each(), 300, 30));
  EXPECT_EQ(lights.lamp_count(), 2700u);
  const std::vector<glm::dvec4> sums = run(kProbability, receivers, 27, 100);
  const std::vector<glm::dvec4> nothing = run(kNothing, receivers, 64, 256);
  for (size_t i = 0; i < receivers.size(); ++i)
    EXPECT_NEAR(sums[i].x * 2700 + nothing[i].x, 1, 5 * std::sqrt(0.25 / (64 * 256)));
}

// Near a rectangle, samples are even by solid angle: of their spread only the receiver's cosine and the
// lamp's falloff are left.
TEST_F(PathLights, NearRectanglesGiveLittleNoise) {
  constexpr uint32_t kInvocations = 64, kRuns = 256;
  TestScene s;
  s.lights = {area({0, 0, 1}, {0.1f, 0, -1}, 200, scene::AreaShape::kRectangle, 4, 2)};
  install(s);
  for (const glm::vec3& p : {glm::vec3(0, 0, 0.8f), glm::vec3(1, 0.5f, 0), glm::vec3(-2, 1, 0.6f)}) {
    const Place place{p, {0, 0, 1}};
    const glm::dvec4 mean = run(kIrradiance, {place}, kInvocations, kRuns)[0];
    const double variance = mean.y - mean.x * mean.x;
    expect_unbiased({mean}, {irradiance(s.lights[0], place)}, kInvocations * kRuns);
    // Of points that are even on the lamp.
    double sum = 0, squares = 0;
    constexpr int kSteps = 64;
    for (int i = 0; i < kSteps * kSteps; ++i) {
      const glm::vec3 q = scene::sample_light(s.lights[0], (float(i % kSteps) + 0.5f) / kSteps,
                                              (float(i / kSteps) + 0.5f) / kSteps, p).position;
      const glm::dvec3 way = glm::dvec3(q) - glm::dvec3(p);
      const double d2 = glm::dot(way, way);
      const double e = s.lights[0].power().g * std::max(0.0, way.z) *
                       std::max(0.0, -glm::dot(way, glm::dvec3(s.lights[0].direction()))) / (d2 * d2);
      sum += e / (kSteps * kSteps);
      squares += e * e / (kSteps * kSteps);
    }
    EXPECT_LT(variance, 0.25 * (squares - sum * sum));
    RecordProperty(fmt::format("variance_of_even_points_{}", p.z),
                   fmt::format("{:.1f}", (squares - sum * sum) / variance));
  }
}

// Every kind of sample and every kind of hit together give what samples alone give.
TEST_F(PathLights, LampsThatRaysMeetShareTheirLightWithSamples) {
  constexpr uint32_t kInvocations = 64, kRuns = 400;
  const std::vector<Place> receivers = places(16, 1.5f);
  std::vector<std::vector<scene::Light>> sets;
  for (const scene::Light& lamp : one_of_each())
    if (lamp.extended()) sets.push_back({lamp});
  sets.push_back(one_of_each());
  for (size_t i = 0; i < sets.size(); ++i) {
    SCOPED_TRACE(i);
    TestScene s;
    s.lights = sets[i];
    install(s);
    EXPECT_TRUE(lights.lamps_seen());
    std::vector<double> due;
    for (const Place& place : receivers) {
      due.push_back(0);
      for (const scene::Light& lamp : sets[i]) due.back() += irradiance(lamp, place);
    }
    expect_unbiased(run(kBothWays, receivers, kInvocations, kRuns), due, kInvocations * kRuns);
    if (sets[i].size() > 1) continue;
    // And rays alone.
    expect_unbiased(run(kRaysAlone, receivers, 4 * kInvocations, kRuns), due,
                    4 * kInvocations * kRuns);
  }
}

TEST_F(PathLights, TenThousandLampsCostLittleMoreThanAHundredAndLessNoiseThanEvenChoice) {
  constexpr uint32_t kInvocations = 64, kRuns = 64;
  const std::vector<Place> receivers = places(64, 50);
  std::map<int, double> ns;  // a sample, of CPU time
  for (int count : {1, 100, 10'000}) {
    install(strewn({point({0, 0, 0}, 100)}, count, 50));
    std::vector<glm::dvec4> means = run(kIrradiance, receivers, kInvocations, kRuns);  // compiles
    double best = 1e30;
    for (int i = 0; i < 3; ++i) {
      const Stopwatch watch;
      means = run(kIrradiance, receivers, kInvocations, kRuns);
      best = std::min(best, watch.cpu_ms());
    }
    ns[count] = best / (double(receivers.size()) * kInvocations * kRuns) * 1e6;
    RecordProperty(fmt::format("ns_a_sample_of_{}", count), fmt::format("{:.1f}", ns[count]));
    if (count < 10'000) continue;
    // One of n lamps at even chance gives n times its light, of which the sum is the mean.
    double ratio = 0;
    std::vector<double> due;
    for (size_t i = 0; i < receivers.size(); ++i) {
      double sum = 0, squares = 0;
      for (const scene::Light& lamp : scene.lights()) {
        const double e = irradiance(lamp, receivers[i]);
        sum += e;
        squares += e * e;
      }
      due.push_back(sum);
      ratio += (count * squares - sum * sum) / (means[i].y - means[i].x * means[i].x) / double(receivers.size());
    }
    expect_unbiased(means, due, kInvocations * kRuns);
    EXPECT_GT(ratio, 30);
    RecordProperty("variance_of_even_choice", fmt::format("{:.1f}", ratio));
  }
  // Twice the levels.
  EXPECT_LT(ns[10'000], 5 * ns[100]);
}

}  // namespace
}  // namespace panoptes::test
