#include "ambient_occlusion/decide.h"

namespace panoptes::ambient_occlusion {

namespace {

// From so many samples a pixel on, their mean is smoother than what the filter would blur.
constexpr int kManySamples = 16;

plan::Effect effect(const char* name, bool runs, const char* reason, bool by_choice = false) {
  return {name, runs, reason, by_choice};
}

}  // namespace

plan::Effects decide(const scene::Facts& facts, const DecideSettings& settings) {
  const Settings& s = settings.occlusion;
  const bool surfaces = facts.triangles > 0, picture = s.picture != Picture::kNone;
  const bool ambient = facts.world || settings.cached_light;
  const bool light = ambient && s.strength > 0;
  const bool runs = surfaces && (light || settings.pass || picture);
  plan::Effects effects;
  effects.push_back(effect("ambient_occlusion", runs,
                           !surfaces       ? "there is no surface to darken"
                           : picture       ? "a picture of it was asked for"
                           : settings.pass ? "the AO pass is asked for"
                           : light         ? "surfaces stand in the way of light from all around"
                           : ambient       ? "its strength is 0"
                                           : "no light comes from all around, and no AO pass is asked for",
                           surfaces && ambient && !runs));
  const char* near = "rays of the radiance cache meet what stands farther away, and the camera sees what is near";
  const char* idle = "no ambient occlusion is looked for";
  const bool maps = facts.shadow_lamp_count() > 0;
  const bool contact = settings.cached_light && !settings.pass && !picture;
  const bool lamps = runs && maps && s.secondary_views > 0 && !contact;
  effects.push_back(effect("occlusion_lamp_views", lamps,
                           lamps    ? "shadow maps show what the camera does not see"
                           : !runs  ? idle
                           : !maps  ? "nothing casts shadows that could be looked at"
                           : s.secondary_views == 0 ? "no secondary views are allowed"
                                                    : near,
                           s.secondary_views == 0 || contact));
  const bool chosen = s.phantom_camera_count > 0, off = s.phantoms == Phantoms::kOff && !chosen;
  const bool unneeded = contact && !chosen && s.phantoms == Phantoms::kAuto;
  effects.push_back(effect("occlusion_phantom_views", runs && !off && !unneeded,
                           !runs                            ? idle
                           : chosen                         ? "phantom cameras were chosen"
                           : off                            ? "switched off in the settings"
                           : s.phantoms == Phantoms::kOn    ? "switched on in the settings"
                           : unneeded                       ? near
                                                            : "used where other views cover too little",
                           off || unneeded));
  const bool bent = runs && (light || s.picture == Picture::kBentNormals);
  effects.push_back(effect("bent_normals", bent,
                           bent    ? "light from all around comes from where it is open"
                           : !runs ? idle
                                   : "no light is looked up by them",
                           runs && ambient));
  const bool many = settings.samples >= kManySamples;
  const bool filter = runs && (s.filter == Filter::kOn || (s.filter == Filter::kAuto && !many));
  effects.push_back(effect("occlusion_filter", filter,
                           filter                        ? "few samples leave noise in the occlusion"
                           : !runs                       ? idle
                           : s.filter == Filter::kOff    ? "switched off in the settings"
                                                         : "the samples are many enough",
                           true));
  const bool deep = runs && light && maps && s.deep_shadows > 0;
  effects.push_back(effect("deep_shadows", deep,
                           deep                   ? "switched on in the settings"
                           : s.deep_shadows == 0  ? "switched off in the settings"
                           : !runs || !light      ? "there is no light of the world to darken"
                                                  : "nothing casts shadows that could be looked at",
                           s.deep_shadows == 0));
  return effects;
}

}  // namespace panoptes::ambient_occlusion
