// Light sampling of the path tracer on the GPU: what runs it, and what is due by quadrature and formulas.
#pragma once
#include "gl/context.h"
#include "gl/dispatch.h"
#include "path_tracer/lights.h"
#include "support.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace panoptes::test {

// Runs kRun, a function that the test gives, many times a receiver and adds up what it returns.
inline constexpr const char* kHarness = R"(
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
inline constexpr const char* kIrradiance = R"(
vec4 run(vec3 position, vec3 normal, uint index) {
  LightSample s;
  if (!light_sample(position, normal, random3(), s)) return vec4(0.0, 0.0, 1.0, 0.0);
  float e = radiance_of(s).g * max(dot(normal, s.direction), 0.0) / s.pdf;
  return vec4(e, e * e, 0.0, 0.0);
}
)";

// As kIrradiance, by samples and by evenly spread rays, weighted by the power heuristic.
inline constexpr const char* kBothWays = R"(
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

// y: 1 where a sample's density is not that of the hit that it stands for; z: 1 where it is a triangle's.
inline constexpr const char* kTriangleDensities = R"(
vec4 run(vec3 position, vec3 normal, uint index) {
  LightSample s;
  if (!light_sample(position, normal, random3(), s) || s.source == LIGHT_KNOWN) return vec4(0.0);
  float pdf = light_pdf_primitive(position, normal, s.source, s.direction, s.t_max * 4096.0 / 4095.0);
  return vec4(0.0, abs(pdf - s.pdf) <= 1.0e-3 * s.pdf ? 0.0 : 1.0, 1.0, 0.0);
}
)";

// A dim sky with a sun of .01 rad and radiance 20 000 in it, towards (0, 3, 4).
inline constexpr const char* kSkyWithSun =
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

inline double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// Irradiance that one lamp gives, by quadrature over its extent with Cycles' conventions.
inline double irradiance(const scene::Light& lamp, const Place& place) {
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
inline double irradiance(const Geometry& mesh, double radiance, const Place& place) {
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

inline std::vector<Place> places(uint32_t count, float extent, uint32_t seed = 1) {
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

inline scene::Material glow(const glm::vec3& radiance, bool varies) {
  scene::Material m = emitter(radiance);
  m.facts.emission_varies = varies;
  return m;
}

inline std::vector<scene::Light> one_of_each() {
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
inline void expect_unbiased(const std::vector<glm::dvec4>& means, const std::vector<double>& due, double n,
                     double quadrature = 0.004) {
  for (size_t i = 0; i < due.size(); ++i) {
    const double variance = std::max(means[i].y - means[i].x * means[i].x, 0.0);
    EXPECT_NEAR(means[i].x, due[i], 5 * std::sqrt(variance / n) + quadrature * due[i] + 1e-6)
        << "receiver " << i;
  }
}

// `count` times each of `kinds`, anywhere within `extent`.
inline TestScene strewn(const std::vector<scene::Light>& kinds, int count, float extent) {
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

}  // namespace panoptes::test
