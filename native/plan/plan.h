// Composes what the techniques decided into the plan of a frame: which effects run, and why.
#pragma once

#include "ambient_occlusion/settings.h"
#include "denoise/settings.h"
#include "film/passes.h"
#include "path_tracer/decide.h"
#include "plan/effect.h"
#include "radiance_cache/settings.h"
#include "ray_picture/kind.h"
#include "scene/scene.h"
#include "specular_rays/settings.h"

namespace panoptes::plan {

struct PlanSettings {
  int samples = 1;                 // of the picture, up to the last one asked for
  bool soft_shadows = true;
  bool filter_penumbrae = false;   // by blocker distance, instead of a point of each lamp a sample
  bool force_all_effects = false;  // runs what the scene cannot show too; the picture stays the same
  film::PassSet passes;
  film::Pass shown_pass = film::Pass::kCombined;  // what the picture is of: the rest is left out
  ray_picture::Kind debug_picture = ray_picture::Kind::kNone;  // shown in place of the scene
  bool path_tracing = false;       // Primitive tracing, not Real-time
  path_tracer::DecideSettings paths;
  denoise::Settings denoise;
  ambient_occlusion::Settings occlusion;  // these three: of Real-time
  radiance_cache::Settings cache;
  specular_rays::Settings specular_rays;
};

Effects make_plan(const scene::Facts& facts, const PlanSettings& settings);

}  // namespace panoptes::plan
