// What is drawn from phantom views, against rays through the same scene.
#include "ambient_occlusion/phantoms.h"
#include "gl/context.h"
#include "still_life.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace panoptes::test {
namespace {

using ambient_occlusion::View;
using gpu_scene::Camera;
using gpu_scene::LightView;

// The depth along the camera's axis at which the ray through a pixel first meets the scene, in
// double precision; 0 where it meets nothing.
double traced_depth(const TestScene& setup, const Camera& camera, double x, double y) {
  const Ray ray = camera_ray(camera, x, y);
  const LightView seen = gpu_scene::as_light_view(camera, {0, 0});
  double nearest = std::numeric_limits<double>::infinity();
  for (const scene::Instance& instance : setup.instances) {
    const scene::Mesh& mesh = setup.meshes[size_t(instance.mesh - 1)];
    for (const auto& triangle : mesh.triangles) {
      glm::dvec3 p[3];
      for (int k = 0; k < 3; ++k)
        p[k] = glm::dmat4(instance.object_to_world) *
                   glm::dvec4(glm::dvec3(mesh.positions[triangle[k]]), 1.0) -
               glm::dvec4(ray.origin, 0);
      const double u = glm::dot(ray.direction, glm::cross(p[1], p[2])),
                   v = glm::dot(ray.direction, glm::cross(p[2], p[0])),
                   w = glm::dot(ray.direction, glm::cross(p[0], p[1]));
      const bool inside = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
      const double t = glm::dot(ray.direction, (u * p[0] + v * p[1] + w * p[2]) / (u + v + w));
      if (inside && u + v + w != 0 && t > 0) nearest = std::min(nearest, t);
    }
  }
  return std::isfinite(nearest) ? glm::dot(ray.at(nearest) - seen.origin, seen.axis) : 0;
}

class PhantomMap : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { context = std::make_unique<gl::Context>(); }
  static void TearDownTestSuite() { context.reset(); }
  PhantomMap() : gpu(context->device()), timer(context->device()) {}

  // Draws `setup`, if given, from `views`; `random`: with random thresholds for alpha.
  void draw(const TestScene* setup, const std::vector<LightView>& views, int resolution,
            bool random = false, bool keep = false) {
    if (setup) setup->install(scene);
    gpu.update(scene);
    shared::View camera{};
    camera.alpha.x = random ? -1.0f : 0.5f;
    maps.render(views, resolution, camera, gpu, programs, timer, view_block, keep);
    EXPECT_NO_THROW(gl::check_errors("phantom views"));
  }

  // What a view's layer stores, row by row.
  std::vector<float> stored(size_t view) const {
    const shared::ShadowFace face = maps.views({}).at(view).faces.at(0);
    std::vector<float> depths(size_t(face.half_extent.w * face.depth.w));
    glGetTextureSubImage(maps.maps().id(), 0, 0, 0, int(face.half_extent.z),
                         int(face.half_extent.w), int(face.depth.w), 1, GL_DEPTH_COMPONENT,
                         GL_FLOAT, int(depths.size() * sizeof(float)), depths.data());
    return depths;
  }

  // Depth along the axis of what a view shows at a point's place.
  double depth_at(size_t view, const glm::dvec3& point, double* along) const {
    const shared::ShadowFace f = maps.views({}).at(view).faces.at(0);
    const glm::dvec3 p = point - glm::dvec3(f.origin);
    *along = glm::dot(p, glm::dvec3(f.axis));
    const glm::dvec2 ndc(glm::dot(p, glm::dvec3(f.x)) / *along - f.x.w,
                         glm::dot(p, glm::dvec3(f.y)) / *along - f.y.w);
    const glm::ivec2 size(f.half_extent.w, f.depth.w),
        at = glm::floor((ndc * 0.5 + 0.5) * glm::dvec2(size));
    if (at.x < 0 || at.y < 0 || at.x >= size.x || at.y >= size.y) return 0;
    return f.depth.x / (stored(view)[size_t(at.y * size.x + at.x)] - f.depth.y);
  }

  bool drawn() {  // whether anything was since the last call
    const std::vector<gl::PassTime> times = timer.times();
    timer.reset();
    return std::any_of(times.begin(), times.end(), [](const gl::PassTime& time) {
      return time.name == "occlusion_phantom_views_draw";
    });
  }

  static inline std::unique_ptr<gl::Context> context;
  scene::Scene scene;
  gpu_scene::GpuScene gpu;
  gl::ProgramCache programs;
  gl::PassTimer timer;
  gpu_scene::ViewBlock view_block;
  ambient_occlusion::PhantomMaps maps;
};

