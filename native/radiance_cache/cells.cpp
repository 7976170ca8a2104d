// Which cells of the radiance cache hold light, and what their rays meet.
#include "gl/dispatch.h"
#include "radiance_cache/bindings.h"
#include "radiance_cache/radiance_cache.h"
#include "radiance_cache/room.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace panoptes::radiance_cache {

namespace {

// Squares of pixels along the shorter side of a picture that tell which cells are seen, if it has so many.
constexpr int kLeastSquares = 60;

// What part of the directions the cells of a tier look in. The light of those that nobody sees is met by the
// rays of many others before it is seen, so that its noise is averaged.
constexpr std::array<int, 2> kShares{1, 3};
constexpr int kLeastDirections = 8;

}  // namespace

void RadianceCache::find_seeds() {
  const uint32_t cells = uint32_t(volume_.volumes().count.y);
  want(seeds_, seeds_texels_, GL_R32UI, int64_t(cells) * 4);
  want(contents_, int64_t(cells) * 8);
  if (!settings_.walls) {
    reach_texels_ = gl::Texture();
    reach_ = gl::Buffer();
    reached_ = false;
  }
  // Where only part of the scene moves, the rest is reached by what it was.
  const bool anew = !reach_ || reach_grids_ != grids_;
  {
    gl::PassScope scope(timer_, "radiance_cache_seeds");
    programs_.get(find_seeds_program()).use();
    bind_volume();
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, seeds_.id());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, contents_.id());
    glUniform1i(0, anew);
    gl::dispatch(cells, GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
  }
  if (settings_.walls && (anew || !reached_)) find_reach();
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
  reach_grids_ = grids_;
}

void RadianceCache::list_cells() {
  gl::PassScope scope(timer_, "radiance_cache_cells");
  const uint32_t cells = uint32_t(volume_.volumes().count.y);
  const size_t tiers = occupancy_ == Occupancy::kTiers ? tiers_.size() : 1;
  for (size_t i = 0; i < tiers_.size(); ++i) {
    if (i < tiers)
      want(tiers_[i].list, int64_t(cells) * 4);
    else
      tiers_[i] = Tier();
  }
  std::array<uint32_t, 2> counts{};
  gl::Buffer counters(int64_t(sizeof counts));
  counters.clear();
  programs_.get(list_cells_program(occupancy_, settings_.dilate)).use();
  bind_volume();
  seeds_texels_.bind(0);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, tiers_[0].list.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, counters.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, seeds_.id());
  for (size_t i = 1; i < tiers; ++i) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, GLuint(2 + i), tiers_[i].list.id());
  gl::dispatch(cells, GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  counters.read(0, int64_t(sizeof counts), counts.data());
  for (size_t i = 0; i < tiers_.size(); ++i) tiers_[i].cells = counts[i];
  choose_directions();
}

void RadianceCache::choose_directions() {
  int64_t rays = 0;
  for (size_t i = 0; i < tiers_.size(); ++i) {
    const int fewer = std::max(settings_.directions / kShares[i], kLeastDirections);
    tiers_[i].directions = std::min(fewer, settings_.directions);
    rays += int64_t(tiers_[i].cells) * tiers_[i].directions;
  }
  if (rays <= settings_.most_rays) return;
  for (Tier& tier : tiers_)
    tier.directions = std::max(int(tier.directions * settings_.most_rays / rays), 1);
}

Occupied RadianceCache::occupied_cells() const {
  Occupied found{0, volume_.volumes().count.y, 0};
  for (const Tier& tier : tiers_) {
    found.cells += tier.cells;
    if (&tier != &tiers_[0]) found.fewer += tier.cells;
  }
  return found;
}

std::string RadianceCache::warning() const {
  if (!runs_ || tiers_[0].directions == settings_.directions) return {};
  return fmt::format("{} cells of indirect light look in {} directions each instead of {}, or there would be too many "
                     "rays: choose a lower Resolution or fewer Cascades",
                     int64_t(occupied().cells), tiers_[0].directions, settings_.directions);
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
  if (met_alone()) {
    want(met_sides_, met_sides_texels_, GL_R32UI, std::max(int64_t(volume_.solid()), int64_t(1)) * 2 * 4);
    met_sides_.clear();
  }
  for (Tier& tier : tiers_) march(tier);
}

void RadianceCache::march(Tier& tier) {
  const uint32_t rays = tier.cells * uint32_t(tier.directions);
  if (rays == 0) return;
  want(tier.met, tier.met_texels, GL_R32UI, int64_t(rays) * 4);
  programs_.get(march_program(settings_.march_steps, settings_.walls, met_alone())).use();
  bind_volume();
  glUniform3ui(0, tier.cells, unsigned(tier.directions), seed_);
  bind_lattice(1);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, tier.list.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, tier.met.id());
  if (met_alone()) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, met_sides_.id());
  seeds_texels_.bind(0);
  if (settings_.walls) reach_texels_.bind(kReachUnit);
  gl::dispatch(rays, GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}

}  // namespace panoptes::radiance_cache
