// Passes that need no light: depth, normals, coverage; the pixel filter; ranges of samples.
#include "support.h"

#include <cmath>

namespace panoptes::test {
namespace {

using film::Pass;

std::vector<gpu_scene::Camera> cameras() {
  return {perspective({0.4, -3, 2}, {0, 0, 0}, 0.9, 40, 30),
          perspective({0.4, -3, 2}, {0, 0, 0}, 0.9, 40, 30, 0.01, 100, {0.2, 0.1}),
          orthographic({0.4, -3, 2}, {0, 0, 0}, 1.4, 40, 30)};
}

TEST(Passes, DepthIsTheDistanceAlongTheAxis) {
  TestScene s;
  s.add_object(floor_at(0, 1.5f), {s.add_material(lambert())});
  for (const gpu_scene::Camera& camera : cameras()) {
    const Picture p = render(s, request(camera, {Pass::kDepth}));
    Worst worst;
    int background = 0;
    for (int y = 0; y < p.height; ++y)
      for (int x = 0; x < p.width; ++x) {
        const glm::dvec3 hit = on_plane(pixel_ray(camera, x, y), {0, 0, 0}, {0, 0, 1});
        const double beside = std::max(std::abs(hit.x), std::abs(hit.y)) - 1.5;
        if (std::abs(beside) < 1e-4) continue;
        const double depth = -(camera.world_to_camera * glm::dvec4(hit, 1)).z;
        const bool outside = beside > 0;
        background += outside;
        worst.compare(p.value(Pass::kDepth, x, y), outside ? 1e10 : depth, 1, x, y);
      }
    EXPECT_WORST_BELOW(worst, 2e-6);
    EXPECT_GT(background, 50);
    EXPECT_LT(background, 1100);
  }
}

TEST(Passes, DepthBufferOrdersSurfaces) {
  // Two squares that cut through each other.
  TestScene s;
  const Id red = s.add_material(lambert({1, 0, 0})), green = s.add_material(lambert({0, 1, 0}));
  s.add_object(quad({0, 0, 0}, {1, 0, 0.5f}, {0, 1, 0}), {red});
  s.add_object(quad({0, 0, 0}, {1, 0, -0.5f}, {0, 1, 0}), {green});
  const gpu_scene::Camera camera = orthographic({0, 0, 3}, {0, 0, 0}, 0.9, 32, 32);
  const Picture p = render(s, request(camera, {Pass::kDiffCol}));
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x)
      EXPECT_EQ(p.rgb(Pass::kDiffCol, x, y), x >= 16 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0));
}

TEST(Passes, NormalsAreThoseOfTheSphere) {
  TestScene s;
  s.add_object(sphere({0, 0, 0}, 1, 64), {s.add_material(lambert())});
  const gpu_scene::Camera camera = perspective({0, -4, 1}, {0, 0, 0}, 0.5, 32, 32);
  const Picture p = render(s, request(camera, {Pass::kNormal, Pass::kDepth}));
  int seen = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const glm::dvec3 n = p.rgb(Pass::kNormal, x, y);
      if (p.value(Pass::kDepth, x, y) > 1e9) {
        EXPECT_EQ(n, glm::dvec3(0));
        continue;
      }
      const Ray ray = pixel_ray(camera, x, y);
      const double b = glm::dot(ray.origin, ray.direction),
                   c = glm::dot(ray.origin, ray.origin) - 1, root = b * b - c;
      if (root < 0.05) continue;  // the silhouette, where normals are turned to the viewer
      ++seen;
      EXPECT_NEAR(glm::length(n), 1, 1e-6);
      // Facets of 5.6 degrees cut below the sphere by .0012 of its radius, seen at a slant.
      EXPECT_LT(glm::length(n - glm::normalize(ray.at(-b - std::sqrt(root)))), 0.01);
    }
  EXPECT_GT(seen, 300);
}

TEST(Passes, NormalsOfFlatFacesFaceTheViewer) {
  TestScene s;
  s.add_object(box({0, 0, 0}, glm::vec3(1)), {s.add_material(lambert())});
  for (const glm::dvec3& eye : {glm::dvec3(3, 2, 4), glm::dvec3(0.2, -0.3, 0.1)}) {  // out and in
    const gpu_scene::Camera camera = perspective(eye, {-1, 0.1, 0.2}, 1.2, 24, 24);
    const Picture p = render(s, request(camera, {Pass::kNormal, Pass::kDepth}));
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 24; ++x) {
        if (p.value(Pass::kDepth, x, y) > 1e9) continue;
        const glm::dvec3 n = p.rgb(Pass::kNormal, x, y);
        EXPECT_LT(glm::dot(n, pixel_ray(camera, x, y).direction), 0);
        EXPECT_NEAR(std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}), 1, 1e-6);
      }
  }
}

