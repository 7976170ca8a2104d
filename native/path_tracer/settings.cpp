#include "path_tracer/settings.h"

#include "base/error.h"

#include <array>
#include <cmath>
#include <utility>

namespace panoptes::path_tracer {

void Settings::check() const {
  constexpr int kMost = 1024;
  const std::array<std::pair<const char*, int>, 5> limits{{{"", bounces.total},
                                                           {"diffuse ", bounces.diffuse},
                                                           {"glossy ", bounces.glossy},
                                                           {"transmission ", bounces.transmission},
                                                           {"transparent ", bounces.transparent}}};
  for (const auto& [kind, limit] : limits)
    if (limit < 0 || limit > kMost)
      fail("{} {}bounces are out of range: choose 0 to {}", limit, kind, kMost);
  if (!(clamp_direct >= 0) || !(clamp_indirect >= 0))
    fail("light cannot be clamped to less than nothing: set clamping to 0 to switch it off");
  if (!(filter_glossy >= 0) || !std::isfinite(filter_glossy))
    fail("a glossy filter of {} is out of range: choose 0 (off) or more", filter_glossy);
  if (std::isnan(ao_distance)) fail("the distance of ambient occlusion is not a number: set it again");
}

}  // namespace panoptes::path_tracer
