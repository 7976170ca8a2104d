// How shaders find places and depths in a map that was drawn from a view.
#pragma once

#include "gpu_scene/lights_shared.h"
#include "gpu_scene/view.h"

#include <glm/glm.hpp>

namespace panoptes::rasterize {

// Describes what is drawn from `view` into `texels` of a layer, for shaders that look from
// `camera_origin` (world space, metres). Which layer that is the caller sets, in half_extent.z.
shared::ShadowFace shadow_face(const gpu_scene::LightView& view, const glm::dvec3& camera_origin,
                               glm::ivec2 texels);

}  // namespace panoptes::rasterize
