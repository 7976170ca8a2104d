// Light sampling of the path tracer on the GPU, against quadrature and sums over all lights.
#include "gl/context.h"
#include "gl/dispatch.h"
#include "gl/counters.h"
#include "path_tracer/lights.h"
#include "rays/tracing_device.h"
#include "support.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace panoptes::test {
namespace {

// Runs kRun, a function that the test gives, many times a receiver and adds up what it returns.
constexpr const char* kHarness = R"(
#include "base/invocation.glsl"
#include "base/packing.glsl"
#include "path_tracer/lights.glsl"
#if WORLD_SAMPLED
#include "gpu_scene/world.glsl"
#endif
layout(local_size_x = 64) in;
struct Receiver { vec4 position, normal; };
layout(std430, binding = 0) readonly buffer Receivers { Receiver receivers[]; };
layout(std430, binding = 1) writeonly buffer Sums { vec4 sums[]; };
layout(location = 1) uniform uvec3 counts;  // receivers, invocations a receiver, runs an invocation

uint state;
float next_random() { return unit_float(state = hash(state)); }
vec3 random3() {
  float x = next_random(), y = next_random();
  return vec3(x, y, next_random());
}

// The radiance of a sample, whatever gives it.
vec3 radiance_of(LightSample s) {
#if WORLD_SAMPLED
  if (s.source == LIGHT_WORLD) return s.value * finite_world(s.direction);
#endif
  return s.value;
}

vec4 run(vec3 position, vec3 normal, uint index);

void main() {
  uint i = invocation();
  if (i >= counts.x * counts.y) return;
  state = hash(i);
  Receiver r = receivers[i / counts.y];
  vec4 sum = vec4(0.0);
  for (uint k = 0u; k < counts.z; ++k)
    sum += run(r.position.xyz, r.normal.xyz, (i % counts.y) * counts.z + k);
  sums[i] = sum;
}
)";

// x: irradiance by light samples; y: its square; z: how many gave nothing.
constexpr const char* kIrradiance = R"(
vec4 run(vec3 position, vec3 normal, uint index) {
  LightSample s;
  if (!light_sample(position, normal, random3(), s)) return vec4(0.0, 0.0, 1.0, 0.0);
  float e = radiance_of(s).g * max(dot(normal, s.direction), 0.0) / s.pdf;
  return vec4(e, e * e, 0.0, 0.0);
}
)";

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

// As kIrradiance, by samples and by evenly spread rays, weighted by the power heuristic.
constexpr const char* kBothWays = R"(
const float EVEN = 1.0 / 12.56637061436;
vec3 even_direction() {
  vec2 u = random3().xy;
  float z = 2.0 * u.x - 1.0, r = sqrt(max(1.0 - z * z, 0.0)), phi = 6.28318530718 * u.y;
  return vec3(r * cos(phi), r * sin(phi), z);
}
vec4 run(vec3 position, vec3 normal, uint index) {
  LightSample s;
  float e = 0.0;
  if (light_sample(position, normal, random3(), s)) {
    float ratio = s.singular ? 0.0 : EVEN / s.pdf;
    e += radiance_of(s).g * max(dot(normal, s.direction), 0.0) / s.pdf / (1.0 + ratio * ratio);
  }
  vec3 direction = even_direction();
  vec3 seen = lamps_seen(position, normal, direction, FAR, EVEN);
#if WORLD_SAMPLED
  float ratio = light_pdf_world(position, normal, direction) / EVEN;
  seen += finite_world(direction) / (1.0 + ratio * ratio);
#endif
  e += seen.g * max(dot(normal, direction), 0.0) / EVEN;
  return vec4(e, e * e, 0.0, 0.0);
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

// y: 1 where a sample's density is not that of the hit that it stands for; z: 1 where it is a triangle's.
constexpr const char* kTriangleDensities = R"(
vec4 run(vec3 position, vec3 normal, uint index) {
  LightSample s;
  if (!light_sample(position, normal, random3(), s) || s.source == LIGHT_KNOWN) return vec4(0.0);
  float pdf = light_pdf_primitive(position, normal, s.source, s.direction, s.t_max * 4096.0 / 4095.0);
  return vec4(0.0, abs(pdf - s.pdf) <= 1.0e-3 * s.pdf ? 0.0 : 1.0, 1.0, 0.0);
}
)";

