// The build of the structure of fragments: what views leave out, bounds of depth by boxes, a bounded number of layers, and
// what cannot be held.
#include "base/error.h"
#include "fragment_scenes.h"
#include "rays/comparison.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace panoptes::test {
namespace {

using fragment_tracer::Bounds;
using fragment_tracer::FragmentTracer;
using fragment_tracer::Settings;
using fragment_tracer::Storage;

// A ball about the eye.
Triangles ball(int columns, int rows) {
  Triangles triangles;
  add_surface(triangles, columns, rows, [](float u, float v) {
    const float a = 2 * std::numbers::pi_v<float> * (u < 1 ? u : 0), b = std::numbers::pi_v<float> * v;
    return 5.0f * glm::vec3(std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), std::cos(b));
  });
  return triangles;
}

TEST(FragmentBuild, ViewsLeaveOutNoTriangleThatHasAPixel) {
  // Closed, so that every pixel has one fragment, be triangles larger than pixels or far smaller.
  for (const auto& [columns, rows] : {std::pair{8, 6}, {60, 40}, {700, 400}}) {
    tracing_device().assign(ball(columns, rows));
    Settings settings = by_depth();
    settings.side = 48;
    FragmentTracer tracer(settings, glm::vec3(0.1f, 0.2f, -0.15f), {});
    tracing_device().build(tracer);
    EXPECT_EQ(tracer.fragments(), 6u * 48 * 48) << columns;
    EXPECT_EQ(tracer.longest_list(), 1u) << columns;
    EXPECT_EQ(tracer.used_lists(), 6u * 48 * 48) << columns;
  }
}

TEST(FragmentBuild, BoundsByBoxesFindTheSame) {
  const Room room;
  tracing_device().assign(room.triangles);
  const std::vector<TracedRay> rays = rays_in_room(2000);
  for (Storage storage : {Storage::kBucketList, Storage::kDoubleBucketList})
    for (bool by_plane : {false, true}) {
      Settings settings;
      settings.side = 64;
      settings.storage = storage;
      settings.by_plane = by_plane;
      FragmentTracer exact(settings, room.eye, {});
      const std::vector<TracedHit> due = hits_of(exact, rays);
      settings.bounds = Bounds::kBoxes;
      FragmentTracer boxes(settings, room.eye, {});
      const std::vector<TracedHit> hits = hits_of(boxes, rays);
      EXPECT_EQ(boxes.fragments(), exact.fragments());
      size_t unlike = 0;
      for (size_t i = 0; i < hits.size(); ++i) unlike += !agree(rays[i], hits[i], due[i], false);
      EXPECT_EQ(unlike, 0u) << int(storage) << ", by plane " << by_plane;
    }
}

TEST(FragmentBuild, BoxesBeforeAndAboutTheEyeBoundTheirFragments) {
  // Of some boxes the eye sees the outside, one holds it, and one is flat.
  Triangles triangles;
  add_box(triangles, glm::vec3(-6), glm::vec3(6));
  add_box(triangles, {2, -1, -1}, {3, 1, 1});
  add_quad(triangles, {-3, -2, -2}, {-3, 2, -2}, {-3, 2, 2}, {-3, -2, 2});
  tracing_device().assign(triangles);
  Settings settings = by_depth();
  settings.bounds = Bounds::kBoxes;
  settings.thickness = 0.01f;
  FragmentTracer tracer(settings, glm::vec3(0.05f, 0.1f, -0.07f), {});
  const std::vector<TracedHit> hits =
      hits_of(tracer, {ray_between({0.5f, 0, 0}, {8, 0.2f, 0.1f}), ray_between({-0.5f, 0, 0}, {-8, 0.3f, 0.1f}),
                       ray_between({0, 0.5f, 0.1f}, {0.1f, 8, 0.2f})});
  for (const TracedHit& hit : hits) EXPECT_NE(hit.primitive, shared::NO_PRIMITIVE);
  EXPECT_NEAR(0.5f + 7.5f * hits[0].t, 2, 0.05);
  EXPECT_NEAR(-0.5f - 7.5f * hits[1].t, -3, 0.05);
  EXPECT_NEAR(0.5f + 7.5f * hits[2].t, 6, 0.1);
}

