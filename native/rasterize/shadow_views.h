// Where shadow maps look from. Pure geometry in double precision, no GL.
//
// Views cover what can cast or catch a shadow and nothing else: a lamp outside the scene sees all of
// it through one fitted frustum, a lamp inside through those faces of a cube that hold geometry and
// receive light.
#pragma once

#include "gpu_scene/view.h"
#include "scene/scene.h"

#include <glm/glm.hpp>

#include <optional>
#include <vector>

namespace panoptes::rasterize {

// The views of one lamp: one, or six of a world-aligned cube in the order +x -x +y -y +z -z, where
// those that have nothing to show are empty.
using ShadowViews = std::vector<std::optional<gpu_scene::LightView>>;

// An orthographic view along the unit `direction` around all of `region`, whose depth reaches from
// the first of `casters` to the last of the region. `texel_shift` moves its grid by parts of a texel.
gpu_scene::LightView sun_view(const glm::dvec3& direction, const scene::Bounds& region,
                              const scene::Bounds& casters, const glm::dvec2& texel_shift,
                              int resolution);

// One frustum along the unit `axis` with the half angle `half_angle` (rad, below pi / 2).
gpu_scene::LightView cone_view(const glm::dvec3& position, const glm::dvec3& axis,
                               double half_angle, const scene::Bounds& bounds, int resolution);

// All of `bounds` as seen from `position`. Where `axis` is given, light only leaves into its half
// space.
ShadowViews surrounding_views(const glm::dvec3& position, const std::optional<glm::dvec3>& axis,
                              const scene::Bounds& bounds, int resolution);

}  // namespace panoptes::rasterize
