#pragma once

#include "plan/effect.h"
#include "radiance_cache/settings.h"
#include "scene/scene.h"

namespace panoptes::radiance_cache {

// Whether light is gathered in a volume, from where, and how often it bounces.
plan::Effects decide(const scene::Facts& facts, const Settings& settings);

}  // namespace panoptes::radiance_cache
