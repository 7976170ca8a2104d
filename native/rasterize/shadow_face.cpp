#include "rasterize/shadow_face.h"

namespace panoptes::rasterize {

shared::ShadowFace shadow_face(const gpu_scene::LightView& view, const glm::dvec3& camera_origin,
                               glm::ivec2 texels) {
  const auto vec = [](const glm::dvec3& v, double w) { return glm::vec4(glm::vec3(v), float(w)); };
  // Of texels that are not square, the longer side.
  const glm::dvec2 texel =
      2.0 * glm::abs(glm::dvec2(view.half_x, view.half_y)) / glm::dvec2(texels);
  const double range = view.far_depth - view.near_depth;
  shared::ShadowFace f{};
  f.origin = vec(view.origin - camera_origin, glm::max(texel.x, texel.y));
  f.x = vec(view.x / view.half_x, view.shift.x / view.half_x);
  f.y = vec(view.y / view.half_y, view.shift.y / view.half_y);
  f.axis = vec(view.axis, view.perspective ? 1.0 : 0.0);
  f.half_extent = {float(view.half_x), float(view.half_y), 0, float(texels.x)};
  f.depth = view.perspective ? glm::vec4(float(view.near_depth * view.far_depth / range),
                                         float(-view.near_depth / range), float(view.near_depth),
                                         float(texels.y))
                             : glm::vec4(float(-1.0 / range), float(view.far_depth / range),
                                         float(view.near_depth), float(texels.y));
  return f;
}

}  // namespace panoptes::rasterize
