#include "radiance_cache/bindings.h"
#include "rasterize/g_buffer.h"
#include "radiance_cache/radiance_cache.h"
#include "radiance_cache/reflective_maps.h"

#include <fmt/format.h>

namespace panoptes::radiance_cache {

namespace {

gl::ProgramSource compute(const char* name, const char* file) {
  gl::ProgramSource source;
  source.name = name;
  source.stages = {{GL_COMPUTE_SHADER, file}};
  return source;
}

// Coefficients of luminance (or of each colour) and of a chrominance.
struct Terms {
  bool rgb;
  int luminance, chrominance;
};

constexpr Terms terms(Encoding encoding) {
  switch (encoding) {
    case Encoding::kY3Co1Cg1: return {false, 9, 1};
    case Encoding::kY3Co2Cg2: return {false, 9, 4};
    case Encoding::kY3Co3Cg3: return {false, 9, 9};
    case Encoding::kRgb3: return {true, 9, 9};
    case Encoding::kY2Co2Cg2: return {false, 4, 4};
    case Encoding::kRgb2: return {true, 4, 4};
  }
  return {};
}

void add_encoding(gl::ProgramSource& source, Encoding encoding) {
  const Terms t = terms(encoding);
  source.defines.push_back(fmt::format("RGB {}", int(t.rgb)));
  source.defines.push_back(fmt::format("LUMINANCE_TERMS {}", t.luminance));
  source.defines.push_back(fmt::format("CHROMINANCE_TERMS {}", t.chrominance));
}

// Where the geometry volume is bound, for the cache's own programs.
void add_volume(gl::ProgramSource& source) {
  source.defines.push_back(fmt::format("VOLUMES_BLOCK {}", kVolumesBlock));
  source.defines.push_back(fmt::format("VOLUME_WORDS_UNIT {}", kWordsUnit));
  source.defines.push_back(fmt::format("VOLUME_SURFELS_UNIT {}", kSurfelsUnit));
  source.defines.push_back(fmt::format("MET_SIDES_UNIT {}", kMetSidesUnit));
}

// Where in cells light is received (cell_places.glsl).
void add_places(gl::ProgramSource& source, bool walls) {
  source.defines.push_back(fmt::format("WALLS {}", int(walls)));
  source.defines.push_back(fmt::format("REACH_UNIT {}", kReachUnit));
}

}  // namespace

int cell_texels(Encoding encoding) {
  const Terms t = terms(encoding);
  return (t.luminance + 2 * t.chrominance + 4) / 4;
}

void LookUpOptions::add_defines(gl::ProgramSource& source) const {
  add_encoding(source, encoding);
  source.defines.push_back(fmt::format("CACHE_SPLIT {}", int(split)));
  source.defines.push_back(fmt::format("CACHE_UNIT {}", unit));
  source.defines.push_back(fmt::format("CACHE_WALLS {}", int(walls)));
  source.defines.push_back(fmt::format("REACH_UNIT {}", unit + 3));
  source.defines.push_back(fmt::format("CACHE_BLOCK {}", block));
  source.defines.push_back(fmt::format("CACHE_SCALES {}", int(scaled)));
  source.defines.push_back(fmt::format("SCALES_UNIT {}", unit + 2));
  source.defines.push_back(fmt::format("SCALES_BLOCK {}", block + 1));
}

gl::ProgramSource find_seeds_program() {
  gl::ProgramSource source = compute("seeds of cells", "radiance_cache/find_seeds.comp");
  add_volume(source);
  return source;
}

gl::ProgramSource find_reach_program() {
  gl::ProgramSource source = compute("what reaches voxels", "radiance_cache/find_reach.comp");
  add_volume(source);
  return source;
}

gl::ProgramSource mark_seen_program() {
  gl::ProgramSource source = compute("cells that are seen", "radiance_cache/mark_seen.comp");
  rasterize::GBufferOptions().add_defines(source);
  source.defines.push_back(fmt::format("CACHE_BLOCK {}", kCellsBlock));
  source.defines.push_back(fmt::format("DEPTH_UNIT {}", kCellsUnit));
  return source;
}

gl::ProgramSource list_cells_program(Occupancy occupancy, bool dilate) {
  gl::ProgramSource source = compute("cells that hold light", "radiance_cache/list_cells.comp");
  source.defines = {"GEOMETRY 1", "DEPTH 2", "TIERS 3", "ALL 4", fmt::format("OCCUPANCY {}", int(occupancy)),
                    fmt::format("DILATE {}", int(dilate))};
  add_volume(source);
  return source;
}

gl::ProgramSource march_program(int steps, bool walls, bool mark_met) {
  gl::ProgramSource source = compute("rays of cells", "radiance_cache/march.comp");
  source.defines = {fmt::format("MARCH_STEPS {}", steps), fmt::format("MARK_MET {}", int(mark_met))};
  add_places(source, walls);
  add_volume(source);
  return source;
}

gl::ProgramSource gather_program(const GatherOptions& options) {
  gl::ProgramSource source = compute("light of cells", "radiance_cache/gather.comp");
  add_encoding(source, options.encoding);
  source.defines.push_back(fmt::format("CACHE_BLOCK {}", kCellsBlock));
  source.defines.push_back(fmt::format("CACHE_SPLIT {}", int(options.split)));
  source.defines.push_back(fmt::format("WORLD {}", int(options.world)));
  source.defines.push_back(fmt::format("BOUNCED {}", int(options.bounced)));
  source.defines.push_back(fmt::format("REFLECTED {}", int(options.reflected)));
  return source;
}

gl::ProgramSource blend_program(Encoding encoding, bool split) {
  gl::ProgramSource source = compute("cells of two frames", "radiance_cache/blend.comp");
  add_encoding(source, encoding);
  source.defines.push_back(fmt::format("CACHE_BLOCK {}", kCellsBlock));
  source.defines.push_back(fmt::format("CACHE_SPLIT {}", int(split)));
  return source;
}

gl::ProgramSource bounce_program(const LookUpOptions& options, bool lamps, bool cache, bool met_alone) {
  gl::ProgramSource source = compute("light of surfels", "radiance_cache/bounce.comp");
  add_volume(source);
  if (cache) options.add_defines(source);
  source.defines.push_back(fmt::format("LAMPS {}", int(lamps)));
  source.defines.push_back(fmt::format("CACHE_LIGHT {}", int(cache)));
  source.defines.push_back(fmt::format("MET_ALONE {}", int(met_alone)));
  return source;
}

gl::ProgramSource picture_program(Picture picture, const LookUpOptions& options,
                                  const film::Film& film) {
  gl::ProgramSource source = compute("radiance cache picture", "radiance_cache/picture.comp");
  source.defines = {"GEOMETRY 1", "OCCUPANCY 2", "LOBES 3", "LIGHT 4", "CLIPPED 5",
                    fmt::format("PICTURE {}", int(picture)), "MARCH_STEPS 0"};
  add_volume(source);
  options.add_defines(source);
  rasterize::GBufferOptions().add_defines(source);
  film.add_defines(source);
  return source;
}

gl::ProgramSource light_surfels_program(bool shadows, bool met_alone) {
  gl::ProgramSource source = compute("lamps on surfels", "radiance_cache/light_surfels.comp");
  source.defines = {fmt::format("SHADOWS {}", int(shadows)), "FILTERED_PENUMBRAE 0",
                    fmt::format("MET_ALONE {}", int(met_alone))};
  add_volume(source);
  return source;
}

gl::ProgramSource rsm_surfaces_program(const gpu_scene::GpuMaterial& material) {
  gl::ProgramSource source;
  source.name = fmt::format("reflective shadow map of material '{}'", material.name);
  source.stages = {{GL_COMPUTE_SHADER, "radiance_cache/rsm_surfaces.comp"}};
  source.defines = {"SHADOWS 0"};
  gpu_scene::GpuScene::add_material(material, source);
  return source;
}

gl::ProgramSource rsm_gather_program(bool mixed, int march_steps, bool walls) {
  gl::ProgramSource source = compute("samples of reflective shadow maps", "radiance_cache/rsm_gather.comp");
  source.defines = {fmt::format("MIXED {}", int(mixed)), fmt::format("MARCH_STEPS {}", march_steps)};
  add_places(source, walls);
  add_volume(source);
  return source;
}

}  // namespace panoptes::radiance_cache
