// The traversal's own: rays that are interrupted, heaps, ties, lists that change. That its hits are
// right is for the catalogue (test_ray_hard_cases.cpp) and Embree too.
#include "base/error.h"
#include "bvh_tracer/bvh_tracer.h"
#include "rays/comparison.h"
#include "rays/scenes.h"
#include "rays/shared_device.h"

#include <gtest/gtest.h>

namespace panoptes::test {
namespace {

using bvh_tracer::BvhTracer;

class BvhTracerTest : public ::testing::Test {
 protected:
  void build(const Triangles& triangles) {
    tracing_device().assign(triangles);
    tracing_device().build(tracer);
  }
  Traced trace(const std::vector<TracedRay>& rays, const tracing::TraceOptions& options = {},
               int budget = tracing::RayWaves::kBudget) {
    return tracing_device().trace(tracer, rays, options, budget);
  }

  BvhTracer tracer{tracing_device().device()};
};

Triangles random_triangles(uint32_t count) {
  Random random(3);
  Triangles triangles;
  for (uint32_t i = 0; i < count; ++i) {
    const glm::vec3 at = random.in_box(glm::vec3(-10), glm::vec3(10));
    const float size = i % 100 == 0 ? 10.0f : 0.5f;
    triangles.push_back(make_triangle(at, at + size * random.on_sphere(), at + size * random.on_sphere()));
  }
  return triangles;
}

std::vector<TracedRay> random_rays(uint32_t count, float t_max = kFarAway) {
  Random random(4);
  std::vector<TracedRay> rays;
  for (uint32_t i = 0; i < count; ++i)
    rays.push_back(
        make_ray(random.in_box(glm::vec3(-11), glm::vec3(11)), random.on_sphere(), 0, t_max));
  return rays;
}

void expect_identical(const std::vector<TracedHit>& hits, const std::vector<TracedHit>& due) {
  ASSERT_EQ(hits.size(), due.size());
  size_t different = 0;
  for (size_t i = 0; i < hits.size(); ++i) different += !identical(hits[i], due[i], false);
  EXPECT_EQ(different, 0u);
}

// In double precision; rays of 2 m, so that some meet nothing.
TEST_F(BvhTracerTest, MeetsWhatExactGeometrySays) {
  const Triangles triangles = random_triangles(3000);
  const std::vector<TracedRay> rays = random_rays(3000, 2);
  build(triangles);
  const Oracle oracle(triangles);
  for (bool any_hit : {false, true}) {
    const std::vector<TracedHit> hits = trace(rays, {.any_hit = any_hit}).hits;
    size_t wrong = 0, met = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      wrong += !oracle.allows(rays[i], hits[i], any_hit);
      met += hits[i].primitive != shared::NO_PRIMITIVE;
    }
    EXPECT_EQ(wrong, 0u) << (any_hit ? "any hit" : "closest");
    EXPECT_GT(met, rays.size() / 10);
    EXPECT_LT(met, rays.size() * 9 / 10);
  }
}

// What lies in an interrupted leaf is tested after the next nodes: some more of them may be visited.
TEST_F(BvhTracerTest, InterruptedRaysMeetTheSame) {
  const RayScene scene = atrium();
  build(scene.triangles);
  const std::vector<TracedRay> rays = primary_rays(scene, 4096).rays;
  const Traced whole = trace(rays, {.count_work = true});
  EXPECT_EQ(whole.dispatches, 1);
  for (int budget : {7, 50}) {
    const Traced parts = trace(rays, {.count_work = true}, budget);
    EXPECT_GT(parts.dispatches, 1) << budget;
    expect_identical(parts.hits, whole.hits);
    uint64_t steps = 0, due = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      EXPECT_GE(parts.work[i].steps, whole.work[i].steps) << budget;
      steps += parts.work[i].steps;
      due += whole.work[i].steps;
    }
    EXPECT_LE(steps, due + due / 20) << budget;
  }
}

