// Ray tracers by name.
#pragma once

#include "tracing/tracer.h"

#include <memory>
#include <string_view>

namespace panoptes::engine {

// Throws Error when there is none of that name.
std::unique_ptr<tracing::Tracer> make_tracer(std::string_view name);

}  // namespace panoptes::engine
