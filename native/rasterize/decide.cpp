#include "rasterize/decide.h"

#include <fmt/format.h>

namespace panoptes::rasterize {

namespace {

plan::Effect when(const char* name, bool runs, const char* yes, const char* no) {
  return {name, runs, runs ? yes : no};
}

}  // namespace

plan::Effects decide(const scene::Facts& facts, const DecideSettings& settings) {
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
  const bool soft = facts.extended_lamps && settings.soft_shadows && settings.samples > 1;
  effects.push_back({"soft_shadows", soft,
                     soft                       ? "some lamp has an extent; each sample uses a point of it"
                     : !facts.extended_lamps    ? "no lamp has an extent"
                     : !settings.soft_shadows   ? "switched off in the settings"
                                                : "a single sample shows the lamps' centres",
                     !settings.soft_shadows || settings.samples == 1});
  return effects;
}

}  // namespace panoptes::rasterize
