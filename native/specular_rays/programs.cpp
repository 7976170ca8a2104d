#include "specular_rays/programs.h"

#include <fmt/format.h>

namespace panoptes::specular_rays {

namespace {

gl::ProgramSource program(const char* name, const char* file) {
  gl::ProgramSource source;
  source.name = name;
  source.stages = {{GL_COMPUTE_SHADER, fmt::format("specular_rays/{}.comp", file)}};
  return source;
}

void define(gl::ProgramSource& source, const char* name, bool value) {
  source.defines.push_back(fmt::format("{} {}", name, int(value)));
}

}  // namespace

gl::ProgramSource select_program(const ProgramOptions& options) {
  gl::ProgramSource source = program("pixels of mirrors and glass", "select");
  options.surfaces.add_defines(source);
  return source;
}

gl::ProgramSource begin_program() { return program("specular paths", "begin"); }

gl::ProgramSource fetch_program(const gpu_scene::GpuMaterial& material,
                                const ProgramOptions& options) {
  gl::ProgramSource source = program("", "fetch");
  source.name = fmt::format("surfaces of material '{}' on specular paths", material.name);
  options.surfaces.add_defines(source);
  gpu_scene::GpuScene::add_material(material, source);
  return source;
}

gl::ProgramSource miss_program(const gpu_scene::GpuShading& world, const ProgramOptions& options) {
  gl::ProgramSource source = program("the world in mirrors and glass", "miss");
  define(source, "COLORED_ALPHA", options.colored_alpha);
  gpu_scene::GpuScene::add_world(world, source);
  return source;
}

gl::ProgramSource go_on_program(const ProgramOptions& options) {
  gl::ProgramSource source = program("turns of specular paths", "go_on");
  options.surfaces.add_defines(source);
  define(source, "COLORED_ALPHA", options.colored_alpha);
  define(source, "LAMPS", options.lamps);
  return source;
}

gl::ProgramSource lamps_program(const ProgramOptions& options, const LampOptions& lamps) {
  gl::ProgramSource source = program("lamps' light in mirrors and glass", "lamps");
  options.surfaces.add_defines(source);
  define(source, "SHADOWS", lamps.shadows);
  define(source, "FILTERED_PENUMBRAE", lamps.filtered_penumbrae);
  return source;
}

gl::ProgramSource surroundings_program(const ProgramOptions& options,
                                       const SurroundingsOptions& surroundings) {
  gl::ProgramSource source = program("light around what mirrors and glass show", "surroundings");
  source.defines.push_back(fmt::format("WORLD_LIGHT {}", int(surroundings.world)));
  source.defines.push_back(fmt::format("RADIANCE_CACHE {}", int(surroundings.cache.has_value())));
  if (surroundings.cache) surroundings.cache->add_defines(source);
  options.surfaces.add_defines(source);
  return source;
}

}  // namespace panoptes::specular_rays
