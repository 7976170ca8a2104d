#include "radiance_cache/geometry_volume.h"

#include "base/error.h"
#include "gl/dispatch.h"
#include "gpu_scene/units.h"
#include "radiance_cache/voxels_shared.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace panoptes::radiance_cache {

namespace {

// Bindings of shaders/radiance_cache.
constexpr unsigned kVolumesBlock = 4;
constexpr int kTriangleUnit = 0, kVoxelUnit = 1, kWordUnit = 2;

constexpr GLbitfield kBarriers = GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                                 GL_BUFFER_UPDATE_BARRIER_BIT;

// Bytes before the first of voxelize.comp's contenders, and of each.
constexpr int64_t kContenders = 8, kContenderBytes = sizeof(shared::Contender);

// Textures are read as if a pixel was so wide, in voxels: many surfels together have the mean of an
// image, and each has little of what lies beyond its voxel.
constexpr double kFootprint = 0.25;

void bind(unsigned binding, const gl::Buffer& buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.id());
}

void reserve_texture(gl::Buffer& buffer, gl::Texture& texture, GLenum format, int64_t bytes) {
  if (buffer.reserve(bytes)) texture = gl::Texture(format, buffer);
}

gl::ProgramSource volume_program(const char* name, const char* file) {
  gl::ProgramSource source;
  source.name = fmt::format("geometry volume: {}", name);
  source.stages = {{GL_COMPUTE_SHADER, fmt::format("radiance_cache/{}", file)}};
  source.defines = {fmt::format("VOLUMES_BLOCK {}", kVolumesBlock),
                    fmt::format("VOLUME_WORDS_UNIT {}", kWordUnit)};
  return source;
}

gl::ProgramSource solid_program() { return volume_program("solid voxels", "solid.comp"); }
gl::ProgramSource list_program() { return volume_program("list", "list_solid.comp"); }
gl::ProgramSource winners_program() { return volume_program("winners", "winners.comp"); }
gl::ProgramSource points_program() { return volume_program("points", "surfel_points.comp"); }
gl::ProgramSource number_program() { return volume_program("numbers", "number_surfels.comp"); }

gl::ProgramSource voxelize_program(bool large) {
  gl::ProgramSource source = volume_program("triangles", "voxelize.comp");
  source.defines.push_back(fmt::format("LARGE {}", int(large)));
  return source;
}

// Where the lattice of voxels of a grid's size has its lowest corner, in voxels.
int lattice_place(double low, double voxel) {
  const double place = std::round(low / voxel);
  // Beyond what whole numbers hold, wherever.
  return std::abs(place) < 1e9 ? int(place) : int(std::fmod(place, 1e9));
}

}  // namespace

struct GeometryVolume::Frame {
  const tracing::TriangleList& triangles;
  const gpu_scene::GpuScene& gpu;
  gpu_scene::ViewBlock& view_block;
  gl::ProgramCache& programs;
};

std::vector<gl::ProgramSource> volume_programs() {
  return {voxelize_program(false), voxelize_program(true), solid_program(),
          list_program(),          winners_program(),      points_program(),
          number_program()};
}

gl::ProgramSource surfels_program(const gpu_scene::GpuMaterial& material) {
  gl::ProgramSource source;
  source.name = fmt::format("surfels of material '{}'", material.name);
  source.stages = {{GL_COMPUTE_SHADER, "radiance_cache/surfels.comp"}};
  // What generated code knows of sides, and what closures make of them.
  const bool sides_differ = material.facts.transmission ||
                            material.code.find("backfacing") != std::string::npos ||
                            material.code.find("hit.view") != std::string::npos;
  source.defines = {fmt::format("SIDES_DIFFER {}", int(sides_differ))};
  gpu_scene::GpuScene::add_material(material, source);
  return source;
}

bool GeometryVolume::update(std::span<const Grid> grids, float fill,
                            const tracing::TriangleList& triangles, const gpu_scene::GpuScene& gpu,
                            gpu_scene::ViewBlock& view_block, gl::ProgramCache& programs,
                            gl::PassTimer& timer) {
  const bool same_voxels = geometry_revision_ == gpu.geometry_revision() && fill_ == fill &&
                           std::equal(grids.begin(), grids.end(), grids_.begin(), grids_.end());
  if (same_voxels && surface_revision_ == gpu.surface_revision()) return false;
  surface_revision_ = -1;  // until all is well
  const Frame frame{triangles, gpu, view_block, programs};
  if (!same_voxels) {
    gl::PassScope scope(timer, "radiance_cache_voxels");
    geometry_revision_ = -1;
    place(grids, triangles.origin());
    fill_ = fill;
    voxelize(frame);
    geometry_revision_ = gpu.geometry_revision();
  }
  gl::PassScope scope(timer, "radiance_cache_surfels");
  make_surfels(frame);
  surface_revision_ = gpu.surface_revision();
  return true;
}

