// Every row of the catalogue of hard cases (rays/hard_cases.h) through every ray tracer.
#include "base/error.h"
#include "fragment_tracer/fragment_tracer.h"
#include "rays/brute_force.h"
#include "rays/comparison.h"
#include "rays/hard_cases.h"
#include "rays/oracle.h"
#include "rays/shared_device.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace panoptes::test {
namespace {

// A row, and what brute force finds for it.
struct PreparedCase {
  HardCase row;
  std::vector<TracedHit> due;
};

// Puts the row's triangles onto the device.
const PreparedCase& prepare(const HardCaseMaker& maker) {
  static std::map<std::string, PreparedCase> all;
  TracingDevice& device = tracing_device();
  const auto [found, fresh] = all.try_emplace(maker.name);
  PreparedCase& prepared = found->second;
  if (fresh) prepared.row = maker.make();
  device.assign(prepared.row.triangles);
  if (fresh) {
    BruteForceTracer tracer;
    device.build(tracer);
    prepared.due = device.trace(tracer, prepared.row.rays).hits;
  }
  return prepared;
}

void expect_finite(const TracedRay& ray, const TracedHit& hit) {
  EXPECT_TRUE(std::isfinite(hit.t)) << describe(ray, hit);
  if (hit.primitive == shared::NO_PRIMITIVE) {
    EXPECT_EQ(hit.t, ray.t_max) << describe(ray, hit);
    return;
  }
  EXPECT_GE(hit.t, ray.t_min) << describe(ray, hit);
  EXPECT_LE(hit.t, ray.t_max) << describe(ray, hit);
  // Both weights are rounded from parts of one sum.
  constexpr float kRounding = 4 * 0x1p-24f;
  EXPECT_GE(hit.u, 0) << describe(ray, hit);
  EXPECT_GE(hit.v, 0) << describe(ray, hit);
  EXPECT_LE(hit.u + hit.v, 1 + kRounding) << describe(ray, hit);
}

void expect_same(const PreparedCase& c, const std::vector<TracedHit>& hits, bool any_hit,
                 const char* what) {
  ASSERT_EQ(hits.size(), c.due.size());
  size_t wrong = 0;
  for (size_t i = 0; i < hits.size(); ++i)
    if (!identical(hits[i], c.due[i], any_hit) && wrong++ < 3)
      ADD_FAILURE() << what << ": ray " << i << ": " << describe(c.row.rays[i], hits[i])
                    << ", but by all triangles it " << describe(c.row.rays[i], c.due[i]);
  EXPECT_EQ(wrong, 0u) << what << ": of " << hits.size() << " rays";
}

class RayHardCases : public ::testing::TestWithParam<HardCaseMaker> {};

// What the row states, and what exact geometry says within the rounding of float32.
TEST_P(RayHardCases, TheTestOfATriangleIsRight) {
  const PreparedCase& c = prepare(GetParam());
  const Oracle oracle(c.row.triangles);
  ASSERT_EQ(c.row.rays.size(), c.row.due.size());
  for (size_t i = 0; i < c.due.size(); ++i) {
    const TracedHit& hit = c.due[i];
    SCOPED_TRACE(fmt::format("ray {}", i));
    expect_finite(c.row.rays[i], hit);
    EXPECT_TRUE(oracle.allows(c.row.rays[i], hit)) << describe(c.row.rays[i], hit);
    const uint32_t due = c.row.due[i];
    if (due == kSomething) {
      EXPECT_NE(hit.primitive, shared::NO_PRIMITIVE) << describe(c.row.rays[i], hit);
    } else if (due != kOpen) {
      EXPECT_EQ(hit.primitive, due) << describe(c.row.rays[i], hit);
    }
    if (HasFailure()) break;
  }
}

// Each tracer finds the same bits as a test of all triangles does: at once, when it is interrupted
// again and again, and when it may stop at whatever it meets.
TEST_P(RayHardCases, NoTracerLosesOrInventsAHit) {
  const PreparedCase& c = prepare(GetParam());
  TracingDevice& device = tracing_device();
  for (const TracerEntry& entry : tracers()) {
    SCOPED_TRACE(entry.name);
    const auto tracer = entry.make(device.device());
    ASSERT_NO_THROW(device.build(*tracer));
    expect_same(c, device.trace(*tracer, c.row.rays).hits, false, "closest");
    expect_same(c, device.trace(*tracer, c.row.rays, {.any_hit = true}).hits, true, "any");
    // The slow ones would be interrupted for ever.
    const int budget = entry.slow ? 1000 : 40;
    expect_same(c, device.trace(*tracer, c.row.rays, {}, budget).hits, false, "interrupted");
    device.build(*tracer);
    expect_same(c, device.trace(*tracer, c.row.rays).hits, false, "built again");
  }
}

// Fragments are an approximation, so what they lose is a table (`./panoptes bench rays --hard-cases`). But whatever they
// meet is finite, lies on the ray, and is the same in each build.
TEST_P(RayHardCases, FragmentsAreFiniteAndTheSameTwice) {
  const PreparedCase& c = prepare(GetParam());
  TracingDevice& device = tracing_device();
  for (bool by_plane : {true, false}) {
    fragment_tracer::Settings settings;
    settings.views = fragment_tracer::Views::kCube;
    settings.side = 16;
    settings.by_plane = by_plane;
    fragment_tracer::FragmentTracer tracer(settings, glm::vec3(0.013f, -0.017f, 0.011f), {});
    std::vector<TracedHit> first;
    for (int build = 0; build < 2; ++build) {
      try {
        device.build(tracer);
      } catch (const Error& error) {
        // 100 000 surfaces in a pixel: it says what would fit.
        EXPECT_NE(std::string(error.what()).find("pixels a side of the cube or fewer"), std::string::npos);
        EXPECT_GT(c.row.triangles.size(), 50'000u) << error.what();
        return;
      }
      const std::vector<TracedHit> hits = device.trace(tracer, c.row.rays).hits;
      for (size_t i = 0; i < hits.size() && !HasFailure(); ++i) expect_finite(c.row.rays[i], hits[i]);
      if (build == 0) first = hits;
      EXPECT_EQ(count_unlike(hits, first, false), 0u) << "by plane " << by_plane;
    }
  }
}

// Going on behind each surface, rays meet all of them in order and each just once.
TEST_P(RayHardCases, EverySurfaceOnTheWayIsMetOnce) {
  constexpr size_t kRays = 32;
  constexpr int kSurfaces = 24;
  const PreparedCase& c = prepare(GetParam());
  TracingDevice& device = tracing_device();
  std::vector<TracedRay> starts;
  for (size_t i = 0; i < std::min(kRays, c.row.rays.size()); ++i)
    starts.push_back(c.row.rays[i * c.row.rays.size() / std::min(kRays, c.row.rays.size())]);
  std::vector<std::vector<TracedHit>> due;  // of the first tracer, surface after surface
  for (const TracerEntry& entry : tracers()) {
    SCOPED_TRACE(entry.name);
    const auto tracer = entry.make(device.device());
    device.build(*tracer);
    std::vector<TracedRay> rays = starts;
    for (int surface = 0; surface < kSurfaces && !HasFailure(); ++surface) {
      const std::vector<TracedHit> hits = device.trace(*tracer, rays).hits;
      if (&entry == &tracers().front()) due.push_back(hits);
      for (size_t i = 0; i < hits.size(); ++i) {
        EXPECT_TRUE(identical(hits[i], due[size_t(surface)][i], false))
            << "surface " << surface << ": " << describe(rays[i], hits[i]);
        if (hits[i].primitive == shared::NO_PRIMITIVE) continue;
        const bool later = hits[i].t > rays[i].t_min ||
                           (hits[i].t == rays[i].t_min && hits[i].primitive > rays[i].after);
        EXPECT_TRUE(later) << describe(rays[i], hits[i]);
        rays[i].t_min = hits[i].t;
        rays[i].after = hits[i].primitive;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, RayHardCases, ::testing::ValuesIn(hard_cases()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace panoptes::test
