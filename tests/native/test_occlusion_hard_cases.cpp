// Hard scenes and views for ambient occlusion: finite, 0 to 1, the same picture twice, near to what
// is due.
#include "film/average.h"
#include "film/pieces.h"
#include "occlusion_scenes.h"
#include "still_life.h"

#include <cmath>
#include <limits>

namespace panoptes::test {
namespace {

using ambient_occlusion::Filter;
using ambient_occlusion::Phantoms;
using film::Pass;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// By all kinds of views, filtered.
engine::RenderRequest by_all_views(const gpu_scene::Camera& camera, float distance) {
  engine::RenderRequest r = occluded(camera, distance);
  r.occlusion.secondary_views = 2;
  r.occlusion.phantoms = Phantoms::kOn;
  r.occlusion.phantom_resolution = 64;
  r.occlusion.filter = Filter::kOn;
  return r;
}

// Renders what the scene holds twice; returns the AO pass.
std::vector<float> again(const engine::RenderRequest& r, const std::string& label) {
  const Picture first = render(r), second = render(r);
  for (const auto& [pass, pixels] : first.passes)
    EXPECT_TRUE(pixels == second[pass]) << label << ": " << film::info(pass).name;
  for (float v : first[Pass::kAo]) {
    EXPECT_TRUE(v >= 0 && v <= 1) << label << ": " << v;
    if (!(v >= 0 && v <= 1)) break;
  }
  return first[Pass::kAo];
}

std::vector<float> twice(const TestScene& s, const engine::RenderRequest& r,
                         const std::string& label) {
  shared_engine().edit([&](scene::Scene& scene) { s.install(scene); });
  return again(r, label);
}

// A still life in a white world, so that bent normals run too.
StillLife lit_life(float scale = 1, const glm::dvec3& origin = {0, 0, 0}, int size = 32) {
  StillLife life = still_life(scale, origin, size);
  life.scene.world = constant_world(glm::vec3(1));
  return life;
}

// How near to traced occlusion pictures of a still life are, with r_max a quarter of its width:
// edges of pixels that are seen through their centre alone are .05 off.
constexpr double kNear = 0.1;

TEST(OcclusionHardCases, ScalesAndFarOrigins) {
  const StillLife life = lit_life();
  for (Estimator estimator : kEstimators) {
    engine::RenderRequest r = by_all_views(life.camera, 1);
    r.occlusion.estimator = estimator;
    const std::vector<float> due = twice(life.scene, r, "as it is");
    for (float scale : {1e-3f, 1e3f}) {
      const StillLife other = lit_life(scale);
      r.camera = other.camera;
      r.occlusion.distance = scale;
      const std::vector<float> found = twice(other.scene, r, "scaled");
      EXPECT_LT(rmse(found, due), 1e-4) << int(estimator) << ", scale " << scale;
    }
    const StillLife far = lit_life(1, {-1048576, 1048576, 524288});
    r.camera = far.camera;
    r.occlusion.distance = 1;
    // Where the camera stands is rounded to another place: less than the noise of a pixel.
    EXPECT_LT(rmse(twice(far.scene, r, "far away"), due), 0.01) << int(estimator);
  }
}

TEST(OcclusionHardCases, DistancesFromNothingToAll) {
  const StillLife life = lit_life();
  shared_engine().edit([&](scene::Scene& scene) { life.scene.install(scene); });
  std::vector<float> wide[3];
  for (float distance : {1e-6f, 1e-3f, 0.25f, 1.0f, 1e3f, 1e6f}) {
    engine::RenderRequest r = by_all_views(life.camera, distance);
    const std::vector<float> exact = render(traced(r, 16))[Pass::kAo];
    for (Estimator estimator : kEstimators) {
      r.occlusion.estimator = estimator;
      const std::string label = fmt::format("{} m, estimator {}", distance, int(estimator));
      const std::vector<float> found = again(r, label);
      // Where r_max is the scene's width, half of what occludes lies beside the picture.
      EXPECT_LT(rmse(found, exact), distance <= 1 ? kNear : 0.2) << label;
      EXPECT_NEAR(mean(found), mean(exact),
                  distance < 0.01f ? 1e-3
                  : distance <= 1  ? 0.03
                                   : 0.11)
          << label;
      std::vector<float>& all = wide[size_t(estimator)];
      if (distance == 1e3f) all = found;
      if (distance == 1e6f) {
        EXPECT_TRUE(found == all) << label << ": the scene has an end";
      }
    }
  }
}

TEST(OcclusionHardCases, SizesAndEmptyScenes) {
  const StillLife life = lit_life();
  for (const auto& [w, h] : {std::pair(1, 1), {1, 5}, {17, 13}}) {
    engine::RenderRequest r = by_all_views(life.camera, 1);
    r.camera.width = w;
    r.camera.height = h;
    EXPECT_EQ(twice(life.scene, r, "size").size(), size_t(3 * w * h));
  }
  TestScene nothing;
  const engine::RenderRequest r = by_all_views(life.camera, 1);
  EXPECT_EQ(mean(twice(nothing, r, "empty")), 0);
  nothing.lights = life.scene.lights;
  nothing.world = life.scene.world;
  EXPECT_EQ(mean(twice(nothing, r, "lamps alone")), 0);
}

TEST(OcclusionHardCases, FlatScenesAndOneTriangleAreOpen) {
  const StillLife life = lit_life();
  TestScene flat = life.scene;
  flat.instances.resize(1);
  Geometry one;
  one.positions = {{-1, 0, 0.25f}, {1, 0, 0.25f}, {0, 0, 1}};
  one.triangles = one.loops = {{0, 1, 2}};
  one.slots = {0};
  one.normals.assign(3, {0, -1, 0});
  one.uv.assign(6, 0);
  TestScene triangle;
  triangle.lights = life.scene.lights;
  triangle.add_object(one, {triangle.add_material(lambert())});
  for (Estimator estimator : kEstimators)
    for (const TestScene& s : {flat, triangle}) {
      engine::RenderRequest r = by_all_views(life.camera, 1);
      r.occlusion.estimator = estimator;
      int open = 0;
      for (float v : twice(s, r, "flat")) {
        if (v == 0) continue;  // where nothing is seen
        ++open;
        ASSERT_GE(v, 1 - 1.0f / 2048);
      }
      EXPECT_GT(open, 20);
    }
}

TEST(OcclusionHardCases, NarrowWideAndParallelCameras) {
  const StillLife life = lit_life();
  const glm::dvec3 eye(0.5, -5, 3), target(0, 0, 0.5);
  for (const gpu_scene::Camera& camera :
       {perspective(eye, target, kPi / 180, 32, 32),
        perspective({0, -1, 0.75}, target, 179 * kPi / 180, 32, 32),
        orthographic(eye, target, 2, 32, 32),
        perspective(eye, target, 0.75, 32, 32, 0.01, 100, {0.5, -0.25}),
        orthographic(eye, target, 2, 32, 32, -50, 50)}) {
    const engine::RenderRequest r = by_all_views(camera, 1);
    const std::vector<float> found = twice(life.scene, r, "camera");
    const std::vector<float> exact = render(traced(r, 16))[Pass::kAo];
    EXPECT_LT(rmse(found, exact), kNear);
  }
}

TEST(OcclusionHardCases, CamerasAndLampsWhereSurfacesAre) {
  TestScene s;
  const Id white = s.add_material(lambert());
  s.world = constant_world(glm::vec3(1));
  s.add_object(floor_at(0, 3), {white});
  s.add_object(box({0, 0, 0}, glm::vec3(1)), {white});
  // On a face, on an edge, inside; the near plane in front of a face and behind it.
  for (const glm::dvec3& eye : {glm::dvec3(0, 0, 0.5), glm::dvec3(0, 0, 1), glm::dvec3(1, 1, 1),
                                glm::dvec3(0, -1.009, 0.5), glm::dvec3(0, -1.011, 0.5)})
    for (const glm::vec3& lamp : {glm::vec3(0, 0, 1), glm::vec3(1, 0, 1), glm::vec3(0, 0, 0.5f)}) {
      s.lights = {point(lamp, 10), area(lamp, {0, 0, -1}, 10, scene::AreaShape::kDisk, 0, 0)};
      twice(s, by_all_views(perspective(eye, eye + glm::dvec3(0.3, 1, 0.1), 1, 16, 16), 1),
            "on a surface");
    }
  // A box from within.
  s.lights.clear();
  TestScene room;
  room.add_object(box({0, 0, 0}, glm::vec3(1)), {room.add_material(lambert())});
  for (Estimator estimator : kEstimators) {
    engine::RenderRequest r =
        by_all_views(perspective({0.5, -0.5, 0}, {-0.3, 1, 0.1}, 2, 32, 32), 1);
    r.occlusion.estimator = estimator;
    const std::vector<float> found = twice(room, r, "within");
    const std::vector<float> exact = render(traced(r, 16))[Pass::kAo];
    // Half of what occludes lies behind the camera.
    EXPECT_LT(rmse(found, exact), 0.25) << int(estimator);
    EXPECT_LT(mean(found), 0.85) << int(estimator);
  }
}

TEST(OcclusionHardCases, ViewsThatTellNothingCountForNothing) {
  TestScene s = corner();
  engine::RenderRequest r = occluded(perspective({4, -1, 2.5}, {0.3, 0, 0.3}, 0.5, 32, 32), 1);
  for (Estimator estimator : kEstimators) {
    r.occlusion.estimator = estimator;
    r.occlusion.secondary_views = 8;
    r.occlusion.phantom_camera_count = 0;
    s.lights.clear();
    const std::vector<float> alone = twice(s, r, "alone");
    // Its cone shows nothing.
    s.lights = {spot({2, 0, 3}, {0, 0, 1}, 10, 0.5f, 0)};
    EXPECT_TRUE(twice(s, r, "blind lamp") == alone);
    // They look up, down from below all, and begin behind it.
    r.occlusion.phantom_camera_count = 1;
    for (const gpu_scene::Camera& phantom :
         {perspective({2, 0, 2}, {2, 0, 9}, 1, 8, 8), perspective({2, 0, -1}, {2, 0, -9}, 1, 8, 8),
          perspective({4, 0, 4}, {0, 0, 0}, 1, 8, 8, 100, 200)}) {
      r.occlusion.phantom_cameras[0] = phantom;
      EXPECT_TRUE(twice(s, r, "blind phantom") == alone);
    }
    // Below the floor and in the next room. They cannot know that what hides surfaces from them is
    // only that, so they count little: unweighted they took errors from .05 to .08 to as much as
    // .2.
    const std::vector<float> exact = render(traced(r, 64))[Pass::kAo];
    r.occlusion.phantom_camera_count = 0;
    for (const scene::Light& lamp :
         {point({2, 0, -2}, 10), point({-2, 0, 2}, 10), sun({0, 0, 1}, 1)}) {
      s.lights = {lamp};
      EXPECT_LT(rmse(twice(s, r, "behind"), exact), 0.12)
          << int(estimator) << ", lamp " << int(lamp.type);
    }
  }
}

TEST(OcclusionHardCases, PhantomCamerasThatAreBrokenAreRefused) {
  engine::RenderRequest r = by_all_views(lit_life().camera, 1);
  r.occlusion.phantom_camera_count = 2;
  r.occlusion.phantom_cameras[0] = r.occlusion.phantom_cameras[1] = r.camera;
  r.occlusion.phantom_cameras[1].world_to_camera[3].x = kNaN;
  expect_error([&] { shared_engine().render(r); }, "phantom camera 2");
  r.occlusion.phantom_cameras[1] = r.camera;
  r.occlusion.phantom_cameras[0].projection[0][0] = 0;
  expect_error([&] { shared_engine().render(r); }, "phantom camera 1");
}

TEST(OcclusionHardCases, ManyLamps) {
  StillLife life = lit_life();
  for (int count : {8, 70}) {
    life.scene.lights.clear();
    for (int i = 0; i < count; ++i)
      life.scene.lights.push_back(point({-3 + 6.0f * i / count, -2 + 0.25f * (i % 16), 2}, 1));
    engine::RenderRequest r = by_all_views(life.camera, 1);
    r.shadow_resolution = 32;
    r.occlusion.secondary_views = 8;
    const std::vector<float> found = twice(life.scene, r, "many lamps");
    const std::vector<float> exact = render(traced(r, 16))[Pass::kAo];
    EXPECT_LT(rmse(found, exact), kNear) << count;
  }
}

TEST(OcclusionHardCases, AlphaEmissionAndFilmsWithoutBackground) {
  StillLife life = lit_life();
  life.scene.add_material(alpha_card({1, 1, 1, 0.5f}));
  life.scene.add_object(floor_at(0.75f, 2), {3});
  life.scene.add_material(emitter(glm::vec3(1)));
  life.scene.add_object(box({-2, -1, 0.5f}, glm::vec3(0.5f)), {4});
  engine::RenderRequest r = by_all_views(life.camera, 1);
  r.last_sample = 2;
  for (bool transparent : {false, true}) {
    r.transparent_film = transparent;
    twice(life.scene, r, "alpha and emission");
  }
  TestScene glow;
  glow.add_object(box({0, 0, 1}, glm::vec3(0.5f)), {glow.add_material(emitter(glm::vec3(1)))});
  const std::vector<float> found = twice(glow, r, "emission alone");
  EXPECT_GT(mean(found), 0);
}

TEST(OcclusionHardCases, TheBorderOfAPictureIsPartOfTheWhole) {
  // A window of 16 x 16 pixels, by a shifted camera, shows what the whole picture shows there.
  const StillLife life = lit_life(1, {0, 0, 0}, 48);
  engine::RenderRequest r = occluded(life.camera, 0.5f, 8);
  r.occlusion.phantoms = Phantoms::kOn;
  const Picture whole = render(life.scene, r);
  // The window's clip coordinates are 3 times the whole's, less its middle.
  glm::dmat4 window(1);
  window[0][0] = window[1][1] = 3;
  r.camera.projection = window * r.camera.projection;
  r.camera.width = r.camera.height = 16;
  const std::vector<float> part = twice(life.scene, r, "border");
  std::vector<float> due;
  for (int y = 16; y < 32; ++y)
    for (int x = 16; x < 32; ++x)
      for (int c = 0; c < 3; ++c) due.push_back(float(whole.value(Pass::kAo, x, y, c)));
  // Other numbers for each pixel, and what lies beside the window; occlusion itself is .15.
  EXPECT_LT(rmse(part, due), 0.04);
  EXPECT_LT(mean(due), 0.95);
}

TEST(OcclusionHardCases, RangesOfSamplesMergeToTheBitsOfOne) {
  const StillLife life = lit_life(1, {0, 0, 0}, 24);
  shared_engine().edit([&](scene::Scene& scene) { life.scene.install(scene); });
  for (Estimator estimator : kEstimators) {
    engine::RenderRequest r = by_all_views(life.camera, 1);
    r.occlusion.estimator = estimator;
    if (estimator == Estimator::kAlchemy) r.occlusion.phantoms = Phantoms::kAuto;
    r.occlusion.deep_shadows = 0.5f;
    r.pieces = true;
    r.last_sample = 4;
    const Picture whole = render(r);
    film::SampleSums merged;
    film::PassSet passes;
    for (uint32_t first : {0u, 2u}) {
      r.first_sample = first;
      r.last_sample = first + 2;
      const auto job = shared_engine().render(r);
      ASSERT_TRUE(job->wait(60));
      job->check();
      passes = job->pieces()->passes;
      for (const film::Piece& piece : job->pieces()->sums.pieces()) merged.add(piece);
    }
    const film::Layout layout(size_t(24 * 24), passes);
    for (Pass pass : {Pass::kAo, Pass::kCombined})
      EXPECT_TRUE(film::average(pass, merged.total(layout.begin(pass), layout.size(pass)), {},
                                {4, {}}, 1) == whole[pass])
          << film::info(pass).name << ", estimator " << int(estimator);
  }
}

}  // namespace
}  // namespace panoptes::test