TEST_F(PhantomMap, IsTheCamerasDepthWhereAViewIsTheCamera) {
  const glm::dvec3 far(1048576, -1048576, 524288);
  for (const glm::dvec3& origin : {glm::dvec3(0), far}) {
    const TestScene setup = still_life(1, origin).scene;
    const glm::dvec3 eye = origin + glm::dvec3(0.5, -5, 3), target = origin + glm::dvec3(0, 0, 0.5);
    const std::vector<Camera> cameras{perspective(eye, target, 0.75, 48, 30),
                                      perspective(eye, target, 0.75, 30, 48, 0.1, 20, {0.2, -0.3}),
                                      orthographic(eye, target, 3, 48, 24, 0.1, 20, {0.1, 0.05})};
    std::vector<LightView> views;
    for (const Camera& camera : cameras) views.push_back(gpu_scene::as_light_view(camera, {0, 0}));
    draw(&setup, views, 48);
    const std::vector<View> described = maps.views(eye);
    ASSERT_EQ(described.size(), 3u);
    for (size_t v = 0; v < 3; ++v) {
      const Camera& camera = cameras[v];
      const shared::ShadowFace& face = described[v].faces.at(0);
      EXPECT_EQ(described[v].kind, ambient_occlusion::ViewKind::kPhantom);
      EXPECT_EQ(described[v].index, int(v));
      ASSERT_EQ(glm::ivec2(face.half_extent.w, face.depth.w),
                glm::ivec2(camera.width, camera.height));
      const std::vector<float> depths = stored(v);
      int wrong = 0;
      for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
          const double due = traced_depth(setup, camera, x + 0.5, y + 0.5);
          const double kept = depths[size_t(y * camera.width + x)];
          const double depth = kept == 0              ? 0
                               : camera.perspective() ? face.depth.x / (kept - face.depth.y)
                                                      : (kept - face.depth.y) / face.depth.x;
          // A part in ten thousand: vertices far away are rounded to 1/8 m in the scene itself,
          // which the rays see too, and transformed in single precision.
          wrong += std::abs(depth - due) > 1e-4 * due;
        }
      // A texel at an outline may fall to either side of it.
      EXPECT_LE(wrong, camera.width * camera.height / 200) << "view " << v;
    }
  }
}

// A card before a wall: what it hides from the camera.
TEST_F(PhantomMap, PairsSeeWhatTheCameraDoesNot) {
  TestScene s;
  const Id grey = s.add_material(lambert());
  s.add_object(quad({0, 4, 0}, {8, 0, 0}, {0, 0, 8}), {grey});
  s.add_object(quad({0, 2, 0}, {0.2f, 0, 0}, {0, 0, 0.2f}), {grey});
  // A wall behind the camera and one that its near plane cuts away.
  s.add_object(quad({0, -0.05f, 0}, {8, 0, 0}, {0, 0, 8}), {grey});
  s.add_object(quad({0, 0.3f, 0}, {8, 0, 0}, {0, 0, 8}), {grey});
  const Camera camera = perspective({0, 0, 0}, {0, 1, 0}, 0.8, 64, 36, 0.5, 100);
  scene::Bounds bounds;
  bounds.add({-8, -0.05f, -8});
  bounds.add({8, 4, 8});
  const std::vector<LightView> pair = ambient_occlusion::phantom_pair(camera, 4, bounds);
  draw(&s, pair, 128);
  for (const double x : {-0.3, 0.0, 0.3}) {
    const glm::dvec3 hidden(x, 4, 0);
    ASSERT_NEAR(traced_depth(s, perspective({0, 0, 0}, hidden, 0.8, 3, 3), 1.5, 1.5), 0.3, 0.05);
    int seen = 0;
    for (size_t v = 0; v < 2; ++v) {
      double along;
      seen += std::abs(depth_at(v, hidden, &along) - along) < 0.01;
    }
    EXPECT_GT(seen, 0) << x;
  }
}

TEST_F(PhantomMap, ViewsDrawTheirOwnRandomThresholds) {
  TestScene s;
  s.add_object(quad({0, 4, 0}, {8, 0, 0}, {0, 0, 8}),
               {s.add_material(alpha_card({1, 1, 1, 0.5f}))});
  const LightView view =
      gpu_scene::as_light_view(perspective({0, 0, 0}, {0, 1, 0}, 0.8, 64, 64), {0, 0});
  draw(&s, {view, view}, 64, true);
  const std::vector<float> first = stored(0), second = stored(1);
  int opaque = 0, both = 0;
  for (size_t i = 0; i < first.size(); ++i) {
    opaque += first[i] > 0;
    both += first[i] > 0 && second[i] > 0;
  }
  // Of 4096 texels half, and a quarter, within five standard deviations.
  EXPECT_NEAR(opaque, 2048, 160);
  EXPECT_NEAR(both, 1024, 140);
}

TEST_F(PhantomMap, IsDrawnAgainOnlyWhenItMustBe) {
  const StillLife life = still_life();
  std::vector<LightView> pair = ambient_occlusion::phantom_pair(life.camera, 5, {});
  draw(&life.scene, pair, 64);
  EXPECT_TRUE(drawn());
  const std::vector<float> before = stored(1);
  const GLuint array = maps.maps().id();
  draw(nullptr, pair, 64, false, true);
  EXPECT_FALSE(drawn());
  EXPECT_EQ(stored(1), before);
  draw(nullptr, pair, 64, false, false);
  EXPECT_TRUE(drawn()) << "the scene has changed";
  pair[1].near_depth *= 1.5;
  draw(nullptr, pair, 64, false, true);
  EXPECT_TRUE(drawn()) << "a view has moved";
  EXPECT_NE(stored(1), before);
  EXPECT_EQ(maps.maps().id(), array);
  draw(nullptr, pair, 32, false, true);
  EXPECT_TRUE(drawn()) << "the size has changed";
  maps.release();
  EXPECT_TRUE(maps.views({}).empty());
  EXPECT_FALSE(maps.maps());
}

}  // namespace
}  // namespace panoptes::test