// The same of the world; texels are thin, so that rounding may put a few into the next.
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

// Straight up: x: radiance of all lamps.
constexpr const char* kUpwards = R"(
vec4 run(vec3 position, vec3 normal, uint index) {
  vec3 up = normalize(vec3(1.0e-3 * random3().xy, 1.0));
  return vec4(lamps_seen(position, normal, up, FAR, 0.0).g);
}
)";

// The same, twice, where samples are as dense as the scattering; all lamps are alike.
constexpr const char* kUpwardsWeighed = R"(
vec4 run(vec3 position, vec3 normal, uint index) {
  vec3 up = normalize(vec3(1.0e-3 * random3().xy, 1.0));
  LightRecord l = fetch_record(0u);
  float pdf = lamp_on_ray(l, position, up, FAR).pdf * record_probability(l, position, normal);
  return vec4(2.0 * lamps_seen(position, normal, up, FAR, pdf).g);
}
)";

// x: samples on the half where x > 0 from the middle; y: others.
constexpr const char* kBrightHalf = R"(
vec4 run(vec3 position, vec3 normal, uint index) {
  LightSample s;
  if (!light_sample(position, normal, random3(), s)) return vec4(0.0);
  bool bright = position.x + s.direction.x * s.t_max > position.x - 0.25;
  return vec4(bright, !bright, 0.0, 0.0);
}
)";

// x: 1 where anything is not a finite number.
constexpr const char* kNotFinite = R"(
bool finite_number(float x) { return abs(x) <= 3.2e38; }
bool finite_vector(vec3 v) { return finite_number(v.x) && finite_number(v.y) && finite_number(v.z); }
vec4 run(vec3 position, vec3 normal, uint index) {
  LightSample s;
  light_sample(position, normal, random3(), s);
  bool good = finite_vector(s.direction) && finite_vector(s.value) && finite_number(s.pdf) &&
              finite_number(s.t_max) && s.pdf >= 0.0 && abs(length(s.direction) - 1.0) < 1.0e-4;
  if (s.pdf > 0.0) good = good && finite_vector(s.value / s.pdf);
  vec3 direction = normalize(random3() - 0.5);
  for (uint primitive = 0u; primitive < 2u; ++primitive)
    good = good && finite_number(light_pdf_primitive(position, normal, primitive, direction, random3().x)) &&
           finite_number(light_pdf_primitive(position, normal, primitive, direction, 0.0));
  good = good && finite_vector(lamps_seen(position, normal, direction, FAR, 0.3)) &&
         finite_vector(lamps_seen(position, normal, direction, FAR, 0.0)) &&
         finite_number(light_pdf_world(position, normal, direction)) &&
         finite_number(light_pdf_world(position, normal, vec3(0.0, 0.0, 1.0)));
  return vec4(good ? 0.0 : 1.0);
}
)";

// x: irradiance by samples; z: 1 where a sample wants a shadow ray, or rays show what is the samples'.
constexpr const char* kShadowless = R"(
vec4 run(vec3 position, vec3 normal, uint index) {
  LightSample s;
  if (!light_sample(position, normal, random3(), s)) return vec4(0.0);
  bool wrong = s.t_max != 0.0 || !s.singular ||
               lamps_seen(position, normal, s.direction, FAR, 1.0) != vec3(0.0);
  float e = s.value.g * max(dot(normal, s.direction), 0.0) / s.pdf;
  return vec4(e, e * e, wrong ? 1.0 : 0.0, 0.0);
}
)";

