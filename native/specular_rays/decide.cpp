#include "specular_rays/decide.h"

namespace panoptes::specular_rays {

plan::Effects decide(const scene::Facts& facts, const Settings& settings) {
  const bool off = settings.mode == Mode::kOff, all = settings.mode == Mode::kOn;
  const bool smooth = facts.glossy && (all || facts.least_roughness <= settings.roughness);
  const bool runs = !off && facts.triangles > 0 && (smooth || facts.transmission);
  const char* reason =
      runs                                   ? (all ? "rays find what reflecting surfaces and glass show"
                                                    : "rays find what mirrors and glass show")
      : facts.triangles == 0                 ? "there is no surface to see"
      : off                                  ? "switched off in the settings"
      : facts.glossy                         ? "all that reflects is too rough for its reflections to be told"
                                             : "no material reflects or refracts light";
  return {{"specular_rays", runs, reason, off}};
}

}  // namespace panoptes::specular_rays
