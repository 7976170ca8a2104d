#include "realtime/decide.h"

#include "rasterize/decide.h"

#include <fmt/format.h>

namespace panoptes::realtime {

plan::Effects decide(const scene::Facts& facts) {
  const int lamps = facts.lamp_count();
  const bool surfaces = facts.triangles > 0;
  plan::Effects effects;
  effects.push_back({"direct_light", lamps > 0 && surfaces,
                     lamps == 0  ? "the scene has no lamp that shines"
                     : !surfaces ? "there is no surface to light"
                                 : fmt::format("{} lamp{}", lamps, lamps > 1 ? "s" : "")});
  for (plan::Effect& effect : rasterize::decide_glow(facts)) effects.push_back(std::move(effect));
  return effects;
}

}  // namespace panoptes::realtime
