#pragma once

#include "plan/effect.h"
#include "ray_picture/kind.h"
#include "scene/scene.h"

namespace panoptes::ray_picture {

// What a frame of that kind runs, in place of what shows the scene.
plan::Effects decide(const scene::Facts& facts, Kind kind);

}  // namespace panoptes::ray_picture
