// Rays through surfaces that let some light pass: by chance, and as a transmittance.
#include "gl/context.h"
#include "gl/counters.h"
#include "rays/tracers.h"
#include "support.h"
#include "tracing/opacity.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace panoptes::test {
namespace {

using shared::TracedHit;
using shared::TracedRay;
using tracing::OpacityMode;

TracedRay ray_of(const glm::vec3& origin, const glm::vec3& direction, uint32_t seed = 0) {
  return {origin.x,    origin.y,    origin.z,    0.0f,
          direction.x, direction.y, direction.z, std::numeric_limits<float>::infinity(),
          shared::NO_PRIMITIVE, shared::SEEN_BY_ALL, seed, 0};
}

class Opacity : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { context = std::make_unique<gl::Context>(); }
  static void TearDownTestSuite() {
    programs.clear();
    context.reset();
  }

  Opacity() : gpu(context->device()), timer(context->device()), list(context->device()) {}

  // The first tracer is brute force.
  void install(const TestScene& setup, const TracerEntry& entry = tracers().front()) {
    setup.install(scene);
    gpu.update(scene);
    list.update(scene, gpu, programs, timer);
    tracer = entry.make(context->device());
    tracer->build(list, programs, timer);
  }

  // Origins are world space.
  std::vector<TracedHit> trace(std::vector<TracedRay> rays, OpacityMode mode) {
    for (TracedRay& ray : rays) {
      ray.origin_x -= list.origin().x;
      ray.origin_y -= list.origin().y;
      ray.origin_z -= list.origin().z;
    }
    const gl::Buffer ray_buffer{std::span<const TracedRay>(rays)};
    const gl::Buffer hits(int64_t(rays.size() * sizeof(TracedHit)));
    gl::Buffer colours(int64_t(rays.size() * 16));
    colours.clear();
    tracing::OpacityBatch batch;
    batch.rays = &ray_buffer;
    batch.hits = &hits;
    batch.count = uint32_t(rays.size());
    if (mode == OpacityMode::kTransmittance) batch.passed = &colours;
    opacity.trace(*tracer, list, gpu, batch, mode, false, programs);
    EXPECT_NO_THROW(gl::check_errors("opacity"));
    std::vector<TracedHit> result(rays.size());
    hits.read(0, hits.bytes(), result.data());
    transmittance.resize(rays.size());
    colours.read(0, colours.bytes(), transmittance.data());
    return result;
  }

  static inline std::unique_ptr<gl::Context> context;
  static inline gl::ProgramCache programs;
  scene::Scene scene;
  gpu_scene::GpuScene gpu;
  gl::PassTimer timer;
  tracing::TriangleList list;
  std::unique_ptr<tracing::Tracer> tracer;
  tracing::OpacityWaves opacity;
  std::vector<glm::vec4> transmittance;  // of the last trace(), by ray
};

// Veils (object 0 the lowest) at heights 1, 2, ... and, beneath them, an opaque floor at -1.
TestScene veils(const std::vector<float>& alphas, bool floor) {
  TestScene s;
  if (floor) s.add_object(floor_at(-1, 4), {s.add_material(lambert())});
  for (size_t i = 0; i < alphas.size(); ++i)
    s.add_object(floor_at(float(i + 1), 4), {s.add_material(alpha_card({1, 1, 1, alphas[i]}))});
  return s;
}

// Straight down from far above, at places off the diagonal where a square's triangles meet.
std::vector<TracedRay> falling(uint32_t count) {
  std::vector<TracedRay> rays;
  for (uint32_t i = 0; i < count; ++i)
    rays.push_back(ray_of({0.5f + 0.01f * float(i % 64), -0.25f, 1000}, {0, 0, -2}, i));
  return rays;
}

double sigma(double share, double n) { return std::sqrt(share * (1 - share) / n); }

TEST_F(Opacity, TransmittanceIsTheProductOfAllLayers) {
  install(veils({0.3f, 0.3f, 0.3f, 0.3f, 0.3f}, false));
  for (const TracedHit& hit : trace(falling(100), OpacityMode::kTransmittance))
    EXPECT_EQ(hit.primitive, shared::NO_PRIMITIVE);
  for (const glm::vec4& passed : transmittance)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(passed[c], std::pow(0.7, 5), 1e-6);
  EXPECT_EQ(opacity.rounds(), 5);
}

