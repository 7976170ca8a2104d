// Which cells of the radiance cache hold light, and what their rays meet.
#include "gl/dispatch.h"
#include "radiance_cache/bindings.h"
#include "radiance_cache/radiance_cache.h"
#include "radiance_cache/room.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace panoptes::radiance_cache {

namespace {

// Squares of pixels along the shorter side of a picture that tell which cells are seen, if it has so many.
constexpr int kLeastSquares = 60;

}  // namespace

void RadianceCache::find_seeds() {
  const uint32_t cells = uint32_t(volume_.volumes().count.y);
  want(seeds_, seeds_texels_, GL_R32UI, int64_t(cells) * 4);
  {
    gl::PassScope scope(timer_, "radiance_cache_cells");
    programs_.get(find_seeds_program()).use();
    bind_volume();
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, seeds_.id());
    gl::dispatch(cells, GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
  }
  if (!settings_.walls) {
    reach_texels_ = gl::Texture();
    reach_ = gl::Buffer();
  } else if (!reached_ || !reach_) {
    find_reach();
  }
}

void RadianceCache::find_reach() {
  gl::PassScope scope(timer_, "radiance_cache_reach");
  const uint32_t voxels = volume_.word_count() * 32;
  want(reach_, reach_texels_, GL_R32UI, int64_t(voxels) * 4);
  programs_.get(find_reach_program()).use();
  bind_volume();
  seeds_texels_.bind(0);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, reach_.id());
  glUniform1ui(0, voxels);
  gl::dispatch(voxels, GL_TEXTURE_FETCH_BARRIER_BIT);
  reached_ = true;
}

void RadianceCache::list_cells() {
  gl::PassScope scope(timer_, "radiance_cache_cells");
  const uint32_t cells = uint32_t(volume_.volumes().count.y);
  want(list_, int64_t(cells) * 4);
  gl::Buffer counter(4);
  counter.clear();
  programs_.get(list_cells_program(occupancy_, settings_.dilate)).use();
  bind_volume();
  seeds_texels_.bind(0);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, list_.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, counter.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, seeds_.id());
  gl::dispatch(cells, GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  counter.read(0, 4, &active_);
  directions_ = int(std::clamp<int64_t>(settings_.most_rays / std::max(active_, 1u), 1, settings_.directions));
}

std::string RadianceCache::warning() const {
  if (!runs_ || directions_ == settings_.directions) return {};
  return fmt::format("{} cells of indirect light look in {} directions each instead of {}, or there would be too many "
                     "rays: choose a lower Resolution or fewer Cascades",
                     active_, directions_, settings_.directions);
}

void RadianceCache::see(const rasterize::GBuffer& g_buffer, const glm::dvec3& origin) {
  if (!runs_) return;
  gl::Buffer counter(4);
  counter.clear();
  {
    gl::PassScope scope(timer_, "radiance_cache_cells");
    write_block(view_block_, origin);
    programs_.get(mark_seen_program()).use();
    glBindBufferBase(GL_UNIFORM_BUFFER, kCellsBlock, view_block_.id());
    g_buffer.bind_surfaces();
    g_buffer.depth().bind(kCellsUnit);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, seeds_.id());
    // In a small picture a cell covers few pixels.
    const int shorter = std::min(g_buffer.width(), g_buffer.height());
    const int side = std::clamp(shorter / kLeastSquares, 1, settings_.depth_stride);
    const glm::ivec2 squares((g_buffer.width() + side - 1) / side, (g_buffer.height() + side - 1) / side);
    glUniform3i(0, squares.x, squares.y, side);
    glUniform1ui(1, transmission_);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, counter.id());
    gl::dispatch(uint32_t(squares.x * squares.y), GL_TEXTURE_FETCH_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  }
  if (kept_) {
    uint32_t unlit = 0;
    counter.read(0, 4, &unlit);
    kept_ = unlit == 0;
    if (kept_) return;
  }
  lit_ = false;
  list_cells();
  march();
}

void RadianceCache::bind_volume() const {
  glBindBufferBase(GL_UNIFORM_BUFFER, kVolumesBlock, volume_.block().id());
  volume_.words().bind(kWordsUnit);
  volume_.surfels().bind(kSurfelsUnit);
}

void RadianceCache::bind_lattice(int location) const {
  std::array<glm::ivec4, MOST_CASCADES> lattice{};
  for (size_t v = 0; v < grids_.size(); ++v) {
    const glm::dvec3 place = glm::round(grids_[v].low / grids_[v].cell);
    // Far from the world's origin only the low bits tell cells apart, which is enough.
    for (int i = 0; i < 3; ++i) lattice[v][i] = int(std::remainder(place[i], double(1 << 24)));
  }
  glUniform4iv(location, MOST_CASCADES, &lattice[0][0]);
}

void RadianceCache::march() {
  gl::PassScope scope(timer_, "radiance_cache_march");
  const uint32_t rays = active_ * uint32_t(directions_);
  want(met_, met_texels_, GL_R32UI, std::max(int64_t(rays), int64_t(1)) * 4);
  if (rays == 0) return;
  programs_.get(march_program(settings_.march_steps, settings_.walls)).use();
  bind_volume();
  glUniform3ui(0, active_, unsigned(directions_), seed_);
  bind_lattice(1);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, list_.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, met_.id());
  seeds_texels_.bind(0);
  if (settings_.walls) reach_texels_.bind(kReachUnit);
  gl::dispatch(rays, GL_TEXTURE_FETCH_BARRIER_BIT);
}

}  // namespace panoptes::radiance_cache
