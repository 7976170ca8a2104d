// A surface that nothing stands before must not shade itself: renders with shadows must equal those
// without, on planes and smooth spheres, at every resolution of the maps.
#include "support.h"

#include <cmath>
#include <functional>

namespace panoptes::test {
namespace {

using film::Pass;

// DiffDir at normal incidence, for the surface that pixel (x, y) shows.
using Full = std::function<double(int x, int y)>;

struct Acne {
  double worst = 0;  // light that is missing at the worst pixel, of that at normal incidence
  double bad = 0;    // share of lit pixels that lose more than a thousandth of their own
  double mean = 0;   // share of all light that is missing
  int lit = 0;
};

Acne acne(TestScene s, const gpu_scene::Camera& camera, int resolution, const Full& full) {
  engine::RenderRequest r = request(camera, {Pass::kDiffDir});
  r.shadow_resolution = resolution;
  const Picture shaded = render(s, r);
  for (scene::Light& lamp : s.lights) lamp.cast_shadow = false;
  const Picture open = render(s, r);
  Acne result;
  double lost = 0, all = 0;
  for (int y = 0; y < open.height; ++y)
    for (int x = 0; x < open.width; ++x) {
      const double due = open.value(Pass::kDiffDir, x, y);
      const double difference = std::abs(due - shaded.value(Pass::kDiffDir, x, y));
      all += due;
      lost += difference;
      if (due <= 0) continue;
      ++result.lit;
      result.worst = std::max(result.worst, difference / full(x, y));
      result.bad += difference > 1e-3 * due;
    }
  result.bad /= std::max(result.lit, 1);
  result.mean = lost / all;
  return result;
}

// What no eye finds, even where light grazes: half a percent of the light at normal incidence.
constexpr double kInvisible = 5e-3;

void expect_clean(const TestScene& s, const gpu_scene::Camera& camera, int resolution,
                  const Full& full, const std::string& label, double tolerance = kInvisible) {
  const Acne a = acne(s, camera, resolution, full);
  EXPECT_GT(a.lit, 50) << label;
  EXPECT_LE(a.worst, tolerance)
      << fmt::format("{}: {:.2f} % of the lit pixels are shaded, {:.3f} % of the light is lost",
                     label, 100 * a.bad, 100 * a.mean);
}

double full_sun(int, int) { return 1 / kPi; }  // strength 1

// For a point lamp of 1 W over the plane through the origin.
Full full_point(const glm::dvec3& lamp, const gpu_scene::Camera& camera, const glm::dvec3& n) {
  return [=](int x, int y) {
    const glm::dvec3 d = lamp - on_plane(pixel_ray(camera, x, y), {0, 0, 0}, n);
    return 1 / (4 * kPi * kPi * glm::dot(d, d));
  };
}

const int kResolutions[] = {64, 256, 1024, 2048};

// The unit plane that is tilted by `angle` about the y axis, and a camera that sees all of it.
TestScene tilted_plane(float angle) {
  TestScene s;
  s.add_object(quad({0, 0, 0}, {std::cos(angle), 0, -std::sin(angle)}, {0, 1, 0}),
               {s.add_material(lambert())});
  return s;
}

TEST(ShadowAcne, PlanesUnderASunAreClean) {
  for (int resolution : kResolutions)
    for (float tilt : {0.0f, 0.4f, -0.9f})
      for (double elevation : {1.5, 0.7, 0.2, 0.05, 0.01}) {  // radians above the plane
        TestScene s = tilted_plane(tilt);
        const glm::dvec3 n(std::sin(tilt), 0, std::cos(tilt)),
            along(std::cos(tilt), 0, -std::sin(tilt));
        const glm::dvec3 in_plane = glm::normalize(along + glm::dvec3(0, 0.37, 0));
        s.lights = {sun(glm::vec3(-std::sin(elevation) * n - std::cos(elevation) * in_plane), 1)};
        expect_clean(s, orthographic(3.0 * n, {0, 0, 0}, 0.98, 40, 40), resolution, full_sun,
                     fmt::format("map {}, tilt {}, elevation {}", resolution, tilt, elevation));
      }
}

TEST(ShadowAcne, PlanesUnderAPointAreClean) {
  for (int resolution : kResolutions)
    for (float tilt : {0.0f, 0.4f})
      for (double height : {1.0, 0.3, 0.05}) {
        TestScene s = tilted_plane(tilt);
        const glm::dvec3 n(std::sin(tilt), 0, std::cos(tilt));
        const glm::dvec3 lamp = height * n + glm::dvec3(0, 0.3, 0);
        s.lights = {point(glm::vec3(lamp), 1)};
        const gpu_scene::Camera camera = orthographic(3.0 * n, {0, 0, 0}, 0.98, 40, 40);
        expect_clean(s, camera, resolution, full_point(lamp, camera, n),
                     fmt::format("map {}, tilt {}, height {}", resolution, tilt, height));
      }
}

TEST(ShadowAcne, PlanesUnderASpotAndAnAreaAreClean) {
  for (int resolution : kResolutions)
    for (double height : {1.0, 0.2}) {
      for (const scene::Light& lamp :
           {spot({-1.2f, 0, float(height)}, {1, 0.1f, float(-height)}, 1, 1.0f, 0.2f),
            area({-1.2f, 0, float(height)}, {1, 0.1f, float(-height)}, 1, scene::AreaShape::kDisk,
                 0.1f, 0.1f)}) {
        TestScene s = tilted_plane(0);
        s.lights = {lamp};
        const gpu_scene::Camera camera = orthographic({0, 0, 3}, {0, 0, 0}, 0.98, 40, 40);
        expect_clean(s, camera, resolution, full_point({-1.2, 0, height}, camera, {0, 0, 1}),
                     fmt::format("map {}, height {}, lamp type {}", resolution, height,
                                 int(lamp.type)));
      }
    }
}

TEST(ShadowAcne, PlanesSeenAtGrazingAnglesAreClean) {
  for (int resolution : kResolutions) {
    TestScene s = tilted_plane(0);
    s.lights = {sun({0.5f, 0.2f, -0.3f}, 1)};
    expect_clean(s, perspective({0, -3, 0.1}, {0, 0, 0}, 0.5, 40, 40), resolution, full_sun,
                 fmt::format("map {}", resolution));
  }
}

TEST(ShadowAcne, SmoothConvexSpheresHaveNoTerminator) {
  // In Cycles a convex smooth mesh is lit by N.L alone up to the terminator, whatever its facets.
  for (int segments : {8, 16, 64})
    for (int resolution : kResolutions) {
      TestScene s;
      s.add_object(sphere({0, 0, 0}, 1, segments), {s.add_material(lambert())});
      for (int kind = 0; kind < 2; ++kind) {
        const glm::vec3 direction(1, 0.3f, -0.2f);
        // At 3 m or so 12 pi watts are about as bright as the sun: .9 of it at least.
        s.lights = {kind ? point(-3.0f * direction, float(4 * kPi * 9)) : sun(direction, 1)};
        // From the side, so that the terminator is in view.
        expect_clean(s, perspective({0.5, -3.2, 0.6}, {0, 0, 0}, 0.7, 48, 48), resolution, full_sun,
                     fmt::format("{} segments, map {}, {}", segments, resolution,
                                 kind ? "point" : "sun"));
      }
    }
}

TEST(ShadowAcne, FlatCardsWithBentNormalsAreClean) {
  // Leaves and grass: flat geometry whose normals lean anywhere.
  for (int resolution : kResolutions)
    for (float lean : {0.3f, -0.7f, 1.2f})
      for (double elevation : {1.2, 0.4, 0.1}) {
        Geometry g = floor_at(0, 1);
        g.normals.assign(4, {std::sin(lean), 0, std::cos(lean)});
        TestScene s;
        s.add_object(g, {s.add_material(lambert())});
        s.lights = {sun({-float(std::cos(elevation)), -0.3f, -float(std::sin(elevation))}, 1)};
        if (std::cos(lean) * std::sin(elevation) + std::sin(lean) * std::cos(elevation) < 0.1)
          continue;  // the normal looks away: no light, no acne
        expect_clean(s, orthographic({0, 0, 3}, {0, 0, 0}, 0.98, 40, 40), resolution, full_sun,
                     fmt::format("map {}, lean {}, elevation {}", resolution, lean, elevation));
      }
}

TEST(ShadowAcne, FlatFacetsAreLitWhereTheyFaceTheLamp) {
  for (int resolution : kResolutions) {
    TestScene s;
    s.add_object(sphere({0, 0, 0}, 1, 16, false), {s.add_material(lambert())});
    s.lights = {sun({1, 0.3f, -0.2f}, 1)};
    expect_clean(s, perspective({0.5, -3.2, 0.6}, {0, 0, 0}, 0.7, 48, 48), resolution, full_sun,
                 fmt::format("map {}", resolution));
  }
}

TEST(ShadowAcne, ASmallObjectOnALargeFloorIsClean) {
  // The map is spread over the floor, so that the object has few texels.
  TestScene s;
  const Id white = s.add_material(lambert());
  s.add_object(sphere({0, 0, 0.5f}, 0.5f, 64), {white});
  s.add_object(floor_at(-2, 20), {white});
  s.lights = {sun({1, 0.3f, -0.4f}, 1)};
  const gpu_scene::Camera camera = perspective({0.2, -1.6, 1.0}, {0, 0, 0.6}, 0.4, 48, 48);
  expect_clean(s, camera, 2048, full_sun, "map 2048");
  // At 512 the sphere is twelve texels wide, and its terminator is as coarse as they are; in sum it
  // must not cost a thousandth of the light.
  EXPECT_LT(acne(s, camera, 512, full_sun).mean, 1e-3);
}

TEST(ShadowAcne, ContactShadowsReachTheirObject) {
  // What keeps surfaces clean must not detach shadows: under a box on the floor light may creep in
  // by a few texels only.
  TestScene s;
  const Id white = s.add_material(lambert());
  s.add_object(floor_at(0, 4), {white});
  s.add_object(box({0, 0, 0.5f}, glm::vec3(0.5f)), {white});
  const glm::dvec3 direction = glm::normalize(glm::dvec3(1, 0, -1));
  s.lights = {sun(glm::vec3(direction), float(kPi))};
  engine::RenderRequest r =
      request(orthographic({1.5, 0, 6}, {1.5, 0, 0}, 1.2, 64, 64), {Pass::kDiffDir, Pass::kDepth});
  r.shadow_resolution = 1024;
  const double texel = 2 * 5.0 / 1024;  // the map is about 10 m wide
  const Picture picture = render(s, r);
  int dark = 0;
  for (int x = 0; x < 64; ++x) {
    const glm::dvec3 p = on_plane(pixel_ray(r.camera, x, 32), {0, 0, 0}, {0, 0, 1});
    if (p.x < 0.5 + 3 * texel || p.x > 1.5 - 3 * texel) continue;
    EXPECT_EQ(picture.value(Pass::kDiffDir, x, 32), 0) << "light at x = " << p.x;
    ++dark;
  }
  EXPECT_GT(dark, 15);
}

TEST(ShadowAcne, CardsCloseToTheFloorStillShadeIt) {
  // Five texels above it, so that no more than those may be spent on keeping surfaces clean.
  const int resolution = 1024;
  for (const scene::Light& lamp : {sun({0, 0, -1}, 1), sun({1, 0, -1}, 1), point({0, 0, 4}, 100)}) {
    // Both maps span about 8 m: the floor under the sun, a right angle at 4 m under the point.
    const float height = 5 * 8.0f / float(resolution);
    TestScene s;
    const Id white = s.add_material(lambert());
    s.add_object(floor_at(0, 4), {white});
    s.add_object(floor_at(height, 0.5f), {white});
    s.lights = {lamp};
    engine::RenderRequest r =
        request(orthographic({0, 0, 0.5 * height}, {0, 0, 0}, 0.4, 16, 16, 1e-4), {Pass::kDiffDir});
    r.shadow_resolution = resolution;
    const Picture picture = render(s, r);
    for (float v : picture[Pass::kDiffDir]) ASSERT_EQ(v, 0) << "lamp type " << int(lamp.type);
  }
}

}  // namespace
}  // namespace panoptes::test