// A dim sky with a sun of .01 rad and radiance 20 000 in it, towards (0, 3, 4).
constexpr const char* kSkyWithSun =
    "vec3 evaluate_world(vec3 direction) {\n"
    "  bool sun = distance(normalize(direction), vec3(0.0, 0.6, 0.8)) < 0.01;\n"
    "  return vec3(sun ? 20000.0 : 0.2 + 0.2 * direction.z);\n"
    "}\n";

struct Receiver {
  glm::vec4 position, normal;
};

struct Place {
  glm::vec3 position, normal;
};

class PathLights : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { context = std::make_unique<gl::Context>(); }
  static void TearDownTestSuite() {
    programs.clear();
    context.reset();
  }

  PathLights()
      : gpu(context->device()), timer(context->device()), list(context->device()),
        lights(context->device()) {}

  void install(const TestScene& setup) {
    setup.install(scene);
    update();
  }
  void update() {
    gpu.update(scene);
    list.update(scene, gpu, programs, timer);
    lights.update(scene, gpu, list, programs, timer);
    EXPECT_NO_THROW(gl::check_errors("lights"));
  }

  // A receiver each: the mean of `invocations` * `runs` runs of `code`.
  std::vector<glm::dvec4> run(const char* code, const std::vector<Place>& places,
                              uint32_t invocations, uint32_t runs) {
    std::vector<Receiver> receivers;
    for (const Place& p : places)
      receivers.push_back({glm::vec4(p.position - list.origin(), 0), glm::vec4(p.normal, 0)});
    const uint32_t count = uint32_t(receivers.size()) * invocations;
    const gl::Buffer input{std::span<const Receiver>(receivers)};
    const gl::Buffer output(int64_t(count) * 16);
    gl::ProgramSource source;
    source.name = "light test";
    source.stages = {{GL_COMPUTE_SHADER, "light_test.comp"}};
    source.snippets["light_test.comp"] = std::string(kHarness) + code;
    lights.add_defines(source);
    if (lights.world_sampled()) gpu_scene::GpuScene::add_world(*gpu.world(), source);
    programs.get(source).use();
    lights.bind();
    if (lights.world_sampled()) gpu.bind_shading(*gpu.world());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, input.id());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, output.id());
    glUniform3ui(1, uint32_t(receivers.size()), invocations, runs);
    gl::dispatch(count, GL_BUFFER_UPDATE_BARRIER_BIT);
    std::vector<glm::vec4> sums(count);
    output.read(0, output.bytes(), sums.data());
    EXPECT_NO_THROW(gl::check_errors("light test"));
    std::vector<glm::dvec4> means(receivers.size());
    for (size_t i = 0; i < sums.size(); ++i)
      means[i / invocations] += glm::dvec4(sums[i]) / (double(invocations) * runs);
    return means;
  }

  static inline std::unique_ptr<gl::Context> context;
  static inline gl::ProgramCache programs;
  scene::Scene scene;
  gpu_scene::GpuScene gpu;
  gl::PassTimer timer;
  tracing::TriangleList list;
  path_tracer::Lights lights;
};

// --- what is due ---------------------------------------------------------------------------------

double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// Irradiance that one lamp gives, by quadrature over its extent with Cycles' conventions.
double irradiance(const scene::Light& lamp, const Place& place) {
  using scene::LightType;
  constexpr int kSteps = 48;
  const glm::dvec3 p(place.position), n(place.normal);
  double sum = 0;
  const int steps = lamp.extended() ? kSteps : 1;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const scene::LightSample s = scene::sample_light(lamp, float((i + 0.5) / steps),
                                                       float((j + 0.5) / steps), place.position);
      if (lamp.type == LightType::kSun) {
        sum += lamp.power().g * std::max(0.0, -glm::dot(n, glm::dvec3(s.direction)));
        continue;
      }
      const glm::dvec3 way = glm::dvec3(s.position) - p;
      const double d2 = glm::dot(way, way);
      const glm::dvec3 l = way / std::sqrt(d2);
      const double received = std::max(0.0, glm::dot(n, l));
      double emitted = 1;
      if (lamp.type == LightType::kPoint && lamp.radius > 0)
        emitted = std::max(0.0, -glm::dot(l, glm::normalize(p - glm::dvec3(lamp.position()))));
      if (lamp.type == LightType::kSpot) {
        const double c = -glm::dot(l, glm::dvec3(lamp.direction()));
        const double c0 = std::cos(0.5 * lamp.spot_size), w = (1 - c0) * lamp.spot_blend;
        emitted = c <= c0 ? 0 : c * (w > 0 ? smooth_step((c - c0) / w) : 1);
      }
      if (lamp.type == LightType::kArea) {
        const double c = -glm::dot(l, glm::dvec3(lamp.direction()));
        const double half = 0.5 * lamp.spread;
        emitted = std::max(c, 0.0);
        if (lamp.spread < 3.14159f && c > 0)
          emitted *= std::max(0.0, std::tan(half) - std::sqrt(1 - c * c) / c) / (std::tan(half) - half);
      }
      sum += lamp.power().g * emitted * received / d2;
    }
  return sum / (double(steps) * steps);
}

