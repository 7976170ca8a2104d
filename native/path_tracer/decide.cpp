#include "path_tracer/decide.h"

#include "rasterize/decide.h"

#include <fmt/format.h>

namespace panoptes::path_tracer {

namespace {

const char* plural(int count) { return count == 1 ? "" : "s"; }

}  // namespace

plan::Effects decide(const scene::Facts& facts, const DecideSettings& settings) {
  const Settings& paths = settings.paths;
  const bool surfaces = facts.triangles > 0;
  const int lamps = facts.lamp_count(), casting = facts.shadow_lamp_count();
  plan::Effects effects;
  effects.push_back({"camera_rays", true, "each pixel's light is followed back from the camera"});
  effects.push_back({"depth_of_field", settings.lens,
                     settings.lens ? "the camera's lens has an aperture"
                                   : "the camera shows everything sharp"});
  effects.push_back({"direct_light", lamps > 0 && surfaces,
                     lamps == 0  ? "the scene has no lamp that shines"
                     : !surfaces ? "there is no surface to light"
                                 : fmt::format("{} lamp{}, one of which is chosen wherever a path turns",
                                               lamps, plural(lamps))});
  for (plan::Effect& effect : rasterize::decide_glow(facts)) effects.push_back(std::move(effect));
  const bool shadows = surfaces && (casting > 0 || facts.emission || facts.world);
  effects.push_back({"shadow_rays", shadows,
                     shadows ? "light is followed to where it comes from"
                             : "nothing shines that casts shadows"});
  const bool shines = lamps > 0 || facts.emission || facts.world;
  const bool indirect = surfaces && shines && paths.bounces.total > 0;
  effects.push_back({"indirect_light", indirect,
                     indirect                   ? fmt::format("up to {} bounce{}", paths.bounces.total,
                                                              plural(paths.bounces.total))
                     : paths.bounces.total == 0 ? "the number of bounces is 0"
                                                : "there is no light that could be reflected",
                     paths.bounces.total == 0});
  const bool rough = paths.filter_glossy > 0 && facts.glossy && indirect;
  effects.push_back({"filter_glossy", rough,
                     rough                      ? "sparkle of caustics becomes a glow"
                     : paths.filter_glossy == 0 ? "switched off in the settings"
                                                : "no reflection sees other reflections",
                     paths.filter_glossy == 0});
  const bool clamp = paths.clamp_direct > 0 || paths.clamp_indirect > 0;
  effects.push_back({"clamping", clamp,
                     clamp ? "bright samples are limited" : "switched off in the settings", !clamp});
  return effects;
}

}  // namespace panoptes::path_tracer
