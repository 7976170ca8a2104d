// Where phantom views of ambient occlusion stand and what they can see. No GL.
#include "ambient_occlusion/phantoms.h"
#include "support.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <limits>
#include <random>

namespace panoptes::test {
namespace {

using ambient_occlusion::phantom_pair;
using gpu_scene::Camera;
using gpu_scene::LightView;

const scene::Bounds kNoBounds;

scene::Bounds bounds_of(const glm::vec3& low, const glm::vec3& high) {
  scene::Bounds b;
  b.add(low);
  b.add(high);
  return b;
}

// Place in the window (-1..1), and depth along the axis.
glm::dvec3 place_in(const LightView& view, const glm::dvec3& point) {
  const glm::dvec3 p = point - view.origin;
  const double depth = glm::dot(p, view.axis), spread = view.perspective ? depth : 1.0;
  return {(glm::dot(p, view.x) / spread - view.shift.x) / view.half_x,
          (glm::dot(p, view.y) / spread - view.shift.y) / view.half_y, depth};
}

bool shows(const LightView& view, const glm::dvec3& point) {
  const glm::dvec3 place = place_in(view, point);
  return std::abs(place.x) <= 1 && std::abs(place.y) <= 1 &&
         place.z >= view.near_depth * (1 - 1e-12) && place.z <= view.far_depth;
}

// The point at a place (-1..1) of the camera's picture and a depth.
glm::dvec3 seen_at(const Camera& camera, const glm::dvec2& place, double depth) {
  const LightView seen = gpu_scene::as_light_view(camera, {0, 0});
  const glm::dvec2 side = seen.shift + place * glm::dvec2(seen.half_x, seen.half_y);
  return seen.origin + depth * seen.axis +
         (seen.perspective ? depth : 1.0) * (side.x * seen.x + side.y * seen.y);
}

void expect_sane(const std::vector<LightView>& pair) {
  ASSERT_EQ(pair.size(), 2u);
  for (const LightView& v : pair) {
    for (const glm::dvec3& axis : {v.x, v.y, v.axis}) EXPECT_NEAR(glm::length(axis), 1, 1e-9);
    EXPECT_LT(std::abs(glm::dot(v.x, v.axis)) + std::abs(glm::dot(v.y, v.axis)), 1e-9);
    for (const double n : {v.origin.x, v.origin.y, v.origin.z, v.near_depth, v.far_depth, v.half_x,
                           v.half_y, v.shift.x, v.shift.y})
      EXPECT_TRUE(std::isfinite(n));
    EXPECT_GT(v.half_x, 0);
    EXPECT_GT(v.half_y, 0);
    EXPECT_LT(v.near_depth, v.far_depth);
    EXPECT_TRUE(v.near_depth > 0 || !v.perspective);
    const shared::View drawn = gpu_scene::light_view(v, {64, 64});
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 4; ++r) EXPECT_TRUE(std::isfinite(drawn.clip_from_relative[c][r]));
  }
}

TEST(PhantomPair, StandsBehindTheCameraToEitherSideAndLevelWithIt) {
  const glm::dvec3 eye(1, 2, 3);
  for (const Camera& camera : {perspective(eye, {5, 4, 3}, 0.8, 64, 36),
                               perspective(eye, {5, 4, 3}, 0.8, 64, 36, 0.01, 100, {0.4, 0.2})}) {
    const LightView seen = gpu_scene::as_light_view(camera, {0, 0});
    const std::vector<LightView> pair = phantom_pair(camera, 4, kNoBounds);
    expect_sane(pair);
    const glm::dvec3 left = pair[0].origin - eye, right = pair[1].origin - eye;
    EXPECT_LT(glm::dot(left, seen.x), 0);
    EXPECT_NEAR(glm::dot(left, seen.x), -glm::dot(right, seen.x), 1e-9);
    for (const LightView& v : pair) {
      EXPECT_LT(glm::dot(v.origin - eye, seen.axis), 0);
      EXPECT_NEAR(v.origin.z, eye.z, 1e-9);
      EXPECT_LT(glm::length(v.origin - eye), 0.75 * 4) << "close, compared with the focus";
      EXPECT_EQ(v.axis, seen.axis);
    }
    // They look across each other: each has the focus near the middle of its window, and what the
    // other has at its rim beyond it.
    const glm::dvec3 focus = seen_at(camera, {0, 0}, 4);
    for (const LightView& v : pair) EXPECT_LT(std::abs(place_in(v, focus).x), 0.25);
  }
}

TEST(PhantomPair, SeesAroundWhatStandsBeforeTheFocus) {
  // From places that differ by angles that matter: more than 10 degrees from the camera's.
  const Camera camera = perspective({0, 0, 1}, {0, 4, 1}, 0.8, 64, 36);
  for (const LightView& v : phantom_pair(camera, 4, kNoBounds)) {
    const glm::dvec3 to_camera = glm::normalize(glm::dvec3(0, -4, 0)),
                     to_view = glm::normalize(v.origin - glm::dvec3(0, 4, 1));
    EXPECT_LT(glm::dot(to_camera, to_view), std::cos(10 * kPi / 180));
    EXPECT_GT(glm::dot(to_camera, to_view), std::cos(45 * kPi / 180));
  }
}

TEST(PhantomPair, ShowsWhatTheCameraShowsAroundTheFocus) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const glm::dvec3 eye(-2, 1, 1.5), target(1, 2, 1);
  const scene::Bounds everything = bounds_of({-100, -100, -100}, {100, 100, 100});
  for (const Camera& camera : {perspective(eye, target, 0.7, 64, 36),
                               perspective(eye, target, 0.7, 36, 64, 0.1, 50, {-0.3, 0.5}),
                               perspective(eye, target, 2.5, 64, 36),
                               orthographic(eye, target, 2, 64, 36, 0.01, 100, {0.2, -0.1})}) {
    const LightView seen = gpu_scene::as_light_view(camera, {0, 0});
    const double wide = 2 * std::max(seen.half_x, seen.half_y) * (seen.perspective ? 3.0 : 1.0);
    const std::vector<LightView> pair = phantom_pair(camera, 3, everything);
    expect_sane(pair);
    for (int i = 0; i < 1000; ++i) {
      const glm::dvec2 place(uniform(random), uniform(random));
      // As deep as it is wide, yet no nearer than a third of the focus, or half of it where the pair's
      // near planes are turned.
      const double depth = std::max(3 + 0.99 * uniform(random) * std::min(wide, 6.0),
                                    camera.perspective() ? 1.01 : 1.51);
      for (const LightView& v : pair)
        EXPECT_TRUE(shows(v, seen_at(camera, place, depth)))
            << place.x << " " << place.y << " " << depth;
    }
  }
}

