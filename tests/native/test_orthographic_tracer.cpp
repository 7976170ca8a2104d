// The orthographic structure's own: settings, pools that grow, cells that follow the scene. That its
// hits are right is for the catalogue (test_ray_hard_cases.cpp) and Embree.
#include "base/error.h"
#include "primitive_tracer/orthographic_tracer.h"
#include "rays/comparison.h"
#include "rays/ray_sets.h"
#include "rays/scenes.h"
#include "rays/shared_device.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace panoptes::test {
namespace {

using primitive_tracer::OrthographicSettings;
using primitive_tracer::OrthographicTracer;

std::vector<TracedRay> rays_through(const RayScene& scene) {
  std::vector<TracedRay> rays;
  for (const RaySet& set : aimed_rays(scene, 400))
    rays.insert(rays.end(), set.rays.begin(), set.rays.end());
  return rays;
}

// What `tracer` finds, built anew over `scene`.
std::vector<TracedHit> hits_of(OrthographicTracer& tracer, const RayScene& scene) {
  tracing_device().assign(scene.triangles);
  tracing_device().build(tracer);
  return tracing_device().trace(tracer, rays_through(scene)).hits;
}

void expect_identical(const std::vector<TracedHit>& hits, const std::vector<TracedHit>& due) {
  ASSERT_EQ(hits.size(), due.size());
  size_t different = 0, met = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    different += !identical(hits[i], due[i], false);
    met += due[i].primitive != shared::NO_PRIMITIVE;
  }
  EXPECT_EQ(different, 0u);
  EXPECT_GT(met, due.size() / 4);
}

TEST(OrthographicTracer, PoolsThatAreTooSmallGrow) {
  const RayScene scene = soup();
  OrthographicTracer usual, tiny({}, {.entries = 1, .blocks = 1, .nodes = 1, .offsets = 1, .ids = 1});
  const std::vector<TracedHit> due = hits_of(usual, scene);
  expect_identical(hits_of(tiny, scene), due);
  EXPECT_GT(tiny.counts().entries, 1000u);
  EXPECT_GT(tiny.counts().blocks, 1u);
  EXPECT_GT(tiny.counts().nodes, 1u);
  EXPECT_EQ(tiny.bytes(), usual.bytes());
  // Once grown, they are large enough.
  expect_identical(hits_of(tiny, scene), due);
}

TEST(OrthographicTracer, EachPoolGrowsByItself) {
  const RayScene scene = blob();
  OrthographicTracer usual;
  const std::vector<TracedHit> due = hits_of(usual, scene);
  const primitive_tracer::PoolSizes enough = primitive_tracer::first_sizes(1'000'000);
  for (int pool = 0; pool < 5; ++pool) {
    primitive_tracer::PoolSizes sizes = enough;
    (pool == 0   ? sizes.entries
     : pool == 1 ? sizes.blocks
     : pool == 2 ? sizes.nodes
     : pool == 3 ? sizes.offsets
                 : sizes.ids) = 3;
    SCOPED_TRACE(fmt::format("pool {}", pool));
    OrthographicTracer tracer({}, sizes);
    expect_identical(hits_of(tracer, scene), due);
  }
}

TEST(OrthographicTracer, SettingsChangeWorkAndNeverHits) {
  const RayScene scene = soup();
  OrthographicTracer usual;
  const std::vector<TracedHit> due = hits_of(usual, scene);
  for (const OrthographicSettings& settings :
       {OrthographicSettings{.tiles = 1}, {.tiles = 2, .divisions = 3}, {.tiles = 100},
        {.tiles = 512, .divisions = 0}, {.divisions = 4, .triangles_a_part = 1},
        {.buckets_per_triangle = 1}, {.buckets_per_triangle = 64}}) {
    SCOPED_TRACE(fmt::format("{} tiles, {} divisions, {} triangles, {} buckets", settings.tiles,
                             settings.divisions, settings.triangles_a_part,
                             settings.buckets_per_triangle));
    OrthographicTracer tracer(settings);
    expect_identical(hits_of(tracer, scene), due);
    if (settings.tiles) EXPECT_EQ(tracer.tiles(), int(std::bit_ceil(unsigned(settings.tiles))));
  }
}

TEST(OrthographicTracer, SettingsOutOfRangeAreRefused) {
  EXPECT_THROW(OrthographicTracer({.tiles = -1}), Error);
  EXPECT_THROW(OrthographicTracer({.tiles = 1025}), Error);
  EXPECT_THROW(OrthographicTracer({.divisions = 5}), Error);
  EXPECT_THROW(OrthographicTracer({.triangles_a_part = -1}), Error);
  EXPECT_THROW(OrthographicTracer({.buckets_per_triangle = 0}), Error);
}

TEST(OrthographicTracer, TilesFollowTheScene) {
  OrthographicTracer tracer;
  hits_of(tracer, box_room());
  const int few = tracer.tiles();
  const std::vector<TracedHit> first = hits_of(tracer, blob(0));
  EXPECT_GT(tracer.tiles(), few);
  // Fewer triangles again, in pools that are larger than they need.
  hits_of(tracer, box_room());
  EXPECT_EQ(tracer.tiles(), few);
  expect_identical(hits_of(tracer, blob(0)), first);
}

// Triangles that each cross most of the scene would have a cell each in every tile.
TEST(OrthographicTracer, ManyLargeTrianglesGetLargerTiles) {
  RayScene scene;
  Random random(5);
  for (int i = 0; i < 20'000; ++i)
    scene.triangles.push_back(make_triangle(random.in_box(glm::vec3(-1), glm::vec3(1)),
                                            random.in_box(glm::vec3(-1), glm::vec3(1)),
                                            random.in_box(glm::vec3(-1), glm::vec3(1))));
  OrthographicTracer tracer;
  tracing_device().assign(scene.triangles);
  tracing_device().build(tracer);
  EXPECT_LT(tracer.tiles(), 32);
  EXPECT_LE(tracer.counts().entries, 20'000u * 32 + (1u << 20));
  try {
    OrthographicTracer fixed({.tiles = 1024});
    tracing_device().build(fixed);
    FAIL() << fixed.counts().entries << " entries";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("fewer tiles"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace panoptes::test