TEST(Passes, EmissionIsExact) {
  TestScene s;
  s.add_object(floor_at(0, 1), {s.add_material(emitter({0.1f, 123.456f, 70000.0f}))});
  const Picture p =
      render(s, request(orthographic({0, 0, 3}, {0, 0, 0}, 2, 16, 16), {Pass::kEmit}));
  EXPECT_EQ(p.rgb(Pass::kEmit, 8, 8), glm::dvec3(0.1f, 123.456f, 70000.0f));
  EXPECT_EQ(p.rgb(Pass::kCombined, 8, 8), p.rgb(Pass::kEmit, 8, 8));
  EXPECT_EQ(p.rgb(Pass::kEmit, 1, 1), glm::dvec3(0));
}

TEST(Passes, ExposureScalesLightAndNothingElse) {
  TestScene s;
  s.add_object(floor_at(0, 1), {s.add_material(lambert({0.5f, 0.5f, 0.5f}))});
  s.lights = {sun({0, 0, -1}, float(kPi))};
  s.world = constant_world(glm::vec3(0.25f));
  engine::RenderRequest r =
      request(orthographic({0, 0, 3}, {0, 0, 0}, 2, 16, 16),
              {Pass::kDiffDir, Pass::kDiffCol, Pass::kEnv, Pass::kNormal, Pass::kDepth});
  const Picture plain = render(s, r);
  r.exposure = 4;
  const Picture exposed = render(s, r);
  for (Pass pass : {Pass::kDiffDir, Pass::kEnv})
    for (const auto& [x, y] : {std::pair(8, 8), {1, 1}})
      EXPECT_FLOAT_EQ(exposed.value(pass, x, y), 4 * plain.value(pass, x, y));
  for (Pass pass : {Pass::kDiffCol, Pass::kNormal, Pass::kDepth})
    EXPECT_EQ(exposed[pass], plain[pass]);
  EXPECT_FLOAT_EQ(exposed.value(Pass::kCombined, 8, 8), 4 * plain.value(Pass::kCombined, 8, 8));
  EXPECT_EQ(exposed.value(Pass::kCombined, 8, 8, 3), 1);
}

TEST(Passes, TheFilterIsABlackmanHarrisWindow) {
  // Coverage of a pixel whose centre lies half a pixel outside of a straight edge, after many
  // samples: the window's integral beyond half a pixel. The facts measure .8814 for the other side.
  TestScene s;
  s.add_object(quad({-1, 0, 0}, {1, 0, 0}, {0, 4, 0}), {s.add_material(lambert())});
  // Sixteen pixels for two metres: the edge at x = 0 runs between pixels 7 and 8.
  engine::RenderRequest r =
      request(orthographic({0, 0, 3}, {0, 0, 0}, 1, 16, 16), {Pass::kDiffCol}, 512);
  const Picture p = render(s, r);
  // A plain count of hits: 512 points of a sequence, so 3 / 512 or so off.
  EXPECT_NEAR(p.value(Pass::kDiffCol, 7, 8), 0.8814, 0.006);
  EXPECT_NEAR(p.value(Pass::kDiffCol, 8, 8), 1 - 0.8814, 0.006);
  EXPECT_EQ(p.value(Pass::kDiffCol, 5, 8), 1);
  EXPECT_EQ(p.value(Pass::kDiffCol, 10, 8), 0);
}

TEST(Passes, DividedPassesAreRatiosOfMeans) {
  // At an edge between albedo .8 in full light and albedo .1 in half of it, DiffDir is
  // sum(light * albedo) / sum(albedo), as in Cycles.
  TestScene s;
  const Id light = s.add_material(lambert(glm::vec3(0.8f))),
           dark = s.add_material(lambert(glm::vec3(0.1f)));
  s.add_object(quad({-1, 0, 0}, {1, 0, 0}, {0, 4, 0}), {light});
  // A roof of 60 degrees, so that a vertical sun lights it by half.
  s.add_object(quad({0.5f, 0, -0.866025f}, {0.5f, 0, -0.866025f}, {0, 4, 0}), {dark});
  s.lights = {sun({0, 0, -1}, float(kPi))};
  s.lights[0].cast_shadow = false;
  const Picture p = render(s, request(orthographic({0, 0, 3}, {0, 0, 0}, 1, 16, 16),
                                      {Pass::kDiffDir, Pass::kDiffCol}, 64));
  const double albedo = p.value(Pass::kDiffCol, 8, 8);
  const double covered = (albedo - 0.1) / 0.7;  // by the bright side
  EXPECT_GT(covered, 0.05);
  EXPECT_LT(covered, 0.3);
  const double due = (covered * 0.8 + (1 - covered) * 0.1 * 0.5) / albedo;
  EXPECT_NEAR(p.value(Pass::kDiffDir, 8, 8), due, 1e-3);
}

