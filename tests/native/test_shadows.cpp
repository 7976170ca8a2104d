// Blockers before each kind of lamp: away from the edges a point is lit in full or not at all.
#include "support.h"

#include <cmath>
#include <functional>

namespace panoptes::test {
namespace {

using film::Pass;

constexpr double kRounding = 1e-5;

// Signed distance to the border of the axis-aligned square |q| < half, negative inside.
double square_distance(const glm::dvec2& q, double half) {
  const glm::dvec2 d = glm::abs(q) - half;
  const glm::dvec2 outside = glm::max(d, glm::dvec2(0));
  return glm::length(outside) + std::min(std::max(d.x, d.y), 0.0);
}

// Renders with and without shadows; `edge(p)` is the signed distance of a point on the wall to the
// edge of the shadow, negative inside. Farther than `margin` from it the light is all or nothing.
void expect_shadow(TestScene s, const gpu_scene::Camera& camera, const glm::dvec3& wall,
                   const glm::dvec3& normal, const std::function<double(glm::dvec3)>& edge,
                   double margin, int resolution = 512) {
  engine::RenderRequest r = request(camera, {Pass::kDiffDir, Pass::kDepth});
  r.shadow_resolution = resolution;
  r.soft_shadows = false;
  const Picture shaded = render(s, r);
  for (scene::Light& lamp : s.lights) lamp.cast_shadow = false;
  const Picture open = render(s, r);
  Worst inside, outside;
  const glm::dvec3 eye = camera_ray(camera, camera.width / 2.0, camera.height / 2.0).origin;
  const glm::dvec3 axis = camera_ray(camera, camera.width / 2.0, camera.height / 2.0).direction;
  for (int y = 0; y < shaded.height; ++y)
    for (int x = 0; x < shaded.width; ++x) {
      const glm::dvec3 p = on_plane(pixel_ray(camera, x, y), wall, normal);
      // Pixels that show the blocker itself say nothing about the wall.
      const double depth = glm::dot(p - eye, axis) + 0.01;  // rays start on the near plane
      if (std::abs(shaded.value(Pass::kDepth, x, y) - depth) > 1e-3 * depth) continue;
      const double full = open.value(Pass::kDiffDir, x, y), distance = edge(p);
      if (full <= 0) continue;
      const double share = shaded.value(Pass::kDiffDir, x, y) / full;
      if (distance < -margin) inside.compare(share, 0, 1, x, y);
      if (distance > margin) outside.compare(share, 1, 1, x, y);
    }
  EXPECT_GT(inside.count(), 30);
  EXPECT_GT(outside.count(), 30);
  EXPECT_EQ(inside.error(), 0.0) << "light leaks into the shadow " << inside.where();
  EXPECT_LE(outside.error(), kRounding) << "shade outside of the shadow " << outside.where();
}

// A floor of half 3 and a square blocker |x|, |y| < .5 at z = 1.
TestScene blocked_floor(const scene::Light& lamp) {
  TestScene s;
  const Id white = s.add_material(lambert());
  s.add_object(floor_at(0, 3), {white});
  s.add_object(floor_at(1, 0.5f), {white});
  s.lights = {lamp};
  return s;
}

const gpu_scene::Camera kOblique = perspective({0, -7, 3.5}, {0, 0, 0}, 0.7, 64, 64);

TEST(Shadows, OfASunAreTheBlockersParallelProjection) {
  for (const glm::dvec3& direction :
       {glm::dvec3(0, 0, -1), glm::dvec3(0.5, 0.3, -1), glm::dvec3(-1.2, -0.4, -1)})
    // The map spans about 8 m in 512 texels: two texels of filter, seen along the slope.
    expect_shadow(
        blocked_floor(sun(glm::vec3(direction), 2)), kOblique, {0, 0, 0}, {0, 0, 1},
        [&](const glm::dvec3& p) {
          const glm::dvec3 at = p - direction / -direction.z * 1.0;
          return square_distance({at.x, at.y}, 0.5);
        },
        0.06);
}

TEST(Shadows, FallOnBentNormalsAsOnStraightOnes) {
  const glm::dvec3 direction(0.5, 0.3, -1);
  for (float lean : {0.4f, -0.7f}) {
    TestScene s = blocked_floor(sun(glm::vec3(direction), 2));
    Geometry bent = floor_at(0, 3);
    bent.normals.assign(4, {std::sin(lean), 0, std::cos(lean)});
    s.meshes[0] = bent.mesh();
    expect_shadow(
        s, kOblique, {0, 0, 0}, {0, 0, 1},
        [&](const glm::dvec3& p) {
          const glm::dvec3 at = p - direction;
          return square_distance({at.x, at.y}, 0.5);
        },
        0.08);
  }
}

TEST(Shadows, OfAPointAreTheBlockersCentralProjection) {
  for (const glm::dvec3& lamp : {glm::dvec3(0, 0, 2), glm::dvec3(0.6, -0.4, 2.5)})
    // At 2.5 m a face of 512 texels has texels of .01 m, twice that projected past the blocker.
    expect_shadow(
        blocked_floor(point(glm::vec3(lamp), 20)), kOblique, {0, 0, 0}, {0, 0, 1},
        [&](const glm::dvec3& p) {
          const glm::dvec3 at = lamp + (p - lamp) * ((lamp.z - 1) / lamp.z);
          return square_distance({at.x, at.y}, 0.5);
        },
        0.02);
}

TEST(Shadows, OfASpotFollowItsConeToo) {
  const glm::dvec3 lamp(0.3, 0.2, 3);
  for (float size : {1.2f, 2.6f})  // a flat map, and a cube
    expect_shadow(
        blocked_floor(spot(glm::vec3(lamp), glm::vec3(-0.1f, 0, -1), 20, size, 0.3f)), kOblique,
        {0, 0, 0}, {0, 0, 1},
        [&](const glm::dvec3& p) {
          const glm::dvec3 at = lamp + (p - lamp) * ((lamp.z - 1) / lamp.z);
          return square_distance({at.x, at.y}, 0.5);
        },
        0.03);
}

TEST(Shadows, OfAHardAreaAreThoseOfItsCentre) {
  const glm::dvec3 lamp(0.3, 0.2, 3);
  expect_shadow(
      blocked_floor(area(glm::vec3(lamp), {0, 0, -1}, 20, scene::AreaShape::kSquare, 1, 1)),
      kOblique, {0, 0, 0}, {0, 0, 1},
      [&](const glm::dvec3& p) {
        const glm::dvec3 at = lamp + (p - lamp) * ((lamp.z - 1) / lamp.z);
        return square_distance({at.x, at.y}, 0.5);
      },
      0.02);
}

TEST(Shadows, OfAPointFallToAllSixSides) {
  // A lamp in the middle of a room of half 3, a square of half .3 at 1 m in each direction, and a
  // camera between that square and the wall.
  TestScene s;
  const Id white = s.add_material(lambert());
  s.add_object(box({0, 0, 0}, glm::vec3(3)), {white});
  for (int axis = 0; axis < 3; ++axis)
    for (float side : {1.0f, -1.0f}) {
      glm::vec3 n(0), u(0), v(0);
      n[axis] = side;
      u[(axis + 1) % 3] = 0.3f;
      v[(axis + 2) % 3] = 0.3f;
      s.add_object(quad(n, u, v), {white});
    }
  s.lights = {point({0, 0, 0}, 50)};
  for (int axis = 0; axis < 3; ++axis)
    for (double side : {1.0, -1.0}) {
      SCOPED_TRACE(fmt::format("side {}{}", side > 0 ? '+' : '-', "xyz"[axis]));
      glm::dvec3 n(0);
      n[axis] = side;
      expect_shadow(
          s, perspective(1.2 * n, 3.0 * n, 1.6, 48, 48), 3.0 * n, n,
          [&](const glm::dvec3& p) {
            return square_distance({p[(axis + 1) % 3] / 3, p[(axis + 2) % 3] / 3}, 0.3);
          },
          0.02);
    }
}

TEST(Shadows, AreTheSameAcrossTheSeamsOfACube) {
  // A long bar above the floor; its shadow crosses the edges where the faces of the cube meet.
  TestScene s;
  const Id white = s.add_material(lambert());
  s.add_object(floor_at(0, 6), {white});
  s.add_object(quad({0, 0, 1}, {6, 0, 0}, {0, 0.2f, 0}), {white});
  s.lights = {point({0, 0.7f, 1.5f}, 50)};
  expect_shadow(
      s, orthographic({0, -1.2, 0.9}, {0, -1.2, 0}, 2.5, 64, 40), {0, 0, 0}, {0, 0, 1},
      [](const glm::dvec3& p) {
        const double y = 0.7 + (p.y - 0.7) / 3;  // at the bar's height
        return std::abs(y) - 0.2;
      },
      0.03);
}

TEST(Shadows, AreCastByWhatTheCameraCannotSee) {
  // The blocker lies before the camera's near plane, and casts its shadow all the same.
  const glm::dvec3 direction(0.5, 0.3, -1);
  TestScene s = blocked_floor(sun(glm::vec3(direction), 2));
  const gpu_scene::Camera camera = orthographic({0, 0, 3}, {0, 0, 0}, 2, 64, 64, 2.5, 10);
  const Picture picture = render(s, request(camera, {Pass::kDiffDir, Pass::kDepth}));
  int dark = 0, lit = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      EXPECT_NEAR(picture.value(Pass::kDepth, x, y), 3, 1e-5);
      const glm::dvec3 p = on_plane(pixel_ray(camera, x, y), {0, 0, 0}, {0, 0, 1});
      const double edge = square_distance({p.x - direction.x, p.y - direction.y}, 0.5);
      if (std::abs(edge) < 0.1) continue;
      const double value = picture.value(Pass::kDiffDir, x, y);
      ++(edge < 0 ? dark : lit);
      EXPECT_EQ(value > 0, edge > 0) << x << " " << y;
    }
  EXPECT_GT(dark, 100);
  EXPECT_GT(lit, 1000);
}

TEST(Shadows, OfLampsWithoutShadowAreNotCast) {
  TestScene s = blocked_floor(sun({0, 0, -1}, kPi));
  s.lights[0].cast_shadow = false;
  s.lights.push_back(sun({0, 0, -1}, float(kPi)));  // which does cast
  const gpu_scene::Camera camera = orthographic({0, 0, 0.9}, {0, 0, 0}, 2.5, 32, 32);
  const Picture picture = render(s, request(camera, {Pass::kDiffDir}));
  EXPECT_NEAR(picture.value(Pass::kDiffDir, 16, 16), 1, 1e-5);
  EXPECT_NEAR(picture.value(Pass::kDiffDir, 1, 1), 2, 1e-5);
}

TEST(Shadows, AThinWallIsDarkOnItsFarSide) {
  // One quad, lit from one side; the camera looks at the other.
  TestScene s;
  s.add_object(floor_at(0, 2), {s.add_material(lambert())});
  s.lights = {sun({0.4f, 0.1f, -1}, 3), point({0.5f, 0, 0.5f}, 30)};
  const Picture picture =
      render(s, request(perspective({0, 0, -2}, {0, 0, 0}, 0.8, 32, 32), {Pass::kDiffDir}));
  for (float v : picture[Pass::kDiffDir]) ASSERT_EQ(v, 0.0f);
}

TEST(Shadows, MoveWithTheLampAndTheBlocker) {
  // Kept maps must not outlive an edit.
  TestScene s = blocked_floor(sun({0, 0, -1}, float(kPi)));
  const gpu_scene::Camera camera = orthographic({0, 0, 0.9}, {0, 0, 0}, 2.5, 32, 32);
  const auto at = [&](const Picture& p, int x) { return p.value(Pass::kDiffDir, x, 16); };
  Picture before = render(s, request(camera, {Pass::kDiffDir}));
  EXPECT_EQ(at(before, 16), 0);
  EXPECT_NEAR(at(before, 26), 1, 1e-5);
  engine::Engine& engine = shared_engine();
  const Picture again = render(request(camera, {Pass::kDiffDir}));
  EXPECT_EQ(again[Pass::kDiffDir], before[Pass::kDiffDir]);
  engine.edit([&](scene::Scene& scene) {
    const int index = 1;
    const glm::mat4 moved(glm::vec4(1, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 1, 0),
                          glm::vec4(1.6f, 0, 0, 1));
    scene.set_instance_matrices({&index, 1}, {&moved, 1});
  });
  const Picture after = render(request(camera, {Pass::kDiffDir}));
  EXPECT_NEAR(at(after, 16), 1, 1e-5);
  EXPECT_EQ(at(after, 26), 0);
  engine.edit([&](scene::Scene& scene) { scene.set_lights({sun({1.6f, 0, -1}, float(kPi))}); });
  const Picture tilted = render(request(camera, {Pass::kDiffDir}));
  EXPECT_NEAR(at(tilted, 26), 1 / std::sqrt(1 + 1.6 * 1.6), 1e-5);
}

TEST(Shadows, LampsFarOutsideCastThem) {
  // The same shadow from near and from very far, where parallel light is the limit.
  for (double distance : {100.0, 1e4, 1e6}) {
    const glm::dvec3 direction = glm::normalize(glm::dvec3(0.5, 0.3, -1));
    const glm::dvec3 lamp = -distance * direction;
    expect_shadow(
        blocked_floor(point(glm::vec3(lamp), float(1e3 * distance * distance))), kOblique,
        {0, 0, 0}, {0, 0, 1},
        [&](const glm::dvec3& p) {
          const glm::dvec3 d = lamp - p;
          return square_distance(glm::dvec2(p + d / d.z), 0.5);
        },
        0.06);
  }
}

TEST(Shadows, OfASunStaySharpInALargeScene) {
  // The blocked floor, with a hill 20 km away: one map over all of it would have texels of 10 m.
  const glm::dvec3 direction(0.5, 0.3, -1);
  TestScene s = blocked_floor(sun(glm::vec3(direction), 2));
  s.add_object(box({20000, 0, 0}, {100, 100, 100}), {1});
  expect_shadow(
      s, kOblique, {0, 0, 0}, {0, 0, 1},
      [&](const glm::dvec3& p) {
        return square_distance(glm::dvec2(p - direction), 0.5);
      },
      0.06);
}

}  // namespace
}  // namespace panoptes::test
