#include "path_tracer/programs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace panoptes::path_tracer {

namespace {

using film::Pass;

bool splits_light(Pass pass) {
  constexpr std::array split{Pass::kDiffDir, Pass::kDiffInd,  Pass::kGlossDir,
                             Pass::kGlossInd, Pass::kTransDir, Pass::kTransInd};
  return std::find(split.begin(), split.end(), pass) != split.end();
}

gl::ProgramSource program(const char* name, const char* file) {
  gl::ProgramSource source;
  source.name = name;
  source.stages = {{GL_COMPUTE_SHADER, fmt::format("path_tracer/{}.comp", file)}};
  return source;
}

void define(gl::ProgramSource& source, const char* name, bool value) {
  source.defines.push_back(fmt::format("{} {}", name, int(value)));
}

// What path_state.glsl and light_sums.glsl ask for.
void add_sums(const ProgramOptions& options, gl::ProgramSource& source) {
  define(source, "LIGHT_PASSES", options.light_passes);
  define(source, "CLAMP", options.clamp);
  source.defines.push_back(fmt::format("PASSES {}", options.passes.size()));
  for (size_t i = 0; i < options.passes.size(); ++i)
    source.defines.push_back(fmt::format("PASS_{} {}", options.passes[i], i));
}

void add_lights(const ProgramOptions& options, gl::ProgramSource& source) {
  const bool any = !options.light_defines.empty();
  define(source, "LIGHTS", any);
  if (!any) define(source, "LAMPS_SEEN", false);
  source.defines.insert(source.defines.end(), options.light_defines.begin(),
                        options.light_defines.end());
}

}  // namespace

void ProgramOptions::add_passes(const film::PassSet& wanted) {
  passes = {"COMBINED"};
  light_passes = occlusion = false;
  for (int i = 1; i < film::kPassCount; ++i) {
    // Others are written straight into the film, or made by it.
    if (!wanted[size_t(i)] || film::info(Pass(i)).kind != film::PassKind::kSum) continue;
    constexpr size_t kPrefix = 5;  // of "FILM_..."
    passes.emplace_back(film::info(Pass(i)).define.substr(kPrefix));
    light_passes |= splits_light(Pass(i));
    occlusion |= Pass(i) == Pass::kAo;
  }
}

gl::ProgramSource begin_paths_program(const ProgramOptions& options, bool listed, bool centre) {
  gl::ProgramSource source = program("camera's paths", "begin_paths");
  define(source, "LISTED", listed);
  define(source, "CENTRE", centre);
  define(source, "LENS", options.lens);
  define(source, "LIGHT_PASSES", options.light_passes);
  source.defines.push_back(fmt::format("PASSES {}", options.passes.size()));
  return source;
}

gl::ProgramSource fetch_program(const gpu_scene::GpuMaterial& material,
                                const ProgramOptions& options) {
  gl::ProgramSource source = program("", "fetch");
  source.name = fmt::format("surfaces of material '{}' on paths", material.name);
  options.surfaces.add_defines(source);
  define(source, "LIGHT_PASSES", options.light_passes);
  gpu_scene::GpuScene::add_material(material, source);
  return source;
}

gl::ProgramSource shade_program(const ProgramOptions& options) {
  gl::ProgramSource source = program("shading of paths", "shade");
  options.surfaces.add_defines(source);
  add_sums(options, source);
  add_lights(options, source);
  define(source, "FILTER_GLOSSY", options.filter_glossy);
  define(source, "SHINES", options.shines);
  define(source, "SHADOW_MAPS", options.shadow_maps);
  if (options.shadow_maps) define(source, "FILTERED_PENUMBRAE", false);
  define(source, "SUMS_IN_STORAGE", false);
  return source;
}

gl::ProgramSource miss_program(const gpu_scene::GpuShading* world, const ProgramOptions& options) {
  gl::ProgramSource source = program("paths that leave the scene", "miss");
  add_sums(options, source);
  add_lights(options, source);
  define(source, "WORLD", world != nullptr);
  define(source, "TRANSPARENT_FILM", options.transparent_film);
  define(source, "SUMS_IN_STORAGE", false);
  if (world) gpu_scene::GpuScene::add_world(*world, source);
  return source;
}

gl::ProgramSource arrive_program(const ProgramOptions& options, bool traced) {
  gl::ProgramSource source = program("light that arrives", "arrive");
  add_sums(options, source);
  define(source, "TRACED", traced);
  define(source, "TRANSMITTANCE", options.alpha);
  define(source, "DEFERRED", options.deferred);
  define(source, "SUMS_IN_STORAGE", false);
  return source;
}

gl::ProgramSource arrive_world_program(const gpu_scene::GpuShading& world,
                                       const ProgramOptions& options) {
  gl::ProgramSource source = program("light from the world", "arrive_world");
  add_sums(options, source);
  define(source, "SUMS_IN_STORAGE", false);
  gpu_scene::GpuScene::add_world(world, source);
  return source;
}

gl::ProgramSource arrive_emitter_program(const gpu_scene::GpuMaterial& material,
                                         const ProgramOptions& options) {
  gl::ProgramSource source = program("", "arrive_emitter");
  source.name = fmt::format("light from material '{}'", material.name);
  add_sums(options, source);
  define(source, "SUMS_IN_STORAGE", true);
  gpu_scene::GpuScene::add_material(material, source);
  return source;
}

gl::ProgramSource depth_program(const film::Film& film) {
  gl::ProgramSource source = program("depth of paths", "depth");
  film.add_defines(source);
  return source;
}

gl::ProgramSource occlusion_rays_program(const ProgramOptions& options) {
  gl::ProgramSource source = program("rays of ambient occlusion", "occlusion_rays");
  options.surfaces.add_defines(source);
  define(source, "LIGHT_PASSES", options.light_passes);
  return source;
}

gl::ProgramSource occlusion_program(const ProgramOptions& options) {
  gl::ProgramSource source = program("ambient occlusion", "occlusion");
  add_sums(options, source);
  define(source, "SUMS_IN_STORAGE", false);
  return source;
}

gl::ProgramSource resolve_program(const ProgramOptions& options, bool listed,
                                  const film::Film& film) {
  gl::ProgramSource source = program("paths into the film", "resolve");
  define(source, "LISTED", listed);
  add_sums(options, source);
  film.add_defines(source);
  return source;
}

}  // namespace panoptes::path_tracer
