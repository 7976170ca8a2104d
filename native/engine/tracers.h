// Makes the ray tracers that a structure may be chosen from.
#pragma once

#include "engine/structure.h"
#include "gl/context.h"
#include "tracing/tracer.h"

#include <memory>

namespace panoptes::engine {

// `settings` must name one structure, not kAuto. A hierarchy has neither tiles nor buckets.
std::unique_ptr<tracing::Tracer> make_tracer(const StructureSettings& settings,
                                             const gl::DeviceInfo& device);

}  // namespace panoptes::engine