// More than llvmpipe would do in one dispatch. The stack is deeper than its part in registers.
TEST_F(BvhTracerTest, AHeapIsTraversedInSeveralDispatches) {
  constexpr uint32_t kMany = 100'000, kHidden = 3;
  Triangles heap(kMany, make_triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0}));
  for (uint32_t i = 0; i < kHidden; ++i) heap[i].flags = shared::SEEN_BY_SHADOW;
  build(heap);
  std::vector<TracedRay> rays;
  for (int i = 0; i < 16; ++i) {
    rays.push_back(make_ray({0.01f * float(i), 0, 2}, {0, 0, -1}));
    rays.back().seen_by = shared::SEEN_BY_CAMERA;
  }
  rays.push_back(make_ray({3, 0, 2}, {0, 0, -1}));  // passes it by
  const Traced traced = trace(rays, {.count_work = true});
  EXPECT_GT(traced.dispatches, 5);
  for (size_t i = 0; i + 1 < rays.size(); ++i) {
    EXPECT_EQ(traced.hits[i].primitive, kHidden);
    EXPECT_EQ(traced.hits[i].t, 2.0f);
    EXPECT_EQ(traced.work[i].tests, kMany);
  }
  EXPECT_EQ(traced.hits.back().primitive, shared::NO_PRIMITIVE);
  const Traced any = trace(rays, {.any_hit = true});
  EXPECT_EQ(any.dispatches, 1);
  EXPECT_NE(any.hits.front().primitive, shared::NO_PRIMITIVE);
}

TEST_F(BvhTracerTest, GoesOnThroughCoplanarDuplicatesInTheirOrder) {
  constexpr uint32_t kLayers = 100;
  build(Triangles(kLayers, make_triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0})));
  TracedRay ray = make_ray({0.1f, 0.2f, 3}, {0, 0, -1});
  for (uint32_t layer = 0; layer < kLayers; ++layer) {
    const TracedHit hit = trace({ray}).hits[0];
    ASSERT_EQ(hit.primitive, layer);
    ray.t_min = hit.t;
    ray.after = hit.primitive;
  }
  EXPECT_EQ(trace({ray}).hits[0].primitive, shared::NO_PRIMITIVE);
}

// Along the axes, from planes of boxes and within them: no product may become NaN.
TEST_F(BvhTracerTest, RaysAlongTheAxesEnterBoxesByTheirSides) {
  constexpr int kCells = 8;
  Triangles wall;
  add_surface(wall, kCells, kCells,
              [](float u, float v) { return glm::vec3(kCells * u, kCells * v, 0); });
  build(wall);
  std::vector<TracedRay> rays;
  for (int y = 0; y <= kCells; ++y)
    for (int x = 0; x <= kCells; ++x)
      for (float zero : {0.0f, -0.0f}) rays.push_back(make_ray({x, y, 1}, {zero, zero, -1}));
  for (const TracedHit& hit : trace(rays).hits) {
    EXPECT_NE(hit.primitive, shared::NO_PRIMITIVE);
    EXPECT_EQ(hit.t, 1.0f);
  }
}

TEST_F(BvhTracerTest, FollowsTheListFromNothingToMuchAndBack) {
  const std::vector<TracedRay> rays = random_rays(64);
  const auto met = [&] {
    size_t count = 0;
    for (const TracedHit& hit : trace(rays).hits) count += hit.primitive != shared::NO_PRIMITIVE;
    return count;
  };
  build({});
  EXPECT_EQ(met(), 0u);
  build(random_triangles(5000));
  EXPECT_GT(met(), rays.size() / 2);
  const int64_t much = tracer.bytes();
  build({make_triangle({-100, -100, 0}, {100, -100, 0}, {0, 100, 0})});
  size_t facing = 0;
  for (const TracedRay& ray : rays) facing += ray.origin_z * ray.direction_z < 0;
  EXPECT_GT(met(), facing / 2);
  EXPECT_LE(met(), facing);
  EXPECT_LT(tracer.bytes(), much / 100);
}

TEST_F(BvhTracerTest, TooMuchForTheDriverIsASentence) {
  gl::DeviceInfo device = tracing_device().device();
  tracing_device().assign(random_triangles(100));
  for (int texels : {20, 200}) {  // for nodes; for triangles
    device.max_texture_buffer_texels = texels;
    BvhTracer small(device);
    try {
      tracing_device().build(small);
      FAIL() << "no error was thrown";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("hide or simplify objects"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace panoptes::test