TEST(PhantomPair, CutsAwayExactlyWhatTheCameraCutsAway) {
  for (const double fov : {0.3, 1.2, 3.0}) {
    const Camera camera = perspective({0, 0, 1}, {0, 4, 1}, fov, 64, 36, 0.5, 100);
    for (const LightView& v : phantom_pair(camera, 4, kNoBounds))
      for (const double x : {-3.0, 0.0, 0.1, 3.0}) {
        EXPECT_LT(place_in(v, {x, 0.4999, 1}).z, v.near_depth) << "a wall before the near plane";
        EXPECT_GE(place_in(v, {x, 0.5001, 1}).z, v.near_depth) << "the first of what is seen";
      }
  }
}

TEST(PhantomPair, ReachesToTheLastOfTheScene) {
  // Occluders count even where the camera's far plane hides them.
  const Camera camera = perspective({0, 0, 1}, {0, 4, 1}, 0.8, 64, 36, 0.1, 10);
  const scene::Bounds scene = bounds_of({-5, -5, 0}, {5, 300, 8});
  for (const LightView& v : phantom_pair(camera, 4, scene)) {
    EXPECT_TRUE(shows(v, {0, 299.99, 1}));
    EXPECT_LT(v.far_depth, 310);
  }
  // With a scene behind the camera, there is still a depth to draw.
  expect_sane(phantom_pair(camera, 4, bounds_of({-5, -50, 0}, {5, -20, 8})));
}

