// What multiview ambient occlusion looks through: the camera, shadow maps of lamps, phantom views.
// Each is described by faces of a depth array, so that the shaders need not tell them apart.
#pragma once

#include "gpu_scene/lights_shared.h"
#include "gpu_scene/view.h"
#include "rasterize/shadow_maps.h"

#include <glm/glm.hpp>

#include <optional>
#include <vector>

namespace panoptes::ambient_occlusion {

enum class ViewKind { kCamera, kLamp, kPhantom };

struct View {
  ViewKind kind;
  int index;  // the lamp's in its LightSet, the phantom view's number, 0 for the camera
  std::vector<shared::ShadowFace> faces;  // layer -1: nothing to see there
  bool cube;  // six faces in the order +x -x +y -y +z -z; else those of a sun, finest first
};

// The frustum of a camera, with its lens shift and the sample's place in a pixel.
using gpu_scene::as_light_view;

// The camera's own depth: one face in layer 0, as large as the picture.
View camera_view(const gpu_scene::Camera& camera, const glm::dvec2& jitter);

// The shadow map of the lamp number `light`; none where it casts no shadow, nothing of the scene is
// in its map, or it is a point of a glowing surface: there are very many, and each sample has
// others.
std::optional<View> lamp_view(const rasterize::LightSet& set, uint32_t light);

}  // namespace panoptes::ambient_occlusion
