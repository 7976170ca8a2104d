// The triangles that may glow, as lights: which of the traced triangles these are, and how much light
// leaves them.
#pragma once

#include "gl/program.h"
#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/view_block.h"
#include "path_tracer/light_records.h"

#include <glm/glm.hpp>

#include <vector>

namespace panoptes::path_tracer {

// In the order of primitives. Positions are relative to `origin`, world space. Leaves out what turns
// out dark, and what no scattered ray can meet.
std::vector<DescribedLight> glowing_triangles(const scene::Scene& scene,
                                              const gpu_scene::GpuScene& gpu, const glm::vec3& origin,
                                              gl::ProgramCache& programs,
                                              gpu_scene::ViewBlock& view_block);

}  // namespace panoptes::path_tracer
