// Views of cameras and lamps: rays and clip transforms must agree with each other and with the
// matrices that Blender hands over.
#include "base/error.h"
#include "support.h"

#include <cmath>
#include <limits>
#include <random>

namespace panoptes::test {
namespace {

using gpu_scene::Camera;

// The point at `depth` along the axis on the ray of pixel coordinates (x, y), relative to the
// origin.
glm::dvec3 relative_at(const shared::View& view, double x, double y, double depth) {
  const auto v = [](const glm::vec4& a) { return glm::dvec3(a); };
  return v(view.ray_origin) + x * v(view.ray_origin_dx) + y * v(view.ray_origin_dy) +
         depth *
             (v(view.ray_direction) + x * v(view.ray_direction_dx) + y * v(view.ray_direction_dy));
}

std::vector<Camera> cameras(const glm::dvec3& eye) {
  const glm::dvec3 target = eye + glm::dvec3(-3, 4, -1.5);
  return {perspective(eye, target, 0.9, 40, 30, 0.1, 100),
          perspective(eye, target, 0.9, 40, 30, 0.1, 100, {0.3, -0.7}),
          perspective(eye, target, 0.02, 640, 3, 0.5, 1e5),
          orthographic(eye, target, 2.5, 40, 30, 0.1, 100),
          orthographic(eye, target, 2.5, 30, 40, 5, 100, {0.4, 0.25})};
}

// Near and far depths that the projections above were made of.
const double kNear[5] = {0.1, 0.1, 0.5, 0.1, 5};
const double kFar[5] = {100, 100, 1e5, 100, 100};

TEST(CameraView, RaysProjectBackToTheirPixel) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform;
  const std::vector<Camera> all = cameras({3, -2, 1});
  for (size_t c = 0; c < all.size(); ++c) {
    const Camera& camera = all[c];
    const shared::View view = gpu_scene::camera_view(camera, {0, 0});
    for (int i = 0; i < 500; ++i) {
      const double x = uniform(random) * camera.width, y = uniform(random) * camera.height;
      const double depth = kNear[c] * std::pow(kFar[c] / kNear[c], uniform(random));
      const glm::dvec3 p = relative_at(view, x, y, depth);
      EXPECT_NEAR(glm::dot(p, glm::dvec3(view.axis)), depth, 1e-5 * depth);
      const glm::dvec4 clip = glm::dmat4(view.clip_from_relative) * glm::dvec4(p, 1);
      const glm::dvec3 ndc = glm::dvec3(clip) / clip.w;
      // Single precision in the matrices: a few units in the last place of the image's width.
      EXPECT_NEAR((ndc.x * 0.5 + 0.5) * camera.width, x, 2e-6 * camera.width);
      EXPECT_NEAR((ndc.y * 0.5 + 0.5) * camera.height, y, 2e-6 * camera.height * (c == 2 ? 300 : 1))
          << "camera " << c;
      EXPECT_GE(ndc.z, -1e-6);
      EXPECT_LE(ndc.z, 1 + 1e-6);
    }
  }
}

TEST(CameraView, RaysAreThoseOfTheMatrices) {
  for (const Camera& camera : cameras({3, -2, 1})) {
    const shared::View view = gpu_scene::camera_view(camera, {0, 0});
    for (const glm::dvec2& pixel :
         {glm::dvec2(0, 0), glm::dvec2(camera.width, 0), glm::dvec2(7.5, 1.25),
          glm::dvec2(camera.width, camera.height)}) {
      const Ray ray = camera_ray(camera, pixel.x, pixel.y);
      for (double depth : {1.0, 20.0}) {
        const glm::dvec3 p =
            relative_at(view, pixel.x, pixel.y, depth) + glm::dvec3(view.world_origin);
        EXPECT_LT(glm::length(glm::cross(p - ray.origin, ray.direction)), 3e-6 * depth);
      }
    }
  }
}

TEST(CameraView, DepthIsReversedFromNearToFar) {
  const std::vector<Camera> all = cameras({3, -2, 1});
  for (size_t c = 0; c < all.size(); ++c) {
    const shared::View view = gpu_scene::camera_view(all[c], {0, 0});
    const auto depth_of = [&](double depth) {
      const glm::dvec4 clip =
          glm::dmat4(view.clip_from_relative) * glm::dvec4(relative_at(view, 3, 2, depth), 1);
      return clip.z / clip.w;
    };
    EXPECT_NEAR(depth_of(kNear[c]), 1, 3e-6);
    EXPECT_NEAR(depth_of(kFar[c]), 0, 3e-6);
    double before = depth_of(kNear[c]);
    for (double d = kNear[c] * 1.5; d < kFar[c]; d *= 1.5) {
      EXPECT_LT(depth_of(d), before);
      before = depth_of(d);
    }
  }
}

TEST(CameraView, JitterIsAPartOfAPixel) {
  for (const Camera& camera : cameras({3, -2, 1})) {
    const shared::View still = gpu_scene::camera_view(camera, {0, 0});
    for (const glm::dvec2& jitter : {glm::dvec2(0.25, -0.5), glm::dvec2(-1.5, 1.5)}) {
      const shared::View moved = gpu_scene::camera_view(camera, jitter);
      for (double depth : {0.5, 50.0}) {
        const glm::dvec3 a = relative_at(moved, 4.5, 1.5, depth),
                         b = relative_at(still, 4.5 + jitter.x, 1.5 + jitter.y, depth);
        EXPECT_LT(glm::length(a - b), 2e-7 * (glm::length(b) + 3)) << depth;
      }
    }
  }
}

TEST(CameraView, FarFromTheOriginIsAsExactAsNearIt) {
  // 2^20 m with 1/8 m steps is what single-precision matrices can hold.
  const glm::dvec3 far(1048576.125, -1048576.375, 1048576.5);
  const std::vector<Camera> here = cameras({0, 0, 0}), there = cameras(far);
  for (size_t c = 0; c < here.size(); ++c) {
    const shared::View a = gpu_scene::camera_view(here[c], {0.1, 0.2}),
                       b = gpu_scene::camera_view(there[c], {0.1, 0.2});
    EXPECT_EQ(glm::dvec3(b.world_origin), far);
    EXPECT_EQ(glm::dvec3(a.world_origin), glm::dvec3(0));
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 4; ++row)
        EXPECT_NEAR(a.clip_from_relative[column][row], b.clip_from_relative[column][row],
                    1e-6 * std::abs(a.clip_from_relative[column][row]) + 1e-9);
    EXPECT_LT(glm::length(a.ray_direction - b.ray_direction), 1e-6f);
  }
}

