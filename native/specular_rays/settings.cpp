#include "specular_rays/settings.h"

#include "base/choices.h"

namespace panoptes::specular_rays {

void Settings::check() const {
  check_choice(kModeNames, mode, "mode of specular rays");
  if (!(roughness >= 0 && roughness <= 1))
    fail("a roughness of {} for specular rays is out of range: choose 0 to 1", roughness);
}

}  // namespace panoptes::specular_rays
