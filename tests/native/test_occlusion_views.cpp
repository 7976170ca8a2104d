// Where ambient occlusion looks from, and that shaders are told what was drawn. No GL.
#include "ambient_occlusion/views.h"
#include "rasterize/shadow_face.h"
#include "support.h"

#include <cmath>
#include <random>

namespace panoptes::test {
namespace {

using ambient_occlusion::View;
using ambient_occlusion::ViewKind;
using gpu_scene::Camera;
using gpu_scene::LightView;

// Place in the map (-1..1) and stored depth of a point relative to the camera, as lights_shared.h
// describes a face.
glm::dvec3 ndc_of(const shared::ShadowFace& face, const glm::dvec3& relative) {
  const glm::dvec3 p = relative - glm::dvec3(face.origin);
  const bool perspective = face.axis.w > 0.5f;
  const double depth = glm::dot(p, glm::dvec3(face.axis)), spread = perspective ? depth : 1.0;
  return {glm::dot(p, glm::dvec3(face.x)) / spread - face.x.w,
          glm::dot(p, glm::dvec3(face.y)) / spread - face.y.w,
          perspective ? face.depth.x / depth + face.depth.y : face.depth.x * depth + face.depth.y};
}

TEST(OcclusionViews, TheCamerasFaceIsTheTransformItIsDrawnWith) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const glm::dvec3& eye : {glm::dvec3(0.5, -2, 1), glm::dvec3(1048576.125, 3, -1048576.5)}) {
    const glm::dvec3 target = eye + glm::dvec3(-3, 4, -1.5);
    for (const Camera& camera : {perspective(eye, target, 0.9, 40, 30, 0.1, 100),
                                 perspective(eye, target, 0.9, 40, 30, 0.1, 100, {0.3, -0.7}),
                                 perspective(eye, target, 3.1, 64, 9, 0.01, 1000, {-0.2, 0.1}),
                                 orthographic(eye, target, 2.5, 30, 40, 5, 100, {0.4, 0.25})})
      for (const glm::dvec2& jitter : {glm::dvec2(0), glm::dvec2(0.75, -1.5)}) {
        const shared::View drawn = gpu_scene::camera_view(camera, jitter);
        const View view = ambient_occlusion::camera_view(camera, jitter);
        EXPECT_EQ(view.kind, ViewKind::kCamera);
        EXPECT_FALSE(view.cube);
        ASSERT_EQ(view.faces.size(), 1u);
        const shared::ShadowFace& face = view.faces[0];
        EXPECT_EQ(face.half_extent.z, 0);
        EXPECT_EQ(face.half_extent.w, camera.width);
        EXPECT_EQ(face.depth.w, camera.height);
        EXPECT_NEAR(face.origin.w, drawn.filtering.y, 1e-5 * drawn.filtering.y);  // square pixels
        const LightView from = ambient_occlusion::as_light_view(camera, jitter);
        for (int i = 0; i < 200; ++i) {
          // Anywhere in the frustum, from the near to the far plane.
          const double depth = from.near_depth * std::pow(from.far_depth / from.near_depth,
                                                          0.5 + 0.5 * uniform(random));
          const double spread = from.perspective ? depth : 1.0;
          const glm::dvec3 p = depth * from.axis +
                               spread * ((from.shift.x + uniform(random) * from.half_x) * from.x +
                                         (from.shift.y + uniform(random) * from.half_y) * from.y);
          const glm::dvec4 clip = glm::dmat4(drawn.clip_from_relative) * glm::dvec4(p, 1);
          const glm::dvec3 due = glm::dvec3(clip) / clip.w, read = ndc_of(face, p);
          // The rounding of unit vectors counts by how far to the side the point lies.
          const double tolerance = 5e-7 * glm::length(p) / std::min(spread * from.half_y, depth);
          for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(read[c], due[c], tolerance) << c << " at " << depth;
        }
      }
  }
}

TEST(OcclusionViews, FacesOfMapsThatAreNotSquareKnowBothSides) {
  const LightView view{{1, 2, 3}, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}, 2, 1, 0.5, 20, true, {0.1, 0}};
  const shared::ShadowFace wide = rasterize::shadow_face(view, {1, 2, 0}, {64, 16});
  EXPECT_EQ(glm::vec3(wide.origin), glm::vec3(0, 0, 3));
  EXPECT_EQ(wide.half_extent.w, 64);
  EXPECT_EQ(wide.depth.w, 16);
  EXPECT_FLOAT_EQ(wide.origin.w, 2.0f / 16);  // the coarser of the two
  EXPECT_FLOAT_EQ(rasterize::shadow_face(view, {1, 2, 0}, {8, 16}).origin.w, 4.0f / 8);
}

TEST(OcclusionViews, LampsAreLookedThroughTheirOwnMaps) {
  scene::Bounds room;
  room.add({-3, -1, 0});
  room.add({5, 2, 4});
  scene::Light silent = point({0, 0, 3}, 1);
  silent.cast_shadow = false;
  const rasterize::MeshLight glowing{.position = {1, 0, 2},
                                     .normal = {0, 0, -1},
                                     .front = glm::vec3(1),
                                     .back = glm::vec3(0)};
  scene::Bounds near_part = room;
  near_part.high.x = 0;
  rasterize::LightSet set =
      rasterize::place_lights({sun({0.2f, 0.5f, -1}, 1), silent, point({0, 0, 3}, 1),
                               spot({1, 0, 3}, {0, 0, -1}, 1, 1, 0)},
                              {}, {glowing},
                              {.bounds = room,
                               .sun_cascades = {near_part, room},
                               .camera_origin = {0.5, -7, 1.25},
                               .resolution = 64,
                               .layers = 100});
  ASSERT_EQ(set.lights.size(), 5u);
  const size_t faces[4] = {2, 0, 6, 1};
  for (uint32_t i = 0; i < 4; ++i) {
    const std::optional<View> view = ambient_occlusion::lamp_view(set, i);
    ASSERT_EQ(view.has_value(), faces[i] > 0) << i;
    if (!view) continue;
    EXPECT_EQ(view->kind, ViewKind::kLamp);
    EXPECT_EQ(view->index, int(i));
    EXPECT_EQ(view->cube, faces[i] == 6);
    ASSERT_EQ(view->faces.size(), faces[i]) << i;
    for (size_t f = 0; f < faces[i]; ++f) {
      const shared::ShadowFace& due = set.faces[set.lights[i].light.shadow + f];
      EXPECT_EQ(view->faces[f].origin, due.origin);
      EXPECT_EQ(view->faces[f].half_extent, due.half_extent);
      EXPECT_EQ(due.depth.w, due.half_extent.z >= 0 ? 64 : 0);
    }
  }
  EXPECT_FALSE(ambient_occlusion::lamp_view(set, 4)) << "points of glowing surfaces change";

  for (shared::ShadowFace& face : set.faces) face.half_extent.z = -1;
  for (uint32_t i = 0; i < 4; ++i) EXPECT_FALSE(ambient_occlusion::lamp_view(set, i)) << i;
}

}  // namespace
}  // namespace panoptes::test