TEST(CameraView, KnowsAPixelsWidth) {
  const shared::View p = gpu_scene::camera_view(perspective({0, 0, 0}, {1, 0, 0}, 0.8, 64, 32), {});
  EXPECT_NEAR(p.filtering.y, 2 * std::tan(0.4) / 32, 1e-7);
  EXPECT_EQ(p.filtering.z, 1.0f);
  const shared::View o = gpu_scene::camera_view(orthographic({0, 0, 0}, {1, 0, 0}, 3, 64, 32), {});
  EXPECT_NEAR(o.filtering.y, 6.0 / 32, 1e-7);
  EXPECT_EQ(o.filtering.z, 0.0f);
}

TEST(CameraView, InfiniteFarPlanesStayFinite) {
  Camera camera = perspective({0, 0, 0}, {0, 1, 0}, 0.8, 8, 8, 0.1, 100);
  camera.projection[2][2] = -1.0;  // the limit of a far plane at infinity
  camera.projection[3][2] = -0.2;
  const shared::View view = gpu_scene::camera_view(camera, {});
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) EXPECT_TRUE(std::isfinite(view.clip_from_relative[c][r]));
  const glm::vec4 clip = view.clip_from_relative * glm::vec4(0, 0.1f, 0, 1);
  EXPECT_NEAR(clip.z / clip.w, 1, 1e-5);
}

TEST(CameraCheck, AcceptsWhatCanBeRendered) {
  for (const Camera& camera : cameras({0, 0, 0})) EXPECT_NO_THROW(camera.check(4096));
}

TEST(CameraCheck, RefusesSizesThatCannotBeRendered) {
  Camera camera = perspective({0, 0, 0}, {1, 0, 0}, 0.8, 64, 32);
  for (const auto& [w, h] : {std::pair(0, 32), {64, 0}, {-1, 32}, {0, 0}}) {
    camera.width = w;
    camera.height = h;
    expect_error([&] { camera.check(4096); }, fmt::format("{}x{}", w, h));
  }
  camera.width = 4097;
  camera.height = 2;
  expect_error([&] { camera.check(4096); }, "4096");
}

TEST(CameraCheck, RefusesMatricesThatAreNotFinite) {
  for (double broken :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    for (int i = 0; i < 16; ++i) {
      Camera place = perspective({0, 0, 0}, {1, 0, 0}, 0.8, 64, 32), lens = place;
      place.world_to_camera[i / 4][i % 4] = broken;
      lens.projection[i / 4][i % 4] = broken;
      expect_error([&] { place.check(4096); }, "not finite");
      expect_error([&] { lens.check(4096); }, "not finite");
    }
}

TEST(CameraCheck, RefusesDegenerateCameras) {
  const Camera good = perspective({0, 0, 0}, {1, 0, 0}, 0.8, 64, 32);
  Camera flat = good, narrow = good, low = good;
  flat.world_to_camera[1] = glm::dvec4(0.0);
  narrow.projection[0][0] = 0;
  low.projection[1][1] = 0;
  expect_error([&] { flat.check(4096); }, "degenerate");
  expect_error([&] { narrow.check(4096); }, "degenerate");
  expect_error([&] { low.check(4096); }, "degenerate");
}

TEST(CameraCheck, ACamerasUniformScaleIsNoDegeneracy) {
  // The view uses the axes' directions alone, so a camera object of any scale sees the same.
  for (double scale : {1e-6, 1e-3, 1e3, 1e6}) {
    Camera camera = perspective({0, 0, 0}, {1, 0, 0}, 0.8, 64, 32);
    for (int c = 0; c < 3; ++c) camera.world_to_camera[c] *= scale;
    EXPECT_NO_THROW(camera.check(4096)) << "scale " << scale;
  }
}

TEST(LightViews, SpanTheirHalfExtents) {
  const gpu_scene::LightView box{{1, 2, 3}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}, 2, 3, -5, 11, false};
  const shared::View view = gpu_scene::light_view(box, {64, 64});
  const auto clip = [&](const glm::vec3& p) {
    return glm::vec3(view.clip_from_relative * glm::vec4(p, 1));
  };
  EXPECT_EQ(clip({2, 3, 5}), glm::vec3(1, 1, 1));
  EXPECT_LT(glm::length(clip({-2, -3, -11}) - glm::vec3(-1, -1, 0)), 1e-6f);
  EXPECT_EQ(view.size.x, 64);
  EXPECT_NEAR(view.ray_origin_dx.x, 4.0 / 64, 1e-7);
}

}  // namespace
}  // namespace panoptes::test