TEST_F(Opacity, ChanceHasTheTransmittanceAsItsMean) {
  install(veils({0.3f, 0.3f, 0.3f, 0.3f, 0.3f}, false));
  constexpr uint32_t kRays = 20'000;
  const std::vector<TracedHit> any = trace(falling(kRays), OpacityMode::kAnyHit);
  const double passed = double(std::count_if(any.begin(), any.end(), [](const TracedHit& hit) {
    return hit.primitive == shared::NO_PRIMITIVE;
  }));
  EXPECT_NEAR(passed / kRays, std::pow(0.7, 5), 4 * sigma(std::pow(0.7, 5), kRays));
  // Of the layers, each takes its share of what the ones above have left.
  const std::vector<TracedHit> closest = trace(falling(kRays), OpacityMode::kClosest);
  std::map<uint32_t, double> stopped;
  for (size_t i = 0; i < kRays; ++i) {
    stopped[closest[i].primitive] += 1.0 / kRays;
    EXPECT_EQ(closest[i].primitive == shared::NO_PRIMITIVE,
              any[i].primitive == shared::NO_PRIMITIVE);
  }
  double left = 1;
  for (uint32_t layer = 5; layer-- > 0; left *= 0.7) {
    const double due = 0.3 * left, got = stopped[2 * layer] + stopped[2 * layer + 1];
    EXPECT_NEAR(got, due, 4 * sigma(due, kRays)) << "layer " << layer;
  }
}

TEST_F(Opacity, IsDecidedByRayAndPrimitiveAlone) {
  install(veils({0.5f, 0.5f, 0.5f}, true));
  const std::vector<TracedRay> rays = falling(1000);
  const std::vector<TracedHit> hits = trace(rays, OpacityMode::kClosest);
  const std::vector<TracedRay> reversed(rays.rbegin(), rays.rend());
  const std::vector<TracedHit> again = trace(reversed, OpacityMode::kClosest);
  for (size_t i = 0; i < hits.size(); ++i) {
    EXPECT_EQ(hits[i].primitive, again[hits.size() - 1 - i].primitive);
    EXPECT_EQ(hits[i].t, again[hits.size() - 1 - i].t);
  }
}

TEST_F(Opacity, EndsAtAnOpaqueSurface) {
  install(veils({0.3f, 0.3f}, true));
  const int64_t programs_before = gl::counters().programs;
  for (const TracedHit& hit : trace(falling(10), OpacityMode::kTransmittance))
    EXPECT_LT(hit.primitive, 2u);
  for (const glm::vec4& passed : transmittance) EXPECT_EQ(passed, glm::vec4(0));
  EXPECT_EQ(opacity.rounds(), 0);
  // No ray was open, so no material had to be asked.
  const int64_t of_waves = gl::counters().programs - programs_before;
  EXPECT_LE(of_waves, 2);
  std::vector<TracedRay> short_rays = falling(10);
  for (TracedRay& ray : short_rays) ray.t_max = 500.25f;  // ends at height -.5
  trace(short_rays, OpacityMode::kTransmittance);
  for (const glm::vec4& passed : transmittance) EXPECT_NEAR(passed.x, 0.49, 1e-6);
}

TEST_F(Opacity, OfNothingAndOfEverythingIsExact) {
  install(veils({1.0f, 0.0f}, true));
  for (const TracedHit& hit : trace(falling(200), OpacityMode::kClosest))
    EXPECT_EQ(hit.t, 499.5f);  // the lower veil
  trace(falling(200), OpacityMode::kTransmittance);
  for (const glm::vec4& passed : transmittance) EXPECT_EQ(passed, glm::vec4(0));
}

TEST_F(Opacity, DecidesTwoHundredLayersInOrder) {
  // Slightly different shares, so that one skipped or met twice would show in the product.
  std::vector<float> alphas;
  double product = 1;
  for (int i = 0; i < 200; ++i) {
    alphas.push_back(0.001f + 0.0001f * float(i % 50));
    product *= 1 - double(alphas.back());
  }
  for (const TracerEntry& entry : tracers()) {
    SCOPED_TRACE(entry.name);
    install(veils(alphas, false), entry);
    trace(falling(3), OpacityMode::kTransmittance);
    for (const glm::vec4& passed : transmittance) EXPECT_NEAR(passed.x, product, 1e-5);
    EXPECT_EQ(opacity.rounds(), 200);
    // All clear: whoever passes one meets the next.
    install(veils(std::vector<float>(200, 0.0f), true), entry);
    for (const TracedHit& hit : trace(falling(3), OpacityMode::kClosest))
      EXPECT_LT(hit.primitive, 2u);
    EXPECT_EQ(opacity.rounds(), 200);
    EXPECT_EQ(opacity.rays(), 3 * 201);
  }
}

