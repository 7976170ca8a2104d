// The programs of specular rays, each compiled for what a frame calls for.
#pragma once

#include "gl/program.h"
#include "gpu_scene/gpu_scene.h"
#include "radiance_cache/radiance_cache.h"
#include "rasterize/g_buffer.h"

#include <optional>

namespace panoptes::specular_rays {

struct ProgramOptions {
  rasterize::GBufferOptions surfaces;
  bool colored_alpha = false;  // surfaces may let coloured light pass straight on
  bool lamps = false;          // that rays do not meet
};

gl::ProgramSource select_program(const ProgramOptions& options);
gl::ProgramSource begin_program();
gl::ProgramSource fetch_program(const gpu_scene::GpuMaterial& material,
                                const ProgramOptions& options);
gl::ProgramSource miss_program(const gpu_scene::GpuShading& world, const ProgramOptions& options);
gl::ProgramSource go_on_program(const ProgramOptions& options);
// Both as direct light has them.
struct LampOptions {
  bool shadows = false, filtered_penumbrae = false;
};
gl::ProgramSource lamps_program(const ProgramOptions& options, const LampOptions& lamps);
// Light from all around: of the radiance cache where there is one, and the world's.
struct SurroundingsOptions {
  bool world = false;
  std::optional<radiance_cache::LookUpOptions> cache;
};
gl::ProgramSource surroundings_program(const ProgramOptions& options,
                                       const SurroundingsOptions& surroundings);

}  // namespace panoptes::specular_rays
