// Runs compute programs over lists of any length.
#pragma once

#include <epoxy/gl.h>

#include <cstdint>

namespace panoptes::gl {

// Runs the program in use at least `invocations` times, in work groups of 64 over x and then y, since
// a driver may allow no more than 65 535 along either; shaders number themselves by invocation() of
// base/invocation.glsl. Then waits as glMemoryBarrier(barriers) does.
void dispatch(uint32_t invocations, GLbitfield barriers);

}  // namespace panoptes::gl