// Irradiance that a mesh of constant radiance gives, by Lambert's formula for polygons, with each
// triangle clipped to the receiver's horizon.
double irradiance(const Geometry& mesh, double radiance, const Place& place) {
  double sum = 0;
  for (const glm::ivec3& t : mesh.triangles) {
    std::vector<glm::dvec3> corners, above;
    const glm::dvec3 n(place.normal);
    for (int k = 0; k < 3; ++k)
      corners.push_back(glm::dvec3(mesh.positions[size_t(t[k])]) - glm::dvec3(place.position));
    for (size_t k = 0; k < 3; ++k) {
      const glm::dvec3 a = corners[k], b = corners[(k + 1) % 3];
      const double za = glm::dot(a, n), zb = glm::dot(b, n);
      if (za >= 0) above.push_back(a);
      if ((za >= 0) != (zb >= 0)) above.push_back(a + (b - a) * (za / (za - zb)));
    }
    double triangle = 0;
    for (size_t k = 0; k < above.size(); ++k) {
      const glm::dvec3 a = glm::normalize(above[k]), b = glm::normalize(above[(k + 1) % above.size()]);
      const glm::dvec3 across = glm::cross(a, b);
      const double sine = glm::length(across);
      if (sine > 1e-12) triangle += std::atan2(sine, glm::dot(a, b)) * glm::dot(across / sine, n);
    }
    sum += 0.5 * radiance * std::abs(triangle);
  }
  return sum;
}

std::vector<Place> places(uint32_t count, float extent, uint32_t seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> u(-1, 1);
  std::vector<Place> list;
  while (list.size() < count) {
    const glm::vec3 n(u(random), u(random), u(random));
    if (glm::length(n) > 1 || glm::length(n) < 0.1f) continue;
    list.push_back({extent * glm::vec3(u(random), u(random), u(random)), glm::normalize(n)});
  }
  return list;
}

scene::Material glow(const glm::vec3& radiance, bool varies) {
  scene::Material m = emitter(radiance);
  m.facts.emission_varies = varies;
  return m;
}

std::vector<scene::Light> one_of_each() {
  scene::Light soft_sun = sun({0.3f, 0.2f, -1}, 0.7f);
  soft_sun.angle = 0.4f;
  scene::Light soft_spot = spot({-2, 1, 3}, {0.3f, 0, -1}, 300, 1.2f, 0.4f);
  soft_spot.radius = 0.3f;
  scene::Light narrow = area({0, -2, 3}, {0, 0.2f, -1}, 150, scene::AreaShape::kDisk, 0.8f, 0.8f);
  narrow.spread = 1.5f;
  return {sun({0, 0.5f, -1}, 0.4f),
          soft_sun,
          point({2, 2, 2}, 100),
          point({-2, -2, 2}, 120, 0.4f),
          spot({0, 0, 4}, {0, 0, -1}, 400, 1.0f, 0.2f),
          soft_spot,
          area({1, 0, -3}, {0, 0, 1}, 200, scene::AreaShape::kRectangle, 2, 1),
          area({-1, -3, 0}, {0.1f, 1, 0}, 100, scene::AreaShape::kEllipse, 1, 2),
          narrow};
}

