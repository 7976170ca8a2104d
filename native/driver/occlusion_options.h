#pragma once

#include "ambient_occlusion/settings.h"

#include <string>

namespace panoptes::driver {

// Takes over "KEY=VALUE", by the names of Settings. Throws Error where there is no such key or value.
void set_occlusion(ambient_occlusion::Settings& settings, const std::string& option);

}  // namespace panoptes::driver
