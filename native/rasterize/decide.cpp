#include "rasterize/decide.h"

#include <fmt/format.h>

namespace panoptes::rasterize {

namespace {

plan::Effect when(const char* name, bool runs, const char* yes, const char* no) {
  return {name, runs, runs ? yes : no};
}

}  // namespace

plan::Effects decide_surfaces(const scene::Facts& facts) {
  plan::Effects effects;
  effects.push_back({"surfaces", facts.triangles > 0,
                     facts.triangles > 0 ? fmt::format("{} triangles in {} objects",
                                                       facts.triangles, facts.instances)
                                         : "the scene has no geometry to show"});
  effects.push_back(when("alpha", facts.alpha, "some material has an alpha below 1",
                         "every material is opaque"));
  effects.push_back(when("normal_maps", facts.normal_map, "some material has a normal map",
                         "no material has a normal map"));
  effects.push_back(when("emission", facts.emission, "some material emits light",
                         "no material emits light"));
  effects.push_back(when("glossy", facts.glossy, "some material reflects",
                         "no material reflects"));
  effects.push_back(when("transmission", facts.transmission, "some material refracts light",
                         "no material refracts light"));
  effects.push_back(when("layers", facts.layers, "some material has a coat or a sheen",
                         "no material has a coat or a sheen"));
  return effects;
}

plan::Effects decide_glow(const scene::Facts& facts) {
  const bool surfaces = facts.triangles > 0;
  plan::Effects effects;
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

plan::Effects decide(const scene::Facts& facts, const DecideSettings& settings) {
  plan::Effects effects = decide_surfaces(facts);
  const char* kinds[4] = {"point", "sun", "spot", "area"};
  for (int i = 0; i < 4; ++i) {
    const int lamps = facts.lamps[i], casting = facts.shadow_lamps[i];
    effects.push_back({fmt::format("{}_shadows", kinds[i]), casting > 0,
                       lamps == 0     ? fmt::format("the scene has no {} lamp", kinds[i])
                       : casting == 0 ? fmt::format("no {} lamp casts shadows", kinds[i])
                                      : fmt::format("{} {} lamp{} cast{} shadows", casting,
                                                    kinds[i], casting > 1 ? "s" : "",
                                                    casting > 1 ? "" : "s")});
  }
  effects.push_back(when("emissive_shadows", facts.emission, "light of surfaces casts shadows",
                         "no material emits light"));
  effects.push_back(when("sun_cascades", facts.shadow_lamps[1] > 0,
                         "suns' maps follow what the camera sees where the scene is large",
                         "no sun lamp casts shadows"));
  // Each of the two ways to penumbrae leaves the other nothing to do.
  const bool filter = settings.filter_penumbrae || settings.samples == 1;
  const bool soft = facts.extended_lamps && settings.soft_shadows && !filter;
  effects.push_back({"soft_shadows", soft,
                     soft                     ? "some lamp has an extent; each sample uses a point of it"
                     : !facts.extended_lamps  ? "no lamp has an extent"
                     : !settings.soft_shadows ? "switched off in the settings"
                                              : "penumbrae are filtered instead",
                     !settings.soft_shadows || filter});
  const bool extended = facts.extended_lamps || facts.emission;
  const bool filtered = extended && settings.soft_shadows && filter;
  effects.push_back({"filtered_penumbrae", filtered,
                     filtered                 ? "shadows widen with the distance of what casts them"
                     : !extended              ? "no lamp has an extent"
                     : !settings.soft_shadows ? "switched off in the settings"
                                              : "each sample uses a point of the lamps instead",
                     !settings.soft_shadows || !filter});
  return effects;
}

}  // namespace panoptes::rasterize
