#pragma once

#include "ambient_occlusion/settings.h"
#include "plan/effect.h"
#include "scene/scene.h"

namespace panoptes::ambient_occlusion {

struct DecideSettings {
  Settings occlusion;
  bool cached_light = false;  // the radiance cache runs, whose light it darkens too
  bool pass = false;          // the AO pass is asked for
  int samples = 1;            // of the picture
};

// Which occlusion is looked for, by which views, and what is made of it. Views are the plan's up to
// here: which of the lamps', and whether phantom ones are needed, the first sample tells.
plan::Effects decide(const scene::Facts& facts, const DecideSettings& settings);

}  // namespace panoptes::ambient_occlusion
