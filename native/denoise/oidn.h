// OpenImageDenoise, where the computer has it: loaded at run time, versions 1 and 2. It is looked for under the names that it
// is installed under, or under that which PANOPTES_OIDN (environment) gives; "none" keeps it away.
#pragma once

#include "denoise/picture.h"

#include <string>
#include <vector>

namespace panoptes::denoise {

// Whether it was found; loads it at the first call. From any thread.
bool has_oidn();

// RGBA, alpha as it was. Throws Error with what the library says when it fails or is not there.
std::vector<float> denoise_with_oidn(const Picture& picture);

}  // namespace panoptes::denoise