TEST_F(Opacity, MeetsLayersInOnePlaceOnceEach) {
  TestScene s;
  const Id half = s.add_material(alpha_card({1, 1, 1, 0.5f})),
           third = s.add_material(alpha_card({1, 1, 1, 0.3f}));
  for (Id material : {half, third, half, third}) s.add_object(floor_at(0, 4), {material});
  for (const TracerEntry& entry : tracers()) {
    SCOPED_TRACE(entry.name);
    install(s, entry);
    trace(falling(50), OpacityMode::kTransmittance);
    for (const glm::vec4& passed : transmittance)
      EXPECT_NEAR(passed.x, 0.5 * 0.5 * 0.7 * 0.7, 1e-6);
    constexpr uint32_t kRays = 20'000;
    std::map<uint32_t, double> stopped;
    for (const TracedHit& hit : trace(falling(kRays), OpacityMode::kClosest))
      stopped[hit.primitive] += 1.0 / kRays;
    const double due[4] = {0.5, 0.5 * 0.3, 0.5 * 0.7 * 0.5, 0.5 * 0.7 * 0.5 * 0.3};
    for (uint32_t layer = 0; layer < 4; ++layer)
      EXPECT_NEAR(stopped[2 * layer] + stopped[2 * layer + 1], due[layer],
                  4 * sigma(due[layer], kRays));
  }
}

TEST_F(Opacity, FollowsTheMaterialAtTheHit) {
  // Squares of one metre of the world are cut out, on a mirrored object far from the origin.
  const glm::vec3 far_away(262144.0f, -131072.0f, 0.0f);
  TestScene s;
  const Id cut = s.add_material(
      material("void evaluate_material(const Hit hit, inout Surface surface) {\n"
               "  vec2 square = floor(hit_world_position(hit).xy);\n"
               "  bool clear = mod(square.x + square.y, 2.0) == 0.0;\n"
               "  closure_transparent(surface, vec3(clear ? 1.0 : 0.0), param(0).rgb);\n"
               "}\n",
               {{0.75f, 0.5f, 0.25f, 1}}, {.alpha = true, .glossy = false}));
  s.add_object(floor_at(0, 4), {cut},
               glm::scale(glm::translate(glm::mat4(1.0f), far_away), {-1, 1, 1}));
  install(s);
  std::vector<TracedRay> rays;
  std::vector<bool> clear;
  for (int y = -3; y < 3; ++y)
    for (int x = -3; x < 3; ++x) {
      rays.push_back(ray_of(far_away + glm::vec3(float(x) + 0.75f, float(y) + 0.5f, 5),
                            {0, 0, -1}));
      clear.push_back((x + y) % 2 == 0);
    }
  trace(rays, OpacityMode::kTransmittance);
  for (size_t i = 0; i < rays.size(); ++i)
    EXPECT_EQ(glm::vec3(transmittance[i]), clear[i] ? glm::vec3(0.75f, 0.5f, 0.25f) : glm::vec3(0)) << i;
}

TEST_F(Opacity, EachMaterialDecidesItsOwnRays) {
  // Cards side by side, the last by its UV map: clear on the right, opaque on the left.
  TestScene s;
  const std::vector<float> alphas = {0.25f, 0.5f, 0.75f};
  for (size_t i = 0; i < alphas.size(); ++i)
    s.add_object(quad({2 * float(i), 0, 0}, {0.9f, 0, 0}, {0, 0.9f, 0}),
                 {s.add_material(alpha_card({1, 1, 1, alphas[i]}))});
  s.add_object(quad({6, 0, 0}, {1, 0, 0}, {0, 1, 0}),
               {s.add_material(
                   material("void evaluate_material(const Hit hit, inout Surface surface) {\n"
                            "  closure_transparent(surface, vec3(1.0),\n"
                            "                      vec3(hit_uv(hit, UV_DEFAULT).x));\n"
                            "}\n",
                            {}, {.alpha = true, .glossy = false}))});
  install(s);
  std::vector<TracedRay> rays;
  std::vector<float> due;
  for (int i = 0; i < 400; ++i) {
    const float across = 0.001f * float(i) + 0.1f;  // of a card, off the diagonal
    const size_t card = size_t(i % 4);
    rays.push_back(ray_of({2 * float(card) + across, -0.3f, 3}, {0, 0, -1}));
    due.push_back(card < 3 ? 1 - alphas[card] : 0.5f + 0.5f * across);
  }
  trace(rays, OpacityMode::kTransmittance);
  for (size_t i = 0; i < rays.size(); ++i) EXPECT_NEAR(transmittance[i].x, due[i], 1e-5) << i;
  EXPECT_EQ(opacity.rounds(), 1);
}