TEST(PhantomPair, IsLevelHoweverTheCameraIsHeld) {
  // Rolled, tilted, upside down and looking straight up and down.
  for (const double roll : {0.0, 0.5, 1.5707, 3.1})
    for (const glm::dvec3& target :
         {glm::dvec3(0, 4, 0), glm::dvec3(3, 1, -2), glm::dvec3(0.5, 0.5, 3), glm::dvec3(0, 0, -3),
          glm::dvec3(0, 0, 3)})
      for (Camera camera : {perspective({0, 0, 0}, target, 0.8, 64, 36),
                            orthographic({0, 0, 0}, target, 2, 64, 36)}) {
        camera.world_to_camera =
            glm::rotate(glm::dmat4(1.0), roll, glm::dvec3(0, 0, 1)) * camera.world_to_camera;
        const std::vector<LightView> pair = phantom_pair(camera, 3, kNoBounds);
        expect_sane(pair);
        const glm::dvec3 apart =
            camera.perspective() ? pair[1].origin - pair[0].origin : pair[0].axis - pair[1].axis;
        EXPECT_GT(glm::length(apart), 0.3);
        EXPECT_NEAR(apart.z, 0, 1e-9) << roll << " " << target.z;
      }
}

TEST(PhantomPair, StaysWithinTheRoomThatTheCameraStandsIn) {
  const Camera camera = perspective({0.5, 0, 1}, {0.5, 4, 1}, 0.8, 64, 36);
  const scene::Bounds corridor = bounds_of({-0.2f, -0.01f, 0}, {0.8f, 30, 2.5f});
  const std::vector<LightView> pair = phantom_pair(camera, 8, corridor);
  expect_sane(pair);
  EXPECT_GT(pair[0].origin.x, corridor.low.x);
  EXPECT_LT(pair[0].origin.x, 0);
  EXPECT_LT(pair[1].origin.x, corridor.high.x);
  EXPECT_GT(pair[1].origin.x, 0.7);
  // From outside, the bounds are no walls.
  const Camera outside = perspective({0.5, -1, 1}, {0.5, 4, 1}, 0.8, 64, 36);
  EXPECT_GT(phantom_pair(outside, 8, corridor)[1].origin.x, corridor.high.x);
}

TEST(PhantomPair, ScalesWithTheSceneAndStandsWhereItStands) {
  for (const double scale : {1e-3, 1.0, 1e3})
    for (const glm::dvec3& at : {glm::dvec3(0), glm::dvec3(1048576, -1048576, 1048576)}) {
      const auto pair_of = [&](double s, const glm::dvec3& o, bool perspectively) {
        const glm::dvec3 eye = o + s * glm::dvec3(0.5, -1, 1),
                         target = o + s * glm::dvec3(0, 3, 0.5);
        const Camera camera = perspectively
                                  ? perspective(eye, target, 0.8, 64, 36, 0.01 * s, 50 * s)
                                  : orthographic(eye, target, 2 * s, 64, 36, 0.01 * s, 50 * s);
        return phantom_pair(camera, 3 * s, kNoBounds);
      };
      for (const bool perspectively : {true, false}) {
        const auto base = pair_of(1, glm::dvec3(0), perspectively),
                   moved = pair_of(scale, at, perspectively);
        for (int i = 0; i < 2; ++i) {
          const double unit = perspectively ? 1 : scale;
          EXPECT_LT(glm::length((moved[i].origin - at) / scale - base[i].origin),
                    1e-9 / scale + 1e-9);
          EXPECT_NEAR(moved[i].half_x / unit, base[i].half_x, 1e-6 / std::min(scale, 1.0));
          EXPECT_NEAR(moved[i].near_depth / scale, base[i].near_depth, 1e-6 / std::min(scale, 1.0));
        }
      }
    }
}

