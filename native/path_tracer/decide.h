#pragma once

#include "path_tracer/settings.h"
#include "plan/effect.h"
#include "scene/scene.h"

namespace panoptes::path_tracer {

struct DecideSettings {
  Settings paths;
  bool lens = false;  // the camera's lens blurs what is out of focus
};

// Effects of light that is followed path by path.
plan::Effects decide(const scene::Facts& facts, const DecideSettings& settings);

}  // namespace panoptes::path_tracer