TEST_F(Opacity, OfOpaqueScenesCostsNothing) {
  TestScene s;
  s.add_object(floor_at(-1, 4), {s.add_material(lambert())});
  install(s);
  trace(falling(10), OpacityMode::kClosest);
  trace(falling(10), OpacityMode::kAnyHit);
  // Against the same without materials that could have an alpha: not a program, not a buffer.
  const std::vector<TracedRay> rays = falling(10);
  const gl::Buffer ray_buffer{std::span<const TracedRay>(rays)}, hits(160);
  const tracing::RayBatch batch{&ray_buffer, &hits, nullptr, 10, nullptr};
  gl::ProgramCache plain_programs, other_programs;
  const auto cost = [&](const auto& run) {
    const int64_t compiled = gl::counters().programs, buffers = gl::counters().buffers;
    run();
    return std::pair(gl::counters().programs - compiled, gl::counters().buffers - buffers);
  };
  tracing::RayWaves waves;
  tracing::OpacityWaves through;
  const auto plain = cost([&] {
    waves.trace(*tracer, list, batch, {}, plain_programs);
    waves.trace(*tracer, list, batch, {.any_hit = true}, plain_programs);
  });
  tracing::OpacityBatch same;
  static_cast<tracing::RayBatch&>(same) = batch;
  const auto with_opacity = cost([&] {
    through.trace(*tracer, list, gpu, same, OpacityMode::kClosest, false, other_programs);
    through.trace(*tracer, list, gpu, same, OpacityMode::kAnyHit, false, other_programs);
  });
  EXPECT_EQ(with_opacity, plain);
  EXPECT_EQ(plain.first, 2);
}

// --- rays by a list ----------------------------------------------------------------------------------

TEST_F(Opacity, RaysCanBeTracedByAList) {
  install(veils({1.0f}, true));
  const std::vector<TracedRay> rays = falling(100);
  std::vector<TracedRay> placed = rays;
  for (TracedRay& ray : placed) ray.origin_z -= list.origin().z;
  const std::vector<uint32_t> numbers = {3, 97, 41};
  const gl::Buffer ray_buffer{std::span<const TracedRay>(placed)};
  const gl::Buffer listed{std::span<const uint32_t>(numbers)};
  gl::Buffer hits(100 * sizeof(TracedHit)), work(100 * sizeof(shared::TracedWork));
  hits.clear();
  work.clear();
  tracing::RayWaves waves;
  const tracing::RayBatch batch{&ray_buffer, &hits, &work, 3, &listed};
  // Two triangles at a time, so that each ray goes on once; then all of it again.
  for (int run = 1; run <= 2; ++run) {
    waves.trace(*tracer, list, batch, {.count_work = true}, programs, 2);
    EXPECT_EQ(waves.dispatches(), 2);
    std::vector<TracedHit> found(100);
    std::vector<shared::TracedWork> spent(100);
    hits.read(0, hits.bytes(), found.data());
    work.read(0, work.bytes(), spent.data());
    for (uint32_t i = 0; i < 100; ++i) {
      const bool traced = std::count(numbers.begin(), numbers.end(), i) > 0;
      EXPECT_EQ(found[i].t, traced ? 499.5f : 0.0f);
      EXPECT_EQ(spent[i].tests, traced ? 4u * uint32_t(run) : 0u);
    }
  }
}

TEST_F(Opacity, TracesOpaqueOrOtherSurfacesAlone) {
  install(veils({0.5f}, true));
  std::vector<TracedRay> rays = falling(1);
  rays[0].origin_z -= list.origin().z;
  const gl::Buffer ray_buffer{std::span<const TracedRay>(rays)}, hits(sizeof(TracedHit));
  tracing::RayWaves waves;
  const auto t = [&](tracing::Surfaces surfaces) {
    waves.trace(*tracer, list, {&ray_buffer, &hits, nullptr, 1, nullptr}, {.surfaces = surfaces},
                programs);
    TracedHit hit;
    hits.read(0, sizeof hit, &hit);
    return hit.t;
  };
  EXPECT_EQ(t(tracing::Surfaces::kAll), 499.5f);
  EXPECT_EQ(t(tracing::Surfaces::kAlpha), 499.5f);
  EXPECT_EQ(t(tracing::Surfaces::kOpaque), 500.5f);
}

}  // namespace
}  // namespace panoptes::test
