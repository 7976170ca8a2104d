#include "ambient_occlusion/views.h"

#include "rasterize/shadow_face.h"

#include <algorithm>

namespace panoptes::ambient_occlusion {

View camera_view(const gpu_scene::Camera& camera, const glm::dvec2& jitter) {
  const gpu_scene::LightView view = as_light_view(camera, jitter);
  return {ViewKind::kCamera,
          0,
          {rasterize::shadow_face(view, view.origin, {camera.width, camera.height})},
          false};
}

std::optional<View> lamp_view(const rasterize::LightSet& set, uint32_t light) {
  const rasterize::PlacedLight& placed = set.lights[light];
  if (placed.light.shadow == shared::NO_SHADOW || placed.kind == rasterize::ShadowKind::kMesh)
    return std::nullopt;
  const auto first = set.faces.begin() + placed.light.shadow;
  View view{ViewKind::kLamp,
            int(light),
            {first, first + placed.light.faces},
            placed.light.faces == shared::CUBE_FACES};
  if (std::none_of(view.faces.begin(), view.faces.end(),
                   [](const auto& face) { return face.half_extent.z >= 0; }))
    return std::nullopt;
  return view;
}

}  // namespace panoptes::ambient_occlusion
