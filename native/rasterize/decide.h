#pragma once

#include "plan/effect.h"
#include "scene/scene.h"

namespace panoptes::rasterize {

struct DecideSettings {
  int samples = 1;
  bool soft_shadows = true;
  bool filter_penumbrae = false;  // by blocker distance, instead of a point of the lamp a sample
};

// What surfaces have that must be stored of them, however they are found.
plan::Effects decide_surfaces(const scene::Facts& facts);
// The light of surfaces and of the world, however it is followed.
plan::Effects decide_glow(const scene::Facts& facts);
// What the camera's G-buffer and the shadow maps do for a scene with these facts.
plan::Effects decide(const scene::Facts& facts, const DecideSettings& settings);

}  // namespace panoptes::rasterize
