// Makes the ray tracers that a structure may be chosen from.
#pragma once

#include "engine/structure.h"
#include "gl/context.h"
#include "gpu_scene/view.h"
#include "tracing/tracer.h"

#include <memory>

namespace panoptes::engine {

// `settings` must name one structure, not kAuto. A hierarchy has neither tiles nor buckets. `camera`
// and `origin`, that of the list of triangles in world space, matter to kView, which throws Error for a
// camera without perspective, and to kFragments.
std::unique_ptr<tracing::Tracer> make_tracer(const StructureSettings& settings,
                                             const gl::DeviceInfo& device,
                                             const gpu_scene::Camera& camera,
                                             const glm::dvec3& origin);

}  // namespace panoptes::engine
