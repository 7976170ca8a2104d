#include "plan/shown_pass.h"

#include <algorithm>
#include <string_view>

namespace panoptes::plan {

namespace {

using film::Pass;

enum Group : unsigned {
  kNeeded = 0,
  kLamps = 1,       // and glowing surfaces, with their shadows
  kWorldLight = 2,
  kBackground = 4,
  kCache = 8,
  kOcclusion = 16,  // of light and of the AO pass
  kDarkening = 32,  // what becomes of occlusion in light
  kRays = 64,       // what mirrors and glass show
  kBounces = 128,   // of paths
};

Group group_of(std::string_view effect) {
  const auto any = [&](std::initializer_list<std::string_view> names) {
    return std::find(names.begin(), names.end(), effect) != names.end();
  };
  if (effect.ends_with("_shadows") && effect != "deep_shadows") return kLamps;
  if (any({"sun_cascades", "filtered_penumbrae", "direct_light", "emissive_light", "shadow_rays"})) return kLamps;
  if (effect == "world_light") return kWorldLight;
  if (effect == "world_background") return kBackground;
  if (effect == "radiance_cache" || effect.starts_with("cache_")) return kCache;
  if (effect == "ambient_occlusion" || effect.starts_with("occlusion_")) return kOcclusion;
  if (any({"bent_normals", "deep_shadows"})) return kDarkening;
  if (effect == "specular_rays") return kRays;
  if (any({"indirect_light", "filter_glossy"})) return kBounces;
  return kNeeded;
}

bool runs_if_known(const Effects& effects, std::string_view name) {
  return std::any_of(effects.begin(), effects.end(), [&](const Effect& e) { return e.name == name && e.runs; });
}

unsigned needs(const Effects& effects, Pass shown) {
  switch (shown) {
    case Pass::kNormal:
    case Pass::kDiffCol:
    case Pass::kGlossCol:
    case Pass::kTransCol:
    case Pass::kEmit: return 0;
    case Pass::kEnv: return kBackground;
    case Pass::kAo:
      // Shadow maps are drawn for lamps, and are looked at as other views.
      return kOcclusion | (runs_if_known(effects, "occlusion_lamp_views") ? unsigned(kLamps) : 0u);
    case Pass::kDiffDir:
      // The world's light comes past what stands in its way by the cache or by occlusion.
      return kLamps | (runs_if_known(effects, "world_light") ? kWorldLight | kCache | kOcclusion | kDarkening : 0u);
    case Pass::kDiffInd: {
      const bool lit = runs_if_known(effects, "radiance_cache") || runs_if_known(effects, "indirect_light");
      return lit ? kLamps | kWorldLight | kCache | kOcclusion | kDarkening | kBounces : 0u;
    }
    default: return ~0u;
  }
}

}  // namespace

void leave_out(Effects& effects, Pass shown, bool path_tracing) {
  const unsigned needed = needs(effects, shown) | (path_tracing ? ~unsigned(kBounces) : 0u);
  for (Effect& effect : effects) {
    const unsigned group = group_of(effect.name);
    if (!effect.runs || (group & needed) == group) continue;
    effect.runs = false;
    effect.by_choice = true;
    effect.reason = "the pass that is shown has nothing of it";
  }
}

path_tracer::Settings shortened(path_tracer::Settings paths, Pass shown) {
  if (shown == Pass::kAo || shown == Pass::kDiffDir) paths.bounces.total = 0;
  return paths;
}

}  // namespace panoptes::plan
