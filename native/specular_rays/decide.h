#pragma once

#include "plan/effect.h"
#include "scene/scene.h"
#include "specular_rays/settings.h"

namespace panoptes::specular_rays {

// Whether rays show what mirrors and glass show.
plan::Effects decide(const scene::Facts& facts, const Settings& settings);

}  // namespace panoptes::specular_rays
