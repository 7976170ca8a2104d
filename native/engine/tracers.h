// Ray tracers by name.
#pragma once

#include "gl/context.h"
#include "tracing/tracer.h"

#include <memory>
#include <string_view>

namespace panoptes::engine {

// "orthographic": the structure of primitive_tracer in one view; "bvh": the yardstick. Throws Error
// when there is none of that name.
std::unique_ptr<tracing::Tracer> make_tracer(std::string_view name, const gl::DeviceInfo& device);

}  // namespace panoptes::engine