TEST(FragmentBuild, KeepsTheNearestLayers) {
  tracing_device().assign(layers({10, 20, 30, 40, 50}));
  const std::vector<TracedRay> rays{ray_between({8, 0.1f, 0.1f}, {60, 1.2f, 0.6f}),
                                    ray_between({60, 1.2f, 0.6f}, {8, 0.1f, 0.1f})};
  for (Storage storage : {Storage::kArray, Storage::kList, Storage::kDoubleList}) {
    Settings settings = by_depth();
    settings.storage = storage;
    settings.layers = 2;
    FragmentTracer tracer(settings, glm::vec3(0), {});
    const std::vector<TracedHit> hits = hits_of(tracer, rays);
    EXPECT_EQ(hits[0].primitive, 0u);
    EXPECT_EQ(hits[1].primitive, 1u);
  }
}

TEST(FragmentBuild, ABoundedNumberOfLayersBoundsWhatIsStored) {
  // The farthest first, so that each that follows drives another out.
  std::vector<float> depths;
  for (int i = 0; i < 2000; ++i) depths.push_back(30 - 0.01f * float(i));
  tracing_device().assign(layers(depths));
  Settings settings = by_depth();
  settings.side = 16;
  settings.storage = Storage::kArray;
  settings.layers = 4;
  FragmentTracer tracer(settings, glm::vec3(0), {});
  const std::vector<TracedHit> hits = hits_of(tracer, {ray_between({1, 0.1f, 0.1f}, {40, 4, 2})});
  EXPECT_EQ(hits[0].primitive, 1999u);
  EXPECT_EQ(tracer.longest_list(), 4u);
  EXPECT_EQ(tracer.fragments(), 4u * tracer.used_lists());
}

// What `tracer` says where it cannot be built; '' where it can.
std::string complaint(FragmentTracer& tracer) {
  try {
    tracing_device().build(tracer);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(FragmentBuild, SaysWhichResolutionFitsWhereThePixelsCannotBeHeld) {
  const Room room;
  tracing_device().assign(room.triangles);
  Settings settings;
  settings.side = 4096;
  settings.buckets = 64;
  FragmentTracer tracer(settings, room.eye, {});
  EXPECT_NE(complaint(tracer).find("pixels a side of the cube or fewer"), std::string::npos) << complaint(tracer);
}

TEST(FragmentBuild, TheResolutionThatItNamesForFragmentsFits) {
  const Room room;
  tracing_device().assign(room.triangles);
  constexpr int64_t kMost = 20000;
  Settings settings;
  settings.views = fragment_tracer::Views::kCube;
  settings.side = 128;
  FragmentTracer large(settings, room.eye, {}, 0, kMost);
  std::string said = complaint(large);
  // Far past the limit the scene's fragments are not counted to the end, so that it takes a second answer.
  for (int asked = 0; asked < 2 && !said.empty(); ++asked) {
    const size_t at = said.find("choose ");
    ASSERT_NE(at, std::string::npos) << said;
    settings.side = std::stoi(said.substr(at + 7));
    FragmentTracer smaller(settings, room.eye, {}, 0, kMost);
    said = complaint(smaller);
    if (said.empty()) {
      EXPECT_GT(smaller.fragments(), kMost / 2);
    }
  }
  EXPECT_EQ(said, "");
}

TEST(FragmentBuild, CountsNoFurtherThanItHasTo) {
  tracing_device().assign(layers(std::vector<float>(500, 20.0f)));
  constexpr int64_t kMost = 1000;
  Settings settings = by_depth();
  FragmentTracer tracer(settings, glm::vec3(0), {}, 0, kMost);
  const std::string said = complaint(tracer);
  const size_t at = said.find("at least ");
  ASSERT_NE(at, std::string::npos) << said;
  // Of 2 million; the invocations at work when the limit is reached may pass it.
  const long long counted = std::stoll(said.substr(at + 9));
  EXPECT_GE(counted, 4 * kMost);
  EXPECT_LT(counted, 8 * kMost);
}

}  // namespace
}  // namespace panoptes::test
