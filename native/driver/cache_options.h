#pragma once

#include "radiance_cache/settings.h"

#include <string>

namespace panoptes::driver {

// Sets what "KEY=VALUE" says, with the names of Settings' members.
void set_cache(radiance_cache::Settings& settings, const std::string& option);

}  // namespace panoptes::driver
