// Multiview ambient occlusion in pictures: where visibility is known, and against traced occlusion.
#include "occlusion_scenes.h"

#include <algorithm>
#include <cmath>

namespace panoptes::test {
namespace {

using ambient_occlusion::Filter;
using ambient_occlusion::Phantoms;
using film::Pass;

constexpr int kSize = 32;

// The point of the scene that a pixel's centre shows, by the Depth pass of a single sample.
glm::dvec3 shown_at(const Picture& picture, const gpu_scene::Camera& camera, int x, int y) {
  const Ray ray = pixel_ray(camera, x, y);
  const glm::dvec4 start = camera.world_to_camera * glm::dvec4(ray.origin, 1);
  const glm::dvec4 along = camera.world_to_camera * glm::dvec4(ray.direction, 0);
  return ray.at((-picture.value(Pass::kDepth, x, y) - start.z) / along.z);
}

// From the surface of a box.
double distance_to_box(const glm::dvec3& p, const glm::dvec3& center, const glm::dvec3& half) {
  return glm::length(glm::max(glm::abs(p - center) - half, glm::dvec3(0)));
}

TEST(Occlusion, WhatNothingStandsNearIsOpen) {
  // On a plain stands a wall and, far from all else, hangs a ball of flat faces. The wall makes
  // lamps worth looking through.
  constexpr float kReach = 1;
  TestScene plain;
  const Id white = plain.add_material(lambert());
  const glm::vec3 center(-2, 0, 0.75f), half(0.5f, 3, 0.75f);
  plain.add_object(floor_at(0, 6), {white});
  plain.add_object(box(center, half), {white});
  plain.add_object(sphere({1.5f, 0.5f, 2.5f}, 0.75f, 24, false), {white});
  const scene::Light lamps[] = {sun({-1, 0.5f, -1}, 1), point({1.5f, 1, 1.5f}, 10),
                                spot({1.5f, -2, 2}, {-1, 0.25f, -0.5f}, 10, 1.6f, 0)};
  for (const gpu_scene::Camera& camera :
       {perspective({0.5, -6, 2.5}, {0, 0, 1}, 0.8, kSize, kSize),
        perspective({0.5, -6, 0.25}, {0, 0, 1}, 0.8, kSize, kSize)})
    for (const scene::Light& lamp : lamps)
      for (Estimator estimator : kEstimators) {
        TestScene s = plain;
        s.lights = {lamp};
        engine::RenderRequest r = occluded(camera, kReach);
        r.passes.set(size_t(Pass::kDepth));
        r.occlusion.estimator = estimator;
        r.occlusion.secondary_views = 1;
        r.occlusion.phantoms = Phantoms::kOn;
        const Picture p = render(s, r);
        const std::string label =
            fmt::format("estimator {}, lamp {}", int(estimator), int(lamp.type));
        EXPECT_TRUE(effect_of(p, "occlusion_lamp_views").runs) << label;
        int closed = 0;
        Worst open;
        for (int y = 0; y < kSize; ++y)
          for (int x = 0; x < kSize; ++x) {
            if (p.value(Pass::kDepth, x, y) > 1e9) continue;
            const glm::dvec3 at = shown_at(p, camera, x, y);
            closed += p.value(Pass::kAo, x, y) < 0.9;
            // Half as far again as r_max is how far points' occluders may lie.
            if (at.z > 1.499 || distance_to_box(at, center, half) > 1.5 * kReach + 0.01)
              open.compare(p.value(Pass::kAo, x, y), 1, 1, x, y);
          }
        EXPECT_GT(open.count(), kSize * kSize / 5) << label;
        EXPECT_GT(closed, 5) << label;
        // A step of 16-bit floats, where horizons are summed.
        EXPECT_WORST_BELOW(open, estimator == Estimator::kHbao ? 1.0 / 2048 : 0.0) << label;
      }
}

// How occluded what a pixel's centre shows of corner() is.
double due_in_corner(const gpu_scene::Camera& camera, int x, int y, double reach) {
  const Ray ray = pixel_ray(camera, x, y);
  const glm::dvec3 floor = on_plane(ray, {0, 0, 0}, {0, 0, 1}),
                   wall = on_plane(ray, {0, 0, 0}, {1, 0, 0});
  return wall_occlusion((ray.direction.z < 0 && floor.x > 0 ? floor.x : wall.z) / reach);
}

struct Judged {
  double rmse, ratio;  // of occlusion, to what is due
};
Judged judge_corner(const Picture& p, const gpu_scene::Camera& camera, double reach) {
  double squares = 0, sum = 0, due_sum = 0;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) {
      const double due = due_in_corner(camera, x, y, reach), found = 1 - p.value(Pass::kAo, x, y);
      squares += (found - due) * (found - due);
      sum += found;
      due_sum += due;
    }
  return {std::sqrt(squares / (p.width * p.height)), sum / due_sum};
}

TEST(Occlusion, CornersAreOccludedAsTheirWallsTell) {
  const gpu_scene::Camera camera = perspective({4, -1, 2.5}, {0.3, 0, 0.3}, 0.5, kSize, kSize);
  const TestScene s = corner();
  const Judged exact = judge_corner(render(s, traced(occluded(camera, 1), 64)), camera, 1);
  // The noise of 64 rays a pixel.
  EXPECT_LT(exact.rmse, 0.03);
  EXPECT_NEAR(exact.ratio, 1, 0.01);
  // What the estimators are known to be off: points within r_max stand for rays up to it, so that
  // SSAO misses a quarter next to a wall, and what lies beside the picture is missed by all.
  const Judged most[] = {{0.09, 1.3}, {0.09, 0.75}, {0.06, 0.9}},
               least[] = {{0, 1}, {0, 0.5}, {0, 0.65}};
  for (Estimator estimator : kEstimators) {
    engine::RenderRequest r = occluded(camera, 1, 8);
    r.occlusion.estimator = estimator;
    const Judged found = judge_corner(render(s, r), camera, 1);
    const size_t i = size_t(estimator);
    EXPECT_LT(found.rmse, most[i].rmse) << i;
    EXPECT_LT(found.ratio, most[i].ratio) << i;
    EXPECT_GT(found.ratio, least[i].ratio) << i;
  }
}

// Another view takes at least this off the error of the camera's.
constexpr double kNearer = 0.7;

TEST(Occlusion, OtherViewsShowWhatStandsBesideThePicture) {
  // The wall stands next to what the camera sees of the floor. A sun from the other side shows it,
  // as do a lamp with a cube of maps and a phantom camera.
  const gpu_scene::Camera camera = perspective({0.7, 0, 3}, {0.7, 0, 0}, 0.4, kSize, kSize);
  const TestScene s = corner();
  const Picture exact = render(s, traced(occluded(camera, 1), 64));
  for (Estimator estimator : kEstimators) {
    engine::RenderRequest r = occluded(camera, 1, 4);
    r.occlusion.estimator = estimator;
    const double alone = rmse(render(s, r)[Pass::kAo], exact[Pass::kAo]);
    r.occlusion.secondary_views = 1;
    for (const scene::Light& lamp : {sun({-1, 0.25f, -1}, 1), point({3, 0, 3}, 10),
                                     spot({3, 0, 3}, {-1, 0, -1}, 10, 1.2f, 0)}) {
      TestScene lit = s;
      lit.lights = {lamp};
      const Picture p = render(lit, r);
      const double with = rmse(p[Pass::kAo], exact[Pass::kAo]);
      EXPECT_TRUE(effect_of(p, "occlusion_lamp_views").runs) << int(lamp.type);
      EXPECT_LT(with, kNearer * alone) << int(estimator) << ", lamp " << int(lamp.type);
    }
    r.occlusion.secondary_views = 0;
    r.occlusion.phantoms = Phantoms::kOn;
    const double pair = rmse(render(s, r)[Pass::kAo], exact[Pass::kAo]);
    r.occlusion.phantom_camera_count = 1;
    r.occlusion.phantom_cameras[0] = perspective({3, 0, 3}, {0.5, 0, 0.25}, 1, 64, 64);
    const double chosen = rmse(render(s, r)[Pass::kAo], exact[Pass::kAo]);
    EXPECT_LT(pair, kNearer * alone) << int(estimator);
    EXPECT_LT(chosen, kNearer * alone) << int(estimator);
  }
}

TEST(Occlusion, LampsShowTheFarSideOfWhatTheCameraSees) {
  // The camera sees a partition from above and the floor behind it, but not its side towards that.
  TestScene s;
  const Id white = s.add_material(lambert());
  s.add_object(floor_at(0, 6), {white});
  s.add_object(box({0, 0, 0.75f}, {3, 0.25f, 0.75f}), {white});
  s.lights = {sun({0, -0.5f, -1}, 1), point({0, 2.5f, 2.5f}, 10)};
  const gpu_scene::Camera camera = perspective({0, -1.5, 6}, {0, 1.25, 0}, 0.3, kSize, kSize);
  const Picture exact = render(s, traced(occluded(camera, 2), 64));
  for (Estimator estimator : kEstimators) {
    engine::RenderRequest r = occluded(camera, 2, 4);
    r.occlusion.estimator = estimator;
    const double alone = rmse(render(s, r)[Pass::kAo], exact[Pass::kAo]);
    r.occlusion.secondary_views = 2;
    EXPECT_LT(rmse(render(s, r)[Pass::kAo], exact[Pass::kAo]), kNearer * alone) << int(estimator);
  }
}

TEST(Occlusion, ALampAboveATableShowsThatItsTopStandsOverTheFloor) {
  TestScene s;
  const Id white = s.add_material(lambert());
  s.add_object(floor_at(0, 6), {white});
  s.add_object(box({0, 0, 0.75f}, {1, 1, 0.05f}), {white});
  s.lights = {sun({0.3f, 0.2f, -1}, 1)};
  const gpu_scene::Camera camera = perspective({0.5, -4, 1.2}, {0, 0, 0.3}, 0.6, kSize, kSize);
  const Picture exact = render(s, traced(occluded(camera, 1), 64));
  for (Estimator estimator : kEstimators) {
    engine::RenderRequest r = occluded(camera, 1, 2);
    r.occlusion.estimator = estimator;
    const double alone = rmse(render(s, r)[Pass::kAo], exact[Pass::kAo]);
    r.occlusion.secondary_views = 1;
    // The floor below is hidden from the lamp, which counts less for it than where it sees the
    // floor.
    EXPECT_LT(rmse(render(s, r)[Pass::kAo], exact[Pass::kAo]), 0.8 * alone) << int(estimator);
  }
}

// World axes; the picture has .5 + .5 n.
glm::dvec3 bent_normal(const Picture& p, int x, int y) {
  return 2.0 * p.rgb(Pass::kCombined, x, y) - 1.0;
}

TEST(Occlusion, BentNormalsLeanTowardsWhereItIsOpen) {
  const gpu_scene::Camera camera = perspective({4, -1, 2.5}, {0.3, 0, 0.3}, 0.5, kSize, kSize);
  TestScene alone;
  alone.add_object(floor_at(0, 9), {alone.add_material(lambert())});
  for (Estimator estimator : kEstimators)
    for (Filter filter : {Filter::kOff, Filter::kOn}) {
      engine::RenderRequest r = occluded(camera, 1);
      r.occlusion.estimator = estimator;
      r.occlusion.filter = filter;
      r.occlusion.samples = 64;
      r.occlusion.picture = ambient_occlusion::Picture::kBentNormals;
      const Picture flat = render(alone, r), p = render(corner(), r);
      Worst unbent, sizes;
      double leaning = 0, due = 0;
      int near = 0, towards = 0;
      for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
          const Ray ray = pixel_ray(camera, x, y);
          const glm::dvec3 floor = on_plane(ray, {0, 0, 0}, {0, 0, 1});
          const glm::dvec3 n = bent_normal(p, x, y);
          sizes.compare(glm::length(n), 1, 1, x, y);
          if (ray.direction.z < 0 && floor.x < 8)
            unbent.compare(glm::distance(bent_normal(flat, x, y), {0, 0, 1}), 0, 1, x, y);
          if (ray.direction.z > 0 || floor.x < 0 || floor.x > 0.5) continue;
          ++near;
          towards += n.x < 0;
          leaning += std::atan2(n.x, n.z);
          // What the wall's segment of the disk takes from the mean direction, 2/3 of the normal.
          const double k = floor.x, across = 2 / (3 * kPi) * std::pow(1 - k * k, 1.5);
          due += std::atan2(across, 2 / 3.0 - 0.5 * (2 / 3.0 - k + k * k * k / 3));
        }
      EXPECT_GT(near, 20);
      EXPECT_EQ(towards, 0);
      EXPECT_GT(leaning / due, 0.5) << int(estimator) << " " << int(filter);
      EXPECT_LT(leaning / due, 1) << int(estimator) << " " << int(filter);
      EXPECT_WORST_BELOW(unbent, 1e-3);
      EXPECT_WORST_BELOW(sizes, 2e-3);
    }
}

TEST(Occlusion, AWhiteFurnaceShowsVisibility) {
  const gpu_scene::Camera camera = perspective({4, -1, 2.5}, {0.3, 0, 0.3}, 0.5, kSize, kSize);
  TestScene s = corner();
  s.world = constant_world(glm::vec3(1));
  for (Estimator estimator : kEstimators)
    for (float strength : {1.0f, 0.25f}) {
      engine::RenderRequest r = occluded(camera, 1, 2);
      r.occlusion.estimator = estimator;
      r.occlusion.strength = strength;
      const Picture p = render(s, r);
      Worst worst;
      double brightest = 0, darkest = 1;
      for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
          const double light = p.value(Pass::kCombined, x, y);
          worst.compare(light, 1 - strength * (1 - p.value(Pass::kAo, x, y)), 1, x, y);
          brightest = std::max(brightest, light);
          darkest = std::min(darkest, light);
        }
      EXPECT_WORST_BELOW(worst, 1e-5);
      EXPECT_LE(brightest, 1 + 1e-5);
      EXPECT_LT(darkest, 1 - 0.3 * strength);
    }
}

}  // namespace
}  // namespace panoptes::test