TEST(PhantomPair, IsSaneWhateverTheLensAndTheFocus) {
  const double infinity = std::numeric_limits<double>::infinity(),
               nan = std::numeric_limits<double>::quiet_NaN();
  const glm::dvec3 far(1048576.125, -1048576.375, 1048576.5);
  for (const glm::dvec3& o : {glm::dvec3(0), far})
    for (const scene::Bounds& bounds :
         {kNoBounds, bounds_of(glm::vec3(o) - 5.0f, glm::vec3(o) + 5.0f), bounds_of(o, o),
          bounds_of(glm::vec3(o) - 5.0f, glm::vec3(float(infinity))),
          bounds_of(glm::vec3(o) + glm::vec3(1, 2, 0), glm::vec3(o) + glm::vec3(3, 9, 0))})
      for (const double focus :
           {0.0, -1.0, 1e-300, 1e-9, 1.0, 1e9, 1e300, infinity, -infinity, nan}) {
        for (const double degrees : {1.0, 50.0, 120.0, 179.0})
          expect_sane(
              phantom_pair(perspective(o + glm::dvec3(0.25, -1, 0.5), o + glm::dvec3(0, 3, 0.25),
                                       degrees * kPi / 180, 64, 36),
                           focus, bounds));
        for (const double half : {1e-4, 1.0, 1e4})
          expect_sane(phantom_pair(orthographic(o + glm::dvec3(0.25, -1, 0.5),
                                                o + glm::dvec3(0, 3, 0.25), half, 64, 36),
                                   focus, bounds));
      }
}

TEST(PhantomCameras, HaveTheArtistsFrusta) {
  ambient_occlusion::Settings settings;
  settings.phantom_camera_count = 2;
  settings.phantom_cameras[0] = perspective({1, 2, 3}, {0, 0, 0}, 0.9, 0, 0, 0.1, 50);
  settings.phantom_cameras[1] = orthographic({-1, 2, 3}, {0, 0, 0}, 2, 40, 20, 0.1, 50, {0.5, 0});
  // A camera whose size was not filled in: what counts are its matrices.
  settings.phantom_cameras[0].projection[0][0] = settings.phantom_cameras[0].projection[1][1] / 2;
  const std::vector<LightView> views = ambient_occlusion::phantom_cameras(settings);
  ASSERT_EQ(views.size(), 2u);
  EXPECT_LT(glm::length(views[0].origin - glm::dvec3(1, 2, 3)), 1e-12);
  EXPECT_NEAR(views[0].half_x, 2 * std::tan(0.45), 1e-12);
  EXPECT_NEAR(views[0].half_y, std::tan(0.45), 1e-12);
  EXPECT_NEAR(views[0].far_depth, 50, 1e-6);
  EXPECT_FALSE(views[1].perspective);
  EXPECT_NEAR(views[1].half_x, 4, 1e-12);
  EXPECT_NEAR(views[1].shift.x, 0.5 * 4, 1e-12);
}

TEST(PhantomCameras, MustBeAbleToSeeSomething) {
  ambient_occlusion::Settings settings;
  settings.phantom_camera_count = 2;
  settings.phantom_cameras[0] = perspective({1, 2, 3}, {0, 0, 0}, 0.9, 16, 9);
  settings.phantom_cameras[1] = settings.phantom_cameras[0];
  settings.phantom_cameras[1].width = settings.phantom_cameras[1].height = 0;  // not read
  EXPECT_NO_THROW(settings.check());
  settings.phantom_cameras[1].projection[0][0] = 0;
  expect_error([&] { settings.check(); }, "phantom camera 2");
  settings.phantom_camera_count = 1;
  EXPECT_NO_THROW(settings.check());
}

}  // namespace
}  // namespace panoptes::test
