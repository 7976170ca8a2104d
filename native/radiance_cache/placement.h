// Where the volumes of the radiance cache lie.
#pragma once

#include "gpu_scene/view.h"
#include "radiance_cache/geometry_volume.h"
#include "radiance_cache/settings.h"
#include "scene/scene.h"

#include <vector>

namespace panoptes::radiance_cache {

// The grids for a scene within `bounds` that `camera` looks at, the finest first. No GL.
std::vector<Grid> choose_grids(const scene::Bounds& bounds, const gpu_scene::Camera& camera,
                               const Settings& settings);

}  // namespace panoptes::radiance_cache