void GeometryVolume::place(std::span<const Grid> grids, const glm::vec3& origin) {
  if (grids.size() > MOST_CASCADES)
    fail("the radiance cache has {} cascades: choose {} at most", grids.size(), MOST_CASCADES);
  grids_.assign(grids.begin(), grids.end());
  volumes_ = {};
  int64_t words = 0, cells = 0;
  for (size_t i = 0; i < grids.size(); ++i) {
    const Grid& grid = grids[i];
    shared::CacheVolume& volume = volumes_.volumes[i];
    const glm::ivec3 counts = grid.cells * grid.voxels;
    const int row = (counts.x + 31) / 32;
    volume.low = glm::vec4(glm::vec3(grid.low - glm::dvec3(origin)), float(grid.cell));
    volume.cells = glm::ivec4(grid.cells, grid.voxels);
    volume.first = glm::ivec4(row, int(words), int(cells), 0);
    for (int axis = 0; axis < 3; ++axis)
      lattice_[i][axis] = lattice_place(grid.low[axis], grid.cell / grid.voxels);
    words += int64_t(row) * counts.y * counts.z;
    cells += int64_t(grid.cells.x) * grid.cells.y * grid.cells.z;
    if (words * 32 > kMostVoxels)
      fail("the radiance cache has more than {} million voxels: choose a lower resolution or fewer "
           "voxels a cell",
           kMostVoxels >> 20);
  }
  volumes_.count = glm::ivec4(int(grids.size()), int(cells), 0, 0);
  word_count_ = uint32_t(words);
}

void GeometryVolume::voxelize(const Frame& frame) {
  if (!block_) block_ = gl::Buffer(sizeof volumes_);
  block_.write(0, sizeof volumes_, &volumes_);
  glBindBufferBase(GL_UNIFORM_BUFFER, kVolumesBlock, block_.id());
  reserve_texture(voxels_, voxel_texture_, GL_RG32UI, int64_t(word_count_) * 32 * 8);
  reserve_texture(bits_, bit_texture_, GL_RG32UI, int64_t(word_count_) * 8);
  large_.reserve((int64_t(frame.triangles.count()) + 1) * 4);
  run_triangles(frame);

  const gl::Buffer count(4);
  const uint32_t zero = 0;
  glNamedBufferSubData(count.id(), 0, 4, &zero);
  frame.programs.get(solid_program()).use();
  voxel_texture_.bind(0);
  bind(0, bits_);
  bind(1, count);
  glUniform1ui(0, word_count_);
  glUniform1ui(1, uint32_t(std::ceil(std::clamp(double(fill_), 0.0, 1e4) * shared::AREA_STEPS)));
  gl::dispatch(word_count_, kBarriers);
  count.read(0, 4, &candidates_);

  listed_.reserve(int64_t(candidates_) * 4);
  frame.programs.get(list_program()).use();
  bit_texture_.bind(0);
  bind(0, listed_);
  glUniform1ui(0, word_count_);
  gl::dispatch(word_count_, kBarriers);

  winners_.reserve(int64_t(candidates_) * 4);
  const uint32_t nobody = shared::NO_PRIMITIVE;
  glClearNamedBufferData(winners_.id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &nobody);
  frame.programs.get(winners_program()).use();
  voxel_texture_.bind(kVoxelUnit);
  bit_texture_.bind(kWordUnit);
  bind(0, contenders_);
  bind(1, winners_);
  glUniform1ui(0, contender_count_);
  gl::dispatch(contender_count_, kBarriers);
}

