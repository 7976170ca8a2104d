#pragma once

#include "plan/effect.h"
#include "scene/scene.h"

namespace panoptes::realtime {

// Which light Real-time gathers for a scene with these facts.
plan::Effects decide(const scene::Facts& facts);

}  // namespace panoptes::realtime
