#pragma once

#include "denoise/settings.h"
#include "film/passes.h"
#include "plan/effect.h"

namespace panoptes::denoise {

struct DecideSettings {
  Settings denoise;
  bool path_tracing = false;
  int samples = 1;  // of the picture
  film::Pass shown_pass = film::Pass::kCombined;
};

// One effect, "denoiser".
plan::Effects decide(const DecideSettings& settings);

}  // namespace panoptes::denoise
