// Dimensions of a frame's sample sequences.
#pragma once

#include <cstdint>

namespace panoptes::realtime {

// The pixel's, that of glowing surfaces, then two a lamp.
constexpr uint32_t kPixelDimension = 0, kEmitterDimension = 1, kLampDimension = 2;

}  // namespace panoptes::realtime
