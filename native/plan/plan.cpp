#include "plan/plan.h"

#include "ambient_occlusion/decide.h"
#include "denoise/decide.h"
#include "film/decide.h"
#include "radiance_cache/decide.h"
#include "rasterize/decide.h"
#include "ray_picture/decide.h"
#include "plan/shown_pass.h"
#include "realtime/decide.h"
#include "specular_rays/decide.h"

namespace panoptes::plan {

Effects make_plan(const scene::Facts& facts, const PlanSettings& settings) {
  Effects all;
  const auto append = [&](Effects part) {
    all.insert(all.end(), std::make_move_iterator(part.begin()),
               std::make_move_iterator(part.end()));
  };
  if (settings.debug_picture != ray_picture::Kind::kNone) {
    append(ray_picture::decide(facts, settings.debug_picture));
    append(film::decide(settings.passes));
    return all;
  }
  if (settings.path_tracing) {
    append(rasterize::decide_surfaces(facts));
    append(path_tracer::decide(facts, settings.paths));
  } else {
    append(rasterize::decide(facts, {settings.samples, settings.soft_shadows,
                                      settings.filter_penumbrae}));
    append(realtime::decide(facts));
    append(radiance_cache::decide(facts, settings.cache));
    append(ambient_occlusion::decide(facts, {settings.occlusion, runs(all, "radiance_cache"),
                                             settings.passes[size_t(film::Pass::kAo)],
                                             settings.samples}));
    append(specular_rays::decide(facts, settings.specular_rays));
  }
  append(denoise::decide({settings.denoise, settings.path_tracing, settings.samples, settings.shown_pass}));
  append(film::decide(settings.passes));
  leave_out(all, settings.shown_pass, settings.path_tracing);
  if (settings.force_all_effects)
    for (Effect& effect : all)
      if (!effect.runs && !effect.by_choice) {
        effect.runs = true;
        effect.reason = "forced on; by itself it would be skipped: " + effect.reason;
      }
  return all;
}

}  // namespace panoptes::plan
