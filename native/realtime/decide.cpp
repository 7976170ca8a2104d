#include "realtime/decide.h"

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
  effects.push_back({"emissive_light", facts.emission && surfaces,
                     facts.emission ? "surfaces that emit light shine on others"
                                    : "no material emits light"});
  effects.push_back({"world_light", facts.world && surfaces,
                     !facts.world ? "the world is black"
                     : !surfaces  ? "there is no surface to light"
                                  : "the world shines on the surfaces"});
  effects.push_back({"world_background", facts.world,
                     facts.world ? "the world may be seen behind the scene" : "the world is black"});
  return effects;
}

}  // namespace panoptes::realtime
