#include "gpu_scene/view.h"

#include "base/error.h"

#include <algorithm>
#include <cmath>

namespace panoptes::gpu_scene {

namespace {

glm::vec4 vec(const glm::dvec3& v) { return glm::vec4(glm::vec3(v), 0.0f); }

// A view from its frame: for depth d along the axis, the image spans
// (center ± half) * (perspective ? d : 1) along x and y.
shared::View make_view(const glm::dvec3& origin, const glm::dvec3& x, const glm::dvec3& y,
                       const glm::dvec3& axis, glm::dvec2 center, glm::dvec2 half, double near_depth,
                       double far_depth, bool perspective, int width, int height) {
  // Rows of the clip transform from relative positions. Depth is reversed: 1 at near, 0 at far.
  glm::dmat4 rows(0.0);
  const double range = far_depth - near_depth;
  if (perspective) {
    rows[0] = {(x - center.x * axis) / half.x, 0.0};
    rows[1] = {(y - center.y * axis) / half.y, 0.0};
    rows[2] = {-axis * (near_depth / range), near_depth * far_depth / range};
    rows[3] = {axis, 0.0};
  } else {
    rows[0] = {x / half.x, -center.x / half.x};
    rows[1] = {y / half.y, -center.y / half.y};
    rows[2] = {-axis / range, far_depth / range};
    rows[3] = {0.0, 0.0, 0.0, 1.0};
  }
  shared::View view{};
  view.clip_from_relative = glm::mat4(glm::transpose(rows));
  view.world_origin = vec(origin);
  view.axis = vec(axis);
  view.size = {width, height, 0, 0};

  const glm::dvec3 dx = x * (2.0 * half.x / width), dy = y * (2.0 * half.y / height);
  const glm::dvec3 corner = (center.x - half.x) * x + (center.y - half.y) * y;
  if (perspective) {
    view.ray_direction = vec(axis + corner);
    view.ray_direction_dx = vec(dx);
    view.ray_direction_dy = vec(dy);
  } else {
    view.ray_origin = vec(corner);
    view.ray_origin_dx = vec(dx);
    view.ray_origin_dy = vec(dy);
    view.ray_direction = vec(axis);
  }
  view.filtering = {0.0f, float(std::sqrt(glm::length(dx) * glm::length(dy))),
                    perspective ? 1.0f : 0.0f, 0.0f};
  return view;
}

}  // namespace

void Camera::check(int max_size) const {
  if (width < 1 || height < 1)
    fail("a picture of {}x{} pixels cannot be rendered: set a resolution of at least 1x1", width,
         height);
  if (width > max_size || height > max_size)
    fail("a picture of {}x{} pixels is larger than this graphics driver allows ({}): render it in "
         "parts by border render",
         width, height, max_size);
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!std::isfinite(projection[c][r]) || !std::isfinite(world_to_camera[c][r]))
        fail("the camera's place or lens is not finite: check its location, rotation, focal length "
             "and constraints");
  // The axes must span space; how long they are does not matter.
  glm::dmat3 axes(world_to_camera);
  for (int c = 0; c < 3; ++c) axes[c] /= std::max(glm::length(axes[c]), 1e-300);
  if (projection[0][0] == 0 || projection[1][1] == 0 ||
      std::abs(glm::determinant(axes)) < 1e-12)
    fail("the camera's lens or scale is degenerate: check its focal length, scale and constraints");
}

glm::dvec2 clip_depths(const Camera& camera) {
  const glm::dmat4& p = camera.projection;  // p[column][row]
  glm::dvec2 depths = camera.perspective()
                          ? glm::dvec2(p[3][2] / (p[2][2] - 1.0), p[3][2] / (p[2][2] + 1.0))
                          : glm::dvec2((p[3][2] + 1.0) / p[2][2], (p[3][2] - 1.0) / p[2][2]);
  if (!std::isfinite(depths.y) || depths.y <= depths.x) depths.y = depths.x * 1e7 + 1.0;
  return depths;
}

LightView as_light_view(const Camera& camera, glm::dvec2 jitter) {
  const glm::dmat4 world = glm::inverse(camera.world_to_camera);
  const glm::dmat4& p = camera.projection;  // p[column][row]
  const bool perspective = camera.perspective();
  const glm::dvec2 half{1.0 / p[0][0], 1.0 / p[1][1]};
  glm::dvec2 center = perspective ? glm::dvec2(p[2][0], p[2][1]) * half
                                  : -glm::dvec2(p[3][0], p[3][1]) * half;
  center += jitter * 2.0 * half / glm::dvec2(camera.width, camera.height);
  const glm::dvec2 depths = clip_depths(camera);
  return {glm::dvec3(world[3]), glm::normalize(glm::dvec3(world[0])),
          glm::normalize(glm::dvec3(world[1])), -glm::normalize(glm::dvec3(world[2])),
          half.x, half.y, depths.x, depths.y, perspective, center};
}

shared::View camera_view(const Camera& camera, glm::dvec2 jitter) {
  return light_view(as_light_view(camera, jitter), {camera.width, camera.height});
}

shared::View light_view(const LightView& l, glm::ivec2 texels) {
  return make_view(l.origin, l.x, l.y, l.axis, l.shift, {l.half_x, l.half_y}, l.near_depth,
                   l.far_depth, l.perspective, texels.x, texels.y);
}

}  // namespace panoptes::gpu_scene
