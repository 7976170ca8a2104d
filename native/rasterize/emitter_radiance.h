// The radiance that leaves points of glowing surfaces, asked of their materials.
#pragma once

#include "gl/program.h"
#include "gpu_scene/gpu_scene.h"
#include "rasterize/emitters_shared.h"

#include <span>
#include <vector>

namespace panoptes::rasterize {

struct EmitterProbe {
  scene::Id material = 0;
  shared::EmitterPlace place;
};

gl::ProgramSource emitter_program(const gpu_scene::GpuMaterial& material);

// One answer a probe, in their order. A view block must be bound; its origin is all that counts of it.
std::vector<shared::EmitterRadiance> emitted_radiance(std::span<const EmitterProbe> probes,
                                                      const gpu_scene::GpuScene& gpu,
                                                      gl::ProgramCache& programs);

}  // namespace panoptes::rasterize
