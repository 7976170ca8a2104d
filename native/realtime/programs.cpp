#include "realtime/realtime.h"

#include <fmt/format.h>

namespace panoptes::realtime {

gl::ProgramSource direct_light_program(const LightOptions& options) {
  gl::ProgramSource source;
  source.name = "direct light";
  source.stages = {{GL_COMPUTE_SHADER, "realtime/direct_light.comp"}};
  source.defines = {fmt::format("SHADOWS {}", int(options.shadows)),
                    fmt::format("FILTERED_PENUMBRAE {}", int(options.filtered_penumbrae)),
                    fmt::format("SPECULAR_RAYS {}", int(options.specular_rays))};
  options.surfaces.add_defines(source);
  return source;
}

gl::ProgramSource compose_program(const ComposeOptions& options, const film::Film& film) {
  gl::ProgramSource source;
  source.name = "compose";
  source.stages = {{GL_COMPUTE_SHADER, "realtime/compose.comp"}};
  source.defines = {fmt::format("LAMPS {}", int(options.lamps)),
                    fmt::format("BACKGROUND {}", int(options.background)),
                    fmt::format("WORLD_LIGHT {}", int(options.world_light)),
                    fmt::format("TRANSPARENT_FILM {}", int(options.transparent_film)),
                    fmt::format("OCCLUSION {}", int(options.occlusion)),
                    fmt::format("DEEP_SHADOWS {}", int(options.deep_shadows)),
                    fmt::format("PASS_OCCLUSION {}", int(options.pass_occlusion)),
                    fmt::format("SPECULAR_RAYS {}", int(options.specular_rays)),
                    fmt::format("RADIANCE_CACHE {}", int(options.cache.has_value())),
                    fmt::format("SCALED {}", int(options.cache && options.cache->scaled)),
                    fmt::format("AMBIENT {}", int(options.cache || options.world_light))};
  if (options.cache) options.cache->add_defines(source);
  options.surfaces.add_defines(source);
  film.add_defines(source);
  return source;
}

gl::ProgramSource depth_program(const film::Film& film) {
  gl::ProgramSource source;
  source.name = "depth";
  source.stages = {{GL_COMPUTE_SHADER, "realtime/depth.comp"}};
  film.add_defines(source);
  return source;
}

gl::ProgramSource background_program(const gpu_scene::GpuShading& world) {
  gl::ProgramSource source;
  source.name = "world background";
  source.stages = {{GL_COMPUTE_SHADER, "realtime/background.comp"}};
  gpu_scene::GpuScene::add_world(world, source);
  return source;
}

}  // namespace panoptes::realtime
