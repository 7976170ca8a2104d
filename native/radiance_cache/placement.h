// Where the volumes of the radiance cache lie (thesis, section 5.3: "may occupy the entire scene, a
// part of it or be centered at the user"). Pure: no GL.
//
// One volume over the whole scene is the cheapest: it outlives every move of the camera. Where its
// cells are large beside what the camera shows, cascades lie about the camera, or about what it looks at
// where that is far away, each of cells twice as large as those of the one in it. Corners lie on a lattice of the whole world, so that cells
// stay where they are while a volume moves: light does not swim.
#pragma once

#include "gpu_scene/view.h"
#include "radiance_cache/geometry_volume.h"
#include "radiance_cache/settings.h"
#include "scene/scene.h"

#include <vector>

namespace panoptes::radiance_cache {

// Whether the volumes depend on how far away the camera sees things.
bool choose_by_distance(const Settings& settings);

// The grids for a scene within `bounds`, the finest first; at least one, of finite places whatever the
// input, and of no more than kMostVoxels. `camera` looks at things about `distance` metres away along
// its axis; 0: nobody knows, then at the scene as a whole. Around all of the scene that a grid covers
// lies one cell, since look-ups fade over the last one.
std::vector<Grid> choose_grids(const scene::Bounds& bounds, const gpu_scene::Camera& camera,
                               const Settings& settings, double distance = 0);

}  // namespace panoptes::radiance_cache
