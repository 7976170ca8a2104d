// The light of the radiance cache's cells: what lamps send to surfels, and bounces from there.
#include "gl/dispatch.h"
#include "radiance_cache/bindings.h"
#include "radiance_cache/radiance_cache.h"
#include "radiance_cache/room.h"

#include <algorithm>

namespace panoptes::radiance_cache {

namespace {

// How far before surfels their shadows are looked up, in voxels. None leaves lit walls of several faces
// up to a tenth too dark, a whole one lets light around thin columns.
constexpr float kShadowsBefore = 0.75f;

}  // namespace

void RadianceCache::begin_lamps() {
  if (!lamps_ || kept_) return;
  want(direct_, std::max(int64_t(volume_.solid()), int64_t(1)) * 2 * 16);
  direct_.clear();
}

void RadianceCache::add_lamps(const Lamps& lamps) {
  if (!lamps_ || kept_ || volume_.solid() == 0) return;
  gl::PassScope scope(timer_, "cache_first_bounce");
  programs_.get(light_surfels_program(lamps.shadows, met_alone())).use();
  bind_volume();
  if (met_alone()) met_sides_texels_.bind(kMetSidesUnit);
  if (lamps.shadows) lamps.bind_maps(13);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, direct_.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, lamps.lights.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 4, lamps.faces.id());
  const glm::vec3 offset(list_origin_ - lamps.origin);
  glUniform1ui(0, volume_.solid());
  glUniform1ui(2, lamps.first);
  glUniform1ui(3, lamps.count);
  glUniform3f(4, offset.x, offset.y, offset.z);
  glUniform1f(5, kShadowsBefore * float(voxel()));
  glUniform1f(6, lamps.share);
  gl::dispatch(volume_.solid(), GL_SHADER_STORAGE_BARRIER_BIT);
}

void RadianceCache::reflect_lamps(const ReflectiveMaps::Lamps& lamps) {
  uint32_t longest = 0;  // a ray passes each plane between voxels once
  for (const Grid& grid : grids_)
    longest += uint32_t((grid.cells.x + grid.cells.y + grid.cells.z) * grid.voxels);
  const auto bind = [this] {
    bind_volume();
    bind_lattice(1);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, tiers_[0].list.id());
    seeds_texels_.bind(0);
    if (settings_.walls) reach_texels_.bind(kReachUnit);
  };
  reflective_.update(lamps, {tiers_[0].cells, list_origin_, longest, seed_, bind}, settings_);
}

void RadianceCache::gather() {
  blended_ = false;
  if (kept_) {
    remember(0);
    return;
  }
  cells_.clear();  // cells that are not listed hold no light
  lit_ = true;
  if (occupied().cells == 0) return;
  if (world_light_) gather_rays(false, false);
  for (int i = 0; i < bounces_; ++i) {
    const bool cache = world_light_ || i > 0, surfels = cache || lamps_;
    if (!surfels && !rsm_) break;
    if (surfels) bounce(cache);
    gather_rays(surfels, rsm_);
  }
  remember(settings_.blend);
  blended_ = follows_ && settings_.blend > 0;
}

void RadianceCache::remember(float share) {
  if (!follows_ || settings_.blend <= 0) return;
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  history_.add({cells_, cells_texels_, settings_.encoding, split_, grids_, volume_.volumes(), list_block_,
                tiers_[0].list, tiers_[0].cells},
               share);
}

void RadianceCache::bounce(bool cache) {
  gl::PassScope scope(timer_, cache ? "cache_bounces" : "cache_first_bounce");
  const uint32_t sides = volume_.solid() * 2;
  want(radiosity_, radiosity_texels_, GL_R32UI, std::max(int64_t(sides), int64_t(1)) * 4);
  if (sides == 0) return;
  const LookUpOptions options = look_up(kCellsUnit, kCellsBlock);
  programs_.get(bounce_program(options, lamps_, cache, met_alone())).use();
  bind_volume();
  if (met_alone()) met_sides_texels_.bind(kMetSidesUnit);
  if (cache) {
    cells_texels_.bind(options.unit);
    if (options.walls) reach_texels_.bind(options.unit + 3);
    glBindBufferBase(GL_UNIFORM_BUFFER, GLuint(options.block), list_block_.id());
  }
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, radiosity_.id());
  if (lamps_) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, direct_.id());
  glUniform1ui(0, volume_.solid());
  gl::dispatch(sides, GL_TEXTURE_FETCH_BARRIER_BIT);
}

void RadianceCache::gather_rays(bool bounced, bool reflected) {
  gl::PassScope scope(timer_, "radiance_cache_gather");
  for (const Tier& tier : tiers_) gather_rays(tier, bounced, reflected);
}

void RadianceCache::gather_rays(const Tier& tier, bool bounced, bool reflected) {
  if (tier.cells == 0) return;
  programs_.get(gather_program({settings_.encoding, split_, world_light_, bounced, reflected})).use();
  tier.met_texels.bind(0);
  if (bounced) radiosity_texels_.bind(1);
  if (world_light_) world_->map(tiers_[0].directions).bind(2);
  seeds_texels_.bind(3);
  if (reflected) reflective_.light().bind(6);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, cells_.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, tier.list.id());
  glBindBufferBase(GL_UNIFORM_BUFFER, kCellsBlock, list_block_.id());
  glUniform3ui(0, tier.cells, unsigned(tier.directions), seed_);
  bind_lattice(1);
  gl::dispatch(tier.cells, GL_TEXTURE_FETCH_BARRIER_BIT);
}

}  // namespace panoptes::radiance_cache
