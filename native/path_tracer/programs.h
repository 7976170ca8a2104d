// The programs of path tracing, each compiled for what a frame calls for.
#pragma once

#include "film/film.h"
#include "gl/program.h"
#include "gpu_scene/gpu_scene.h"
#include "path_tracer/path_shared.h"
#include "rasterize/g_buffer.h"

#include <string>
#include <vector>

namespace panoptes::path_tracer {

struct ProgramOptions {
  rasterize::GBufferOptions surfaces;
  std::vector<std::string> light_defines;  // of Lights
  // Passes that are summed for each path, under their names in shaders; the first is Combined.
  std::vector<std::string> passes;
  bool occlusion = false;         // AO is one of them
  bool light_passes = false;      // some of them split light by the lobes of the first surface
  bool clamp = false;
  bool filter_glossy = false;
  bool lens = false;
  bool alpha = false;             // shadows may be partial
  bool shines = false;            // paths that look for light may meet some
  bool deferred = false;          // some lights are only evaluated once they are known to arrive
  bool transparent_film = false;
  bool shadow_maps = false;

  // Adds the passes that a film has been started with.
  void add_passes(const film::PassSet& passes);
};

// `centre`: through the middle of pixels and lens.
gl::ProgramSource begin_paths_program(const ProgramOptions& options, bool listed, bool centre);
gl::ProgramSource fetch_program(const gpu_scene::GpuMaterial& material,
                                const ProgramOptions& options);
gl::ProgramSource shade_program(const ProgramOptions& options);
// `world`: null where it is black.
gl::ProgramSource miss_program(const gpu_scene::GpuShading* world, const ProgramOptions& options);
// `traced`: along shadow rays; else where none is needed.
gl::ProgramSource arrive_program(const ProgramOptions& options, bool traced);
gl::ProgramSource arrive_world_program(const gpu_scene::GpuShading& world,
                                       const ProgramOptions& options);
gl::ProgramSource arrive_emitter_program(const gpu_scene::GpuMaterial& material,
                                         const ProgramOptions& options);
gl::ProgramSource depth_program(const film::Film& film);
gl::ProgramSource occlusion_rays_program(const ProgramOptions& options);
gl::ProgramSource occlusion_program(const ProgramOptions& options);
gl::ProgramSource resolve_program(const ProgramOptions& options, bool listed,
                                  const film::Film& film);

}  // namespace panoptes::path_tracer