// Expects the means to be what is due, within five of their standard errors and of the quadrature.
void expect_unbiased(const std::vector<glm::dvec4>& means, const std::vector<double>& due, double n,
                     double quadrature = 0.004) {
  for (size_t i = 0; i < due.size(); ++i) {
    const double variance = std::max(means[i].y - means[i].x * means[i].x, 0.0);
    EXPECT_NEAR(means[i].x, due[i], 5 * std::sqrt(variance / n) + quadrature * due[i] + 1e-6)
        << "receiver " << i;
  }
}

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

// `count` times each of `kinds`, anywhere within `extent`.
TestScene strewn(const std::vector<scene::Light>& kinds, int count, float extent) {
  TestScene s;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> u(-extent, extent);
  for (int i = 0; i < count; ++i)
    for (scene::Light lamp : kinds) {
      lamp.object_to_world =
          glm::translate(glm::mat4(1), glm::vec3(u(random), u(random), u(random))) * lamp.object_to_world;
      s.lights.push_back(lamp);
    }
  return s;
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

// --- capacities ----------------------------------------------------------------------------------

TEST_F(PathLights, RaysFindTheirWayThroughTenThousandSoftLamps) {
  constexpr uint32_t kInvocations = 64, kRuns = 64;
  const std::vector<Place> receivers = places(8, 10);
  install(strewn({point({0, 0, 0}, 100, 0.3f)}, 10'000, 10));
  std::vector<double> due;
  for (const Place& place : receivers) {
    due.push_back(0);
    for (scene::Light lamp : scene.lights()) {
      // The few that are near enough have a shape; the others are points.
      if (glm::distance(lamp.position(), place.position) > 3) lamp.radius = 0;
      due.back() += irradiance(lamp, place);
    }
  }
  expect_unbiased(run(kBothWays, receivers, kInvocations, kRuns), due, kInvocations * kRuns, 0.01);
  EXPECT_TRUE(lights.warnings().empty());
}

// A ray that passes thousands of lamps at once neither ends early nor loses light.
TEST_F(PathLights, APileOfSoftLampsLosesNoLight) {
  TestScene s;
  for (int i = 0; i < 20'000; ++i)
    s.lights.push_back(area({0, 0, 2 + 1e-5f * float(i)}, {0, 0, -1}, 1, scene::AreaShape::kDisk, 1, 1));
  install(s);
  ASSERT_EQ(lights.warnings().size(), 1u);
  EXPECT_NE(lights.warnings()[0].find("16384 of 20000 soft lamps"), std::string::npos);
  const Place below{{0, 0, 0}, {0, 0, 1}};
  const double radiance = 1 / (4 * kPi * 0.25);
  EXPECT_NEAR(run(kUpwards, {below}, 64, 1)[0].x, 16384 * radiance, 1e-4 * 16384 * radiance);
  const glm::dvec4 weighed = run(kUpwardsWeighed, {below}, 512, 1)[0];
  EXPECT_NEAR(weighed.x, 16384 * radiance, 0.05 * 16384 * radiance);
}

TEST_F(PathLights, SaysWhenTheDriverCannotAddressTheLights) {
  gl::DeviceInfo small = context->device();
  small.max_texture_buffer_texels = 65536;  // what OpenGL promises
  path_tracer::Lights few(small);
  const auto list_lamps = [&](int count) {
    strewn({point({0, 0, 0}, 100)}, count, 50).install(scene);
    gpu.update(scene);
    list.update(scene, gpu, programs, timer);
    few.update(scene, gpu, list, programs, timer);
  };
  expect_error([&] { list_lamps(20'000); }, "more lamps and glowing triangles than this graphics driver");
  EXPECT_NO_THROW(list_lamps(5'000));
  EXPECT_EQ(few.lamp_count(), 5'000u);
  // The world's map gets coarser instead.
  TestScene s;
  s.world = world(kSkyWithSun);
  s.install(scene);
  gpu.update(scene);
  few.update(scene, gpu, list, programs, timer);
  EXPECT_TRUE(few.world_sampled());
  EXPECT_LE(few.bytes(), 65536 * 4 + 64);
}

TEST_F(PathLights, AHundredThousandTrianglesMayGlow) {
  constexpr uint32_t kInvocations = 64, kRuns = 64;
  TestScene s;
  const Geometry ball = sphere({0, 0, 0}, 1, 320);
  const Id glowing = s.add_material(glow({1, 1, 1}, true));
  s.add_object(ball, {glowing});
  install(s);
  EXPECT_GT(lights.triangle_count(), 100'000u);
  std::vector<Place> receivers = places(8, 4);
  std::erase_if(receivers, [](const Place& p) { return glm::length(p.position) < 1.5f; });
  for (const glm::dvec4& mean : run(kTriangleDensities, receivers, kInvocations, kRuns)) {
    EXPECT_EQ(mean.y, 0);
    EXPECT_GT(mean.z, 0.5);
  }
}

// --- updates -------------------------------------------------------------------------------------

TEST_F(PathLights, OnlyWhatHasChangedIsDoneAgain) {
  TestScene s;
  s.add_object(floor_at(0, 1), {s.add_material(glow({1, 1, 1}, true))});
  s.lights = {point({0, 0, 2}, 100)};
  s.world = world(kSkyWithSun);
  install(s);
  const auto uploads = [&] {
    const int64_t before = gl::counters().uploaded_bytes;
    lights.update(scene, gpu, list, programs, timer);
    return gl::counters().uploaded_bytes - before;
  };
  EXPECT_EQ(uploads(), 0);
  // A dragged lamp: its record and the tree, no question to the material, no map.
  s.lights[0].energy = 50;
  scene.set_lights(s.lights);
  gpu.update(scene);
  const int64_t records = 3 * sizeof(shared::LightRecord) + 5 * sizeof(shared::LightNode) + 2 * 4;
  EXPECT_EQ(uploads(), records + int64_t(sizeof(shared::LightConstants)));
  EXPECT_EQ(uploads(), 0);
  // Another radiance is found out.
  scene.set_material_params(1, {glm::vec4(0)});
  gpu.update(scene);
  EXPECT_GT(uploads(), 0);
  EXPECT_EQ(lights.triangle_count(), 0u);
  EXPECT_EQ(lights.lamp_count(), 1u);
  // No lamps and no world any more.
  scene.set_lights({});
  scene.set_world(constant_world({0, 0, 0}));
  gpu.update(scene);
  uploads();
  EXPECT_FALSE(lights.any());
  EXPECT_EQ(lights.bytes(), int64_t(sizeof(shared::LightConstants)));
}

// Of two triangles of one material, the one that is bright there gets most samples.
TEST_F(PathLights, TrianglesAreMeasuredWhereTheirRadianceVaries) {
  TestScene s;
  scene::Material m = material(
      "void evaluate_material(const Hit hit, inout Surface surface) {\n"
      "  closure_emission(surface, vec3(1.0), vec3(hit_world_position(hit).x > 101.0 ? 10.0 : 0.01));\n"
      "}\n",
      {}, {.emission = true, .glossy = false});
  Geometry both = floor_at(0, 1);
  both.add(quad({2.5f, 0, 0}, {1, 0, 0}, {0, 1, 0}));
  s.add_object(both, {s.add_material(m)}, glm::translate(glm::mat4(1), {100, 0, 0}));
  install(s);
  const glm::dvec4 mean = run(kBrightHalf, {{{101.25f, 0, 2}, {0, 0, -1}}}, 64, 64)[0];
  EXPECT_GT(mean.x, 0.85);
  EXPECT_GT(mean.y, 0.005);  // and the other is not forgotten
}

// --- hard cases ----------------------------------------------------------------------------------

TEST_F(PathLights, LightOnAndInsideASurfaceIsFinite) {
  TestScene s;
  s.lights = one_of_each();
  s.lights.push_back(area({0, 0, 0}, {0, 0, 1}, 10, scene::AreaShape::kRectangle, 1, 0));
  s.add_object(quad({5, 0, 0}, {1, 0, 0}, {0, 1, 0}), {s.add_material(glow({1, 2, 3}, true))});
  s.world = world(kSkyWithSun);
  install(s);
  std::vector<Place> receivers;
  for (const scene::Light& lamp : s.lights)
    for (const glm::vec3& n : {glm::vec3(0, 0, 1), glm::vec3(0), glm::vec3(0, -1, 0)}) {
      receivers.push_back({lamp.position(), n});
      receivers.push_back({lamp.position() + 0.2f * glm::vec3(lamp.object_to_world[0]), n});
      receivers.push_back({std::nextafter(1.0f, 2.0f) * lamp.position(), n});
    }
  for (const glm::vec3& corner : {glm::vec3(4, -1, 0), glm::vec3(5, 0, 0), glm::vec3(6, 1, 1e-20f)})
    receivers.push_back({corner, {0, 0, 1}});
  for (const glm::dvec4& mean : run(kNotFinite, receivers, 8, 32)) EXPECT_EQ(mean.x, 0);
}

// At every scale, and far from the world's origin, the light is the same.
TEST_F(PathLights, ScaleAndPlaceDoNotMatter) {
  constexpr uint32_t kInvocations = 64, kRuns = 128;
  const std::vector<Place> near = places(6, 1.5f);
  for (const auto& [scale, origin] : {std::pair(1e-4f, 0.0f), {1e5f, 0.0f}, {1.0f, 1048576.0f}}) {
    SCOPED_TRACE(scale);
    TestScene s;
    s.lights = one_of_each();
    const auto moved = [&, scale = scale, origin = origin](const glm::vec3& p) {
      return glm::round(8.0f * p) / 8.0f * scale + glm::vec3(origin, -origin, origin);
    };
    std::vector<double> due;
    for (const Place& place : near) {
      const Place rounded{glm::round(8.0f * place.position) / 8.0f, place.normal};
      due.push_back(irradiance(quad({0, 0, 4}, {1, 0, 0}, {0, 1, 0}), 3, rounded));
      for (const scene::Light& lamp : s.lights) due.back() += irradiance(lamp, rounded);
    }
    for (scene::Light& lamp : s.lights) {
      lamp.object_to_world[3] = glm::vec4(moved(lamp.position()), 1);
      if (lamp.type != scene::LightType::kSun) lamp.energy *= scale * scale;
      lamp.radius *= scale;
      lamp.size_x *= scale;
      lamp.size_y *= scale;
    }
    glm::mat4 place = glm::scale(glm::mat4(1), glm::vec3(scale));
    place[3] = glm::vec4(moved({0, 0, 0}), 1);
    s.add_object(quad({0, 0, 4}, {1, 0, 0}, {0, 1, 0}), {s.add_material(glow({2, 3, 4}, false))}, place);
    install(s);
    std::vector<Place> receivers;
    for (const Place& p : near) receivers.push_back({moved(p.position), p.normal});
    expect_unbiased(run(kBothWays, receivers, kInvocations, kRuns), due, kInvocations * kRuns, 0.01);
  }
}

TEST_F(PathLights, LampsWithoutShadowNeedNoRay) {
  for (scene::Light lamp : one_of_each()) {
    lamp.cast_shadow = false;
    TestScene s;
    s.lights = {lamp};
    install(s);
    const Place place{{0, 0, 0}, {0, 0, 1}};
    const glm::dvec4 mean = run(kShadowless, {place}, 64, 64)[0];
    EXPECT_EQ(mean.z, 0);
    EXPECT_NEAR(mean.x, irradiance(lamp, place),
                5 * std::sqrt(std::max(mean.y - mean.x * mean.x, 0.0) / (64 * 64)) + 0.004 * mean.x);
  }
}

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