void GeometryVolume::run_triangles(const Frame& frame) {
  frame.triangles.texture().bind(kTriangleUnit);
  contender_count_ = std::max(2 * frame.triangles.count(), 1u << 16);
  // Again with more room where there was too little: how many there are depends on the order in which
  // triangles come, but little.
  for (uint32_t room = 0; contender_count_ > room;) {
    contenders_.reserve(kContenders + int64_t(contender_count_) * kContenderBytes);
    room = uint32_t(std::min<int64_t>((contenders_.bytes() - kContenders) / kContenderBytes, INT32_MAX));
    contender_count_ = 0;
    contenders_.write(0, 4, &contender_count_);
    voxels_.clear();
    bind(0, voxels_);
    bind(1, large_);
    bind(2, contenders_);
    for (int volume = 0; volume < volumes_.count.x; ++volume) {
      const auto run = [&](bool large, uint32_t count) {
        frame.programs.get(voxelize_program(large)).use();
        glUniform1ui(0, count);
        glUniform1ui(1, room);
        glUniform1i(3, volume);
        glUniform3iv(4, MOST_CASCADES, &lattice_[0].x);
        gl::dispatch(large ? count * 64 : count, kBarriers);
      };
      uint32_t large = 0;
      large_.write(0, 4, &large);
      run(false, frame.triangles.count());
      large_.read(0, 4, &large);
      if (large) run(true, large);
    }
    contenders_.read(0, 4, &contender_count_);
    if (contender_count_ > room) contender_count_ += contender_count_ / 8;
  }
}

void GeometryVolume::make_surfels(const Frame& frame) {
  reserve_texture(words_, word_texture_, GL_RG32UI, int64_t(word_count_) * 8);
  glCopyNamedBufferSubData(bits_.id(), words_.id(), 0, 0, int64_t(word_count_) * 8);
  const int64_t bytes = int64_t(candidates_) * int64_t(sizeof(shared::Surfel));
  drafts_.reserve(bytes);
  reserve_texture(surfels_, surfel_texture_, GL_RGBA32UI, bytes);
  if (candidates_) {
    hits_.reserve(int64_t(candidates_) * int64_t(sizeof(shared::TracedHit)));
    frame.programs.get(points_program()).use();
    glBindBufferBase(GL_UNIFORM_BUFFER, kVolumesBlock, block_.id());
    frame.triangles.texture().bind(kTriangleUnit);
    voxel_texture_.bind(kVoxelUnit);
    bind(0, listed_);
    bind(1, winners_);
    bind(2, drafts_);
    bind(3, hits_);
    glUniform1ui(0, candidates_);
    glUniform3iv(4, MOST_CASCADES, &lattice_[0].x);
    gl::dispatch(candidates_, kBarriers);
    evaluate(frame);
  }
  number_words();
  block_.write(0, sizeof volumes_, &volumes_);
  if (!candidates_) return;
  frame.programs.get(number_program()).use();
  word_texture_.bind(kWordUnit);
  bind(0, listed_);
  bind(1, drafts_);
  bind(2, surfels_);
  glUniform1ui(0, candidates_);
  gl::dispatch(candidates_, kBarriers);
}

void GeometryVolume::evaluate(const Frame& frame) {
  const auto& materials = frame.gpu.materials();
  bins_.sort({hits_, candidates_}, uint32_t(materials.size()), frame.triangles, frame.programs);
  shared::View view{};
  view.world_origin = glm::vec4(frame.triangles.origin(), 0);
  // As wide everywhere: an orthographic view's pixel. That of the finest voxels is good for all.
  view.filtering.y = float(kFootprint * grids_[0].cell / grids_[0].voxels);
  frame.view_block.set(view);
  frame.gpu.bind_geometry();
  GLuint first = 0;
  for (size_t m = 0; m < materials.size(); ++m) {
    const uint32_t count = bins_.counts()[m];
    if (count == 0) continue;
    frame.programs.get(surfels_program(materials[m])).use();
    frame.gpu.bind_shading(materials[m]);
    frame.triangles.texture().bind(gpu_scene::kFreeUnit);
    bind(0, hits_);
    bind(1, words_);
    bind(2, drafts_);
    bind(3, listed_);
    bind(4, bins_.sorted());
    glUniform2ui(1, first, count);
    gl::dispatch(count, kBarriers);
    first += count;
  }
}

void GeometryVolume::number_words() {
  std::vector<glm::uvec2> words(word_count_);
  if (word_count_) words_.read(0, int64_t(word_count_) * 8, words.data());
  solid_ = 0;
  for (glm::uvec2& word : words) {
    word.y = solid_;
    solid_ += uint32_t(std::popcount(word.x));
  }
  if (word_count_) words_.write(0, int64_t(word_count_) * 8, words.data());
  volumes_.count.z = int(solid_);
}

}  // namespace panoptes::radiance_cache
