// When a sun's shadow maps follow the camera, and what they then show. No GL.
#include "rasterize/shadow_maps.h"
#include "rasterize/sun_cascades.h"
#include "support.h"

#include <cmath>

namespace panoptes::test {
namespace {

using rasterize::choose_cascades;
using rasterize::Slab;

constexpr double kPixel = 1e-3;  // of a camera 50 degrees wide with 960 pixels
constexpr int kResolution = 2048;

scene::Bounds cube(double half) {
  scene::Bounds b;
  b.add(glm::vec3(float(-half)));
  b.add(glm::vec3(float(half)));
  return b;
}

// A floor seen from one to `farthest` metres: each slab of distance as wide as it is far.
std::vector<Slab> floor_seen_from(double nearest, double farthest) {
  std::vector<Slab> slabs;
  for (double d = nearest; d < farthest; d *= 2) {
    scene::Bounds b;
    b.add(glm::vec3(glm::dvec3(d, -d, 0)));
    b.add(glm::vec3(glm::dvec3(2 * d, d, 0.1)));
    slabs.push_back({d, b, 1000});
  }
  return slabs;
}

TEST(Cascades, SmallScenesAndEmptyViewsNeedNone) {
  EXPECT_TRUE(choose_cascades({}, cube(1000), kPixel, true, kResolution).empty());
  // Seen from outside, a pixel covers more than a texel.
  EXPECT_TRUE(choose_cascades(floor_seen_from(4, 8), cube(2), kPixel, true, kResolution).empty());
  // Without perspective a pixel has one width everywhere.
  EXPECT_TRUE(choose_cascades(floor_seen_from(1, 1000), cube(500), 0.5, false, kResolution).empty());
}

TEST(Cascades, HalfOfThePixelsAreNearerThanTheMedianDistance) {
  EXPECT_EQ(rasterize::median_distance({}), 0);
  EXPECT_EQ(rasterize::median_distance({{1, cube(1), 50}, {2, cube(1), 50}}), 2);
  EXPECT_NEAR(rasterize::median_distance({{1, cube(1), 10}, {8, cube(1), 100}, {64, cube(1), 10}}), 8 * std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(rasterize::median_distance({{4, cube(1), 1}}), 4 * std::sqrt(2.0), 1e-9);
}

TEST(Cascades, LargeScenesGetMapsThatResolveWhatIsSeen) {
  const std::vector<Slab> slabs = floor_seen_from(1, 1024);
  const auto cascades = choose_cascades(slabs, cube(5000), kPixel, true, kResolution);
  ASSERT_GE(cascades.size(), 2u);
  ASSERT_LE(cascades.size(), rasterize::kMostCascades);
  // Everything that is seen lies in some cascade whose texels are fine enough for it.
  for (const Slab& slab : slabs) {
    bool covered = false;
    for (const scene::Bounds& c : cascades) {
      const bool inside = glm::all(glm::lessThanEqual(c.low, slab.bounds.low)) &&
                          glm::all(glm::greaterThanEqual(c.high, slab.bounds.high));
      const double texel = glm::length(c.high - c.low) / kResolution;
      covered = covered || (inside && texel < 20 * kPixel * slab.nearest);
    }
    EXPECT_TRUE(covered) << "at " << slab.nearest << " m";
  }
}

TEST(Cascades, ATwigBeforeTheLensDoesNotCount) {
  std::vector<Slab> slabs = floor_seen_from(64, 256);
  Slab twig = floor_seen_from(0.01, 0.015)[0];
  twig.pixels = 5;
  const scene::Bounds scene = cube(100);
  const auto without = choose_cascades(slabs, scene, kPixel, true, kResolution);
  slabs.insert(slabs.begin(), twig);
  EXPECT_EQ(choose_cascades(slabs, scene, kPixel, true, kResolution).size(), without.size());
}

TEST(Cascades, EachIsASunMapThatReachesUpToEveryCaster) {
  const scene::Bounds scene = cube(5000);
  const auto regions = choose_cascades(floor_seen_from(1, 1024), scene, kPixel, true, kResolution);
  rasterize::Placement placement;
  placement.bounds = scene;
  placement.sun_cascades = regions;
  placement.resolution = kResolution;
  const auto set = rasterize::place_lights({sun({0.3f, 0.2f, -1}, 1)}, {}, {}, placement);
  ASSERT_EQ(set.lights[0].views.size(), regions.size());
  EXPECT_EQ(set.lights[0].light.faces, regions.size());
  for (const auto& view : set.lights[0].views)
    for (int i = 0; i < 8; ++i) {
      const glm::dvec3 corner(i & 1 ? 5000 : -5000, i & 2 ? 5000 : -5000, i & 4 ? 5000 : -5000);
      EXPECT_GT(glm::dot(corner - view->origin, view->axis), view->near_depth);
    }
}

}  // namespace
}  // namespace panoptes::test
