#include "radiance_cache/decide.h"

#include <fmt/format.h>

namespace panoptes::radiance_cache {

namespace {

plan::Effect effect(const char* name, bool runs, std::string reason, bool by_choice = false) {
  return {name, runs, std::move(reason), by_choice};
}

}  // namespace

plan::Effects decide(const scene::Facts& facts, const Settings& s) {
  const bool surfaces = facts.triangles > 0;
  const bool lamps = facts.lamp_count() > 0 || facts.emission;
  const bool bounced = s.bounces > 0, light = facts.world || (lamps && bounced);
  const bool picture = s.picture != Picture::kNone;
  const bool runs = surfaces && s.enabled && (light || picture);
  plan::Effects effects;
  effects.push_back(effect("radiance_cache", runs,
                           !surfaces    ? "there is no surface to light"
                           : !s.enabled ? "switched off in the settings"
                           : picture    ? "a picture of it was asked for"
                           : light      ? "light reaches surfaces by way of others, and the world's past them"
                           : lamps      ? "no bounces are allowed, and the world is black"
                                        : "nothing shines",
                           surfaces && (!s.enabled || (lamps && !bounced && !facts.world))));
  const char* idle = "there is no radiance cache";
  const bool first = runs && lamps && bounced, maps = s.first_bounce == FirstBounce::kRsm;
  const char* none = !runs ? idle : !lamps ? "no lamp shines" : "no bounces are allowed";
  effects.push_back(effect("cache_first_bounce", first && !maps,
                           !first ? none
                           : maps ? "reflective shadow maps take its place"
                                  : "lamps light surfaces that others see",
                           !first || maps));
  effects.push_back(effect("cache_rsm", first && maps,
                           !first ? none
                           : maps ? "surfaces that lamps see send light to the cells"
                                  : "points of surfaces that rays meet are lit instead",
                           !first || !maps));
  const bool world = runs && facts.world;
  effects.push_back(effect("cache_world", world,
                           world   ? "the world shines in from where rays leave the scene"
                           : !runs ? idle
                                   : "the world is black"));
  // The world's light has its first bounce here.
  const int further = s.bounces - (facts.world ? 0 : 1);
  const bool bounces = runs && light && further > 0;
  effects.push_back(effect("cache_bounces", bounces,
                           bounces   ? fmt::format("{} bounce{} between cells", further, further > 1 ? "s" : "")
                           : !runs   ? idle
                           : bounced ? "one bounce is all that is asked for"
                                     : "no bounces are allowed",
                           !bounces));
  return effects;
}

}  // namespace panoptes::radiance_cache
