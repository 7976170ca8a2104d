// The structure of fragments: the hit cases of Figure 6.5, that all variants find the same, lists of any length, what
// pixels lose, and the way from view to view.
#include "base/error.h"
#include "fragment_scenes.h"
#include "rays/brute_force.h"
#include "rays/comparison.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace panoptes::test {
namespace {

using fragment_tracer::CameraView;
using fragment_tracer::FragmentTracer;
using fragment_tracer::Settings;
using fragment_tracer::Storage;
using fragment_tracer::Views;
using fragment_tracer::Walk;

constexpr std::array<Storage, 5> kStorages{Storage::kArray, Storage::kList, Storage::kDoubleList, Storage::kBucketList,
                                           Storage::kDoubleBucketList};

// Every storage with and without decoupled data and skipping, on either walk that misses no pixel; arrays by either
// search.
std::vector<Settings> variants(Settings settings) {
  std::vector<Settings> found;
  for (Storage storage : kStorages)
    for (int bits = 0; bits < 8; ++bits) {
      settings.storage = storage;
      settings.decoupled = bits & 1;
      settings.skipping = bits & 2;
      settings.walk = settings.decoupled == settings.skipping ? Walk::kHierarchy : Walk::kEveryPixel;
      settings.binary_search = bits & 4;
      if (storage == Storage::kArray || settings.binary_search) found.push_back(settings);
    }
  return found;
}

std::string name(const Settings& s) {
  return fmt::format("{}{}{}{}, {}", fragment_tracer::kStorageNames[size_t(s.storage)], s.decoupled ? " decoupled" : "",
                     s.skipping ? " skipping" : "", s.binary_search ? " binary" : "",
                     fragment_tracer::kWalkNames[size_t(s.walk)]);
}

constexpr uint32_t kMiss = shared::NO_PRIMITIVE;

struct HitCase {
  const char* name;
  float from, to;  // along x
  uint32_t due;
};

// Figure 6.5, on fragments at 10, 20, ..., 50 in four buckets.
constexpr std::array<HitCase, 10> kHitCases{{
    {"ra, before all", 1, 8, kMiss},
    {"rd, behind all", 55, 80, kMiss},
    {"rd, behind all, to the eye", 80, 55, kMiss},
    {"rb, several buckets, away", 25, 90, 2},
    {"rb, several buckets, to the eye", 90, 5, 4},
    {"rc, one bucket", 28, 32, 2},
    {"r1, one fragment", 18, 22, 1},
    {"r2, several fragments, away", 8, 45, 0},
    {"r3, none between two", 32, 38, kMiss},
    {"r4, several fragments, to the eye", 45, 8, 3},
}};

TEST(FragmentTracer, MeetsTheHitCasesOfTheThesis) {
  tracing_device().assign(layers({10, 20, 30, 40, 50}));
  std::vector<TracedRay> rays;
  // All within one pixel, which is 1/32 of the depth wide.
  for (const HitCase& c : kHitCases)
    rays.push_back(ray_between(c.from * glm::vec3(1, 0.01f, 0.01f), c.to * glm::vec3(1, 0.02f, 0.01f)));
  for (const Settings& settings : variants(by_depth())) {
    FragmentTracer tracer(settings, glm::vec3(0), {});
    const std::vector<TracedHit> hits = hits_of(tracer, rays);
    for (size_t i = 0; i < kHitCases.size(); ++i)
      EXPECT_EQ(hits[i].primitive, kHitCases[i].due) << kHitCases[i].name << ": " << name(settings);
  }
}

CameraView camera_view() {
  CameraView view;
  view.right = {0, -1, 0};
  view.up = {0, 0, 1};
  view.forward = {1, 0, 0};
  view.half_extent = {0.6f, 0.45f};
  view.size = {160, 120};
  return view;
}

std::vector<TracedHit> due_hits(const std::vector<TracedRay>& rays) {
  BruteForceTracer tracer;
  return hits_of(tracer, rays);
}

struct Agreement {
  double lost = 0, same = 0, near = 0;  // shares of all rays; near: t within 1 %
};

Agreement compare(const std::vector<TracedHit>& hits, const std::vector<TracedHit>& due) {
  Agreement found;
  for (size_t i = 0; i < due.size(); ++i) {
    found.lost += due[i].primitive != kMiss && hits[i].primitive == kMiss;
    found.same += due[i].primitive == hits[i].primitive;
    found.near += std::abs(due[i].t - hits[i].t) <= 0.01f * due[i].t;
  }
  const double rays = double(due.size());
  return {found.lost / rays, found.same / rays, found.near / rays};
}

TEST(FragmentTracer, VariantsFindTheSame) {
  const Room room;
  tracing_device().assign(room.triangles);
  const std::vector<TracedRay> rays = rays_in_room(2000);
  for (bool by_plane : {false, true}) {
    Settings settings;
    settings.side = 64;
    settings.by_plane = by_plane;
    std::vector<TracedHit> first;
    for (const Settings& variant : variants(settings)) {
      FragmentTracer tracer(variant, room.eye, camera_view());
      const std::vector<TracedHit> hits = hits_of(tracer, rays);
      if (first.empty()) first = hits;
      size_t unlike = 0;
      for (size_t i = 0; i < hits.size(); ++i) unlike += !agree(rays[i], hits[i], first[i], false);
      EXPECT_EQ(unlike, 0u) << name(variant) << ", by plane " << by_plane;
    }
  }
}

TEST(FragmentTracer, FindsByThePlaneWhatTheTrianglesGive) {
  const Room room;
  tracing_device().assign(room.triangles);
  const std::vector<TracedRay> rays = rays_in_room(20000);
  const std::vector<TracedHit> due = due_hits(rays);
  double lost = 1;
  for (int side : {64, 128, 256, 512}) {
    Settings settings;
    settings.side = side;
    FragmentTracer tracer(settings, room.eye, camera_view());
    const Agreement found = compare(hits_of(tracer, rays), due);
    fmt::print("{} pixels: lost {:.4f}, same primitive {:.4f}, t within 1 % {:.4f}, {} fragments\n", side, found.lost,
               found.same, found.near, tracer.fragments());
    settings.by_plane = false;
    FragmentTracer thesis(settings, room.eye, camera_view());
    const Agreement other = compare(hits_of(thesis, rays), due);
    fmt::print("   by depth: lost {:.4f}, same primitive {:.4f}, t within 1 % {:.4f}\n", other.lost, other.same,
               other.near);
    EXPECT_GT(found.near, other.near);
    lost = found.lost;
  }
  EXPECT_LT(lost, 0.001);
}

TEST(FragmentTracer, ListsOfAnyLengthAreSorted) {
  std::vector<float> depths;
  for (int i = 0; i < 2000; ++i) depths.push_back(10.0f + 0.05f * float((i * 1237) % 2000));
  tracing_device().assign(layers(depths));
  // A view so narrow that a ray is blind for less than the way between two layers.
  CameraView view = camera_view();
  view.size = glm::ivec2(4);
  view.half_extent = glm::vec2(4e-5f);
  const glm::vec3 axis(1, 1e-5f, 1e-5f);
  std::vector<TracedRay> rays;
  std::vector<uint32_t> due;
  for (uint32_t i = 0; i < 2000; i += 97)
    for (float way : {0.03f, -0.03f}) {
      rays.push_back(ray_between((depths[i] - way) * axis, (depths[i] + way) * axis));
      due.push_back(i);
    }
  for (Storage storage : kStorages) {
    Settings settings = by_depth();
    settings.views = Views::kCamera;
    settings.storage = storage;
    FragmentTracer tracer(settings, glm::vec3(0), view);
    const std::vector<TracedHit> hits = hits_of(tracer, rays);
    EXPECT_EQ(tracer.fragments(), 16u * 2000);
    EXPECT_GE(tracer.longest_list(), fragment_tracer::has_buckets(storage) ? 500u : 2000u);
    for (size_t i = 0; i < due.size(); ++i) EXPECT_EQ(hits[i].primitive, due[i]) << int(storage) << ", ray " << i;
  }
}

TEST(FragmentTracer, EqualDepthsAreInTheOrderOfPrimitives) {
  tracing_device().assign(layers({20, 20, 20, 20}));
  const std::vector<TracedRay> away{ray_between({10, 0.1f, 0.1f}, {30, 0.4f, 0.3f})};
  for (Storage storage : kStorages) {
    Settings settings = by_depth();
    settings.storage = storage;
    FragmentTracer tracer(settings, glm::vec3(0), {});
    EXPECT_EQ(hits_of(tracer, away)[0].primitive, 0u) << int(storage);
  }
}

TEST(FragmentTracer, ASurfaceThatTheEyeSeesEdgeOnHasNoFragments) {
  Triangles triangles;
  add_quad(triangles, {2, -1, 0}, {4, -1, 0}, {4, 1, 0}, {2, 1, 0});
  tracing_device().assign(triangles);
  const std::vector<TracedRay> through{ray_between({3, 0.1f, 1}, {3, 0.1f, -1})};
  EXPECT_NE(due_hits(through)[0].primitive, kMiss);
  for (bool by_plane : {false, true}) {
    Settings settings = by_depth();
    settings.by_plane = by_plane;
    FragmentTracer tracer(settings, glm::vec3(0), {});
    EXPECT_EQ(hits_of(tracer, through)[0].primitive, kMiss);
    EXPECT_EQ(tracer.fragments(), 0u);
  }
}

TEST(FragmentTracer, GrowsWhereFragmentsAreMoreThanExpected) {
  const Room room;
  tracing_device().assign(room.triangles);
  const std::vector<TracedRay> rays = rays_in_room(500);
  Settings settings;
  settings.side = 32;
  FragmentTracer roomy(settings, room.eye, {}), narrow(settings, room.eye, {}, 8);
  const std::vector<TracedHit> due = hits_of(roomy, rays), hits = hits_of(narrow, rays);
  EXPECT_GT(narrow.fragments(), 8u);
  EXPECT_EQ(narrow.fragments(), roomy.fragments());
  for (size_t i = 0; i < due.size(); ++i) EXPECT_TRUE(identical(hits[i], due[i], false));
}

TEST(FragmentTracer, RaysGoOverFromViewToView) {
  // Along edges and corners of the cube, and through the eye: a closed room loses none of them.
  const Room room;
  tracing_device().assign(room.triangles);
  std::vector<TracedRay> rays;
  Random random(5);
  for (int i = 0; i < 3000; ++i) {
    const glm::vec3 corner(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    const glm::vec3 edge = i % 3 == 0 ? corner : i % 3 == 1 ? corner * glm::vec3(1, 1, 0) : corner * glm::vec3(1, 0, 1);
    const glm::vec3 from = room.eye + 0.3f * edge * random.in_box(glm::vec3(0), glm::vec3(1)).x;
    rays.push_back(make_ray(from, i % 2 ? edge : -edge));
  }
  const std::vector<TracedHit> due = due_hits(rays);
  for (Walk walk : {Walk::kEveryPixel, Walk::kHierarchy}) {
    Settings settings;
    settings.side = 256;
    settings.walk = walk;
    FragmentTracer tracer(settings, room.eye, camera_view());
    const Agreement found = compare(hits_of(tracer, rays), due);
    EXPECT_LT(found.lost, 0.005);
    EXPECT_GT(found.near, 0.98);
  }
}

TEST(FragmentTracer, RaysThatAreCutOffGoOn) {
  const Room room;
  tracing_device().assign(room.triangles);
  const std::vector<TracedRay> rays = rays_in_room(500);
  for (Walk walk : {Walk::kEveryPixel, Walk::kSteps, Walk::kHierarchy})
    for (Storage storage : kStorages) {
      Settings settings;
      settings.side = 64;
      settings.walk = walk;
      settings.storage = storage;
      FragmentTracer tracer(settings, room.eye, camera_view());
      const std::vector<TracedHit> due = hits_of(tracer, rays);
      const Traced cut = tracing_device().trace(tracer, rays, {}, 7);
      EXPECT_GT(cut.dispatches, 2);
      for (size_t i = 0; i < due.size(); ++i) EXPECT_TRUE(identical(cut.hits[i], due[i], false)) << i;
    }
}

TEST(FragmentTracer, RefusesWhatMakesNoSense) {
  const auto refused = [](auto change) {
    Settings settings;
    change(settings);
    EXPECT_THROW(FragmentTracer(settings, glm::vec3(0), {}), Error);
  };
  refused([](Settings& s) { s.side = 0; });
  refused([](Settings& s) { s.buckets = 65; });
  refused([](Settings& s) { s.layers = 2; });
  refused([](Settings& s) { s.thickness = -1; });
  refused([](Settings& s) { s.views = Views::kCamera; });
}

}  // namespace
}  // namespace panoptes::test