TEST(Passes, RangesOfSamplesAddUp) {
  TestScene s;
  s.add_object(box({0, 0, 0}, glm::vec3(1)), {s.add_material(lambert({0.5f, 0.25f, 1}))});
  s.lights = {area({2, -2, 4}, {-0.5f, 0.5f, -1}, 300, scene::AreaShape::kSquare, 1, 1)};
  engine::RenderRequest r =
      request(perspective({2, -3, 3}, {0, 0, 0}, 0.7, 24, 24), {Pass::kNormal}, 12);
  const Picture all = render(s, r);
  r.first_sample = 0;
  r.last_sample = 5;
  const Picture head = render(s, r);
  r.first_sample = 5;
  r.last_sample = 12;
  const Picture tail = render(s, r);
  Worst worst;
  for (size_t i = 0; i < all[Pass::kCombined].size(); ++i)
    worst.compare((5 * head[Pass::kCombined][i] + 7 * tail[Pass::kCombined][i]) / 12,
                  all[Pass::kCombined][i], 1e-2, int(i / 4 % 24), int(i / 96));
  for (size_t i = 0; i < all[Pass::kNormal].size(); ++i)
    worst.compare((5 * head[Pass::kNormal][i] + 7 * tail[Pass::kNormal][i]) / 12,
                  all[Pass::kNormal][i], 1e-1, int(i / 3 % 24), int(i / 72));
  EXPECT_WORST_BELOW(worst, 1e-5);
}

TEST(Passes, SeedsChangeTheNoiseAndNotTheMean) {
  TestScene s;
  s.add_object(box({0, 0, 0}, glm::vec3(1)), {s.add_material(lambert())});
  s.lights = {area({2, -2, 4}, {-0.5f, 0.5f, -1}, 300, scene::AreaShape::kSquare, 1, 1)};
  engine::RenderRequest r = request(perspective({2, -3, 3}, {0, 0, 0}, 0.7, 24, 24), {}, 8);
  const std::vector<float> a = render(s, r)[Pass::kCombined];
  r.seed = 1;
  const std::vector<float> b = render(s, r)[Pass::kCombined];
  EXPECT_NE(a, b);
  EXPECT_NEAR(mean(a), mean(b), 0.02 * mean(a));
}

TEST(Passes, UnaskedPassesAreNotThere) {
  TestScene s;
  shared_engine().edit([&](scene::Scene& scene) { s.install(scene); });
  const auto job = shared_engine().render(request(perspective({0, 0, 1}, {0, 0, 0}, 1, 4, 4), {}));
  ASSERT_TRUE(job->wait(30));
  EXPECT_EQ(job->read(Pass::kCombined).size(), 64u);
  expect_error([&] { job->read(Pass::kNormal); }, "'Normal'");
}

TEST(Passes, TheEstimatedErrorIsTheRealOne) {
  // Relative standard error of 8 samples' brightness, against the spread of many seeds.
  TestScene s;
  s.add_object(box({0, 0, 0}, glm::vec3(1)), {s.add_material(lambert())});
  s.lights = {area({2, -2, 4}, {-0.5f, 0.5f, -1}, 300, scene::AreaShape::kSquare, 2, 2)};
  engine::RenderRequest r = request(perspective({2, -3, 3}, {0, 0, 0}, 0.7, 24, 24), {}, 256);
  const std::vector<float> truth = render(s, r)[Pass::kCombined];
  r.last_sample = 8;
  double squares = 0, estimate = 0;
  for (uint32_t seed = 0; seed < 8; ++seed) {
    r.seed = 100 + seed;
    const Picture p = render(s, r);
    ASSERT_TRUE(p.stats.estimated_error);
    estimate += *p.stats.estimated_error / 8;
    double sum = 0;
    for (size_t i = 0; i < truth.size(); i += 4)
      sum += std::pow(double(p[Pass::kCombined][i]) - truth[i], 2);
    squares += sum / double(truth.size() / 4) / 8;
  }
  double brightness = 0;
  for (size_t i = 0; i < truth.size(); i += 4) brightness += truth[i] / double(truth.size() / 4);
  const double real = std::sqrt(squares) / brightness;
  // It takes samples for independent: stratified ones err less, never more.
  EXPECT_LT(real, 1.1 * estimate);
  EXPECT_GT(real, 0.1 * estimate);
}

}  // namespace
}  // namespace panoptes::test
