// Light of the radiance cache beside thin walls: two closed rooms beside each other, of which one has a
// lamp. None of its light may be in the other, and none of it lost.
#include "support.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <numbers>

namespace panoptes::test {
namespace {

using film::Pass;

struct Walls {
  double thickness = 0;  // m; 0: a single face
  double turn = 0;       // of both rooms about z, degrees
  glm::dvec3 shift{0};   // m
};

// Rooms of 2 m, the dark one at x < 0, about a place of their own.
glm::dmat4 place_of(const Walls& walls) {
  return glm::rotate(glm::translate(glm::dmat4(1), walls.shift),
                     walls.turn * std::numbers::pi / 180, glm::dvec3(0, 0, 1));
}

TestScene rooms(const Walls& walls, bool neighbour) {
  TestScene s;
  const Id grey = s.add_material(lambert(glm::vec3(0.5f)));
  const glm::mat4 place(place_of(walls));
  const float half = 0.5f * float(walls.thickness);
  Geometry shell;
  if (walls.thickness > 0) {
    shell = box({0.5f * (2 + half), 0, 0}, {0.5f * (2 - half), 1, 1});
    if (neighbour) shell.add(box({-0.5f * (2 + half), 0, 0}, {0.5f * (2 - half), 1, 1}));
  } else {
    shell = box({neighbour ? 0 : 1, 0, 0}, {neighbour ? 2 : 1, 1, 1});
    if (neighbour) shell.add(quad({0, 0, 0}, {0, 1, 0}, {0, 0, 1}));
  }
  s.add_object(shell, {grey}, place);
  scene::Light lamp = point({1, 0, 0}, 100);
  lamp.object_to_world = place * lamp.object_to_world;
  s.lights = {lamp};
  return s;
}

constexpr int kSide = 16;  // pixels

struct Irradiance {
  double direct = 0, bounced = 0;
};

// The mean over floor, ceiling and the four walls of the room about x = `middle`.
Irradiance irradiance_in(const Walls& walls, double middle, const radiance_cache::Settings& cache) {
  Irradiance sum;
  const glm::dmat4 place = place_of(walls);
  const auto world = [&](const glm::dvec3& p) { return glm::dvec3(place * glm::dvec4(p, 1)); };
  const std::vector<glm::dvec3> ways{{0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
  for (const glm::dvec3& way : ways) {
    const glm::dvec3 eye = glm::dvec3(middle, 0, 0);
    engine::RenderRequest r = request(
        orthographic(world(eye), world(eye + way), 0.97, kSide, kSide), {Pass::kDiffDir, Pass::kDiffInd});
    r.cache = cache;
    r.shadow_resolution = 1024;  // what passes by a shadow map's edges is none of the cache's
    r.occlusion.strength = 0;
    const Picture p = render(r);
    for (int y = 0; y < p.height; ++y)
      for (int x = 0; x < p.width; ++x) {
        sum.direct += p.value(Pass::kDiffDir, x, y, 1) / double(ways.size() * kSide * kSide);
        sum.bounced += p.value(Pass::kDiffInd, x, y, 1) / double(ways.size() * kSide * kSide);
      }
  }
  return sum;
}

// Light that arrives in the dark room, as a share of all in the bright one; `resolution` cells along both.
double leaked(const Walls& walls, int resolution, bool held_back) {
  const radiance_cache::Settings cache{.resolution = resolution, .cascades = 1, .walls = held_back};
  shared_engine().edit([&](scene::Scene& scene) { rooms(walls, true).install(scene); });
  const Irradiance dark = irradiance_in(walls, -1, cache), bright = irradiance_in(walls, 1, cache);
  return dark.bounced / (bright.direct + bright.bounced);
}

// Of the bright room's bounced light, what it has not got for having a neighbour.
double lost(const Walls& walls, int resolution) {
  const radiance_cache::Settings cache{.resolution = resolution, .cascades = 1};
  double bounced[2];
  for (bool neighbour : {false, true}) {
    shared_engine().edit([&](scene::Scene& scene) { rooms(walls, neighbour).install(scene); });
    bounced[neighbour] = irradiance_in(walls, 1, cache).bounced;
  }
  return 1 - bounced[1] / bounced[0];
}

TEST(CacheLeaks, LittlePassesAWallThatIsThinnerThanAVoxel) {
  for (double thickness : {0.0, 0.02})
    for (double shift : {0.0, 0.05}) {
      const Walls walls{thickness, 0, glm::dvec3(shift)};
      EXPECT_LT(leaked(walls, 28, true), 5e-4) << thickness << " m, moved by " << shift;
    }
}

TEST(CacheLeaks, LessThanHalfPassesAWallAtAnAngle) {
  for (int resolution : {12, 28}) {
    const Walls walls{0, 30, glm::dvec3(0.05)};
    const double held_back = leaked(walls, resolution, true), before = leaked(walls, resolution, false);
    EXPECT_LT(held_back, 0.5 * before) << resolution;
    EXPECT_LT(held_back, 0.012) << resolution;
  }
}

// A voxel has both faces of such a wall in it, but one surfel: that of the dark side has the light of the
// bright one on its back.
TEST(CacheLeaks, AThinWallOfTwoFacesTakesNoLightAway) {
  for (double turn : {0.0, 30.0}) EXPECT_LT(lost({0.02, turn, glm::dvec3(0.05)}, 28), 0.02) << turn;
}

// Where walls run between voxels, none has enough of them to be solid by itself.
TEST(CacheLeaks, WallsAtAnyAngleAreClosed) {
  const radiance_cache::Settings cache{.resolution = 12, .cascades = 1};
  std::vector<double> bounced;
  for (double turn : {0.0, 20.0, 45.0}) {
    const Walls walls{0, turn, glm::dvec3(0)};
    shared_engine().edit([&](scene::Scene& scene) { rooms(walls, false).install(scene); });
    bounced.push_back(irradiance_in(walls, 1, cache).bounced);
    EXPECT_NEAR(bounced.back(), bounced.front(), 0.1 * bounced.front()) << turn;
  }
}

}  // namespace
}  // namespace panoptes::test
