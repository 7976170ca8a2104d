#include "radiance_cache/radiance_cache.h"

#include "radiance_cache/placement.h"
#include "radiance_cache/room.h"

#include <algorithm>
#include <cmath>

namespace panoptes::radiance_cache {

namespace {

// Distances that differ by less than so many octaves have the same volumes in frames that follow each other.
constexpr double kSameDistance = 0.5;

// Whether bounced light is anywhere multiplied by something else than 1.
bool scales(const RadianceCache::Frame& frame) {
  const Settings& s = frame.settings;
  const auto& instances = frame.scene.instances();
  return s.luminance != 1 || s.chrominance != 1 || s.region_count > 0 ||
         std::any_of(instances.begin(), instances.end(), [](const scene::Instance& instance) {
           return instance.indirect_scale != glm::vec2(1);
         });
}

}  // namespace

void RadianceCache::begin(const Frame& frame) {
  runs_ = plan::runs(frame.plan, "radiance_cache");
  if (!runs_) {
    release();
    return;
  }
  settings_ = frame.settings;
  seed_ = frame.seed;
  world_ = &frame.world;
  world_light_ = plan::runs(frame.plan, "cache_world");
  lamps_ = plan::runs(frame.plan, "cache_first_bounce");
  rsm_ = plan::runs(frame.plan, "cache_rsm");
  if (!rsm_) reflective_.release();
  bounces_ = settings_.bounces;
  scaled_ = bounces_ > 0 && scales(frame);
  split_ = world_light_ && bounces_ > 0 &&
           (scaled_ || plan::runs(frame.plan, "pass_diffdir") || plan::runs(frame.plan, "pass_diffind") ||
            plan::runs(frame.plan, "pass_glossdir") || plan::runs(frame.plan, "pass_glossind") ||
            plan::runs(frame.plan, "pass_transdir") || plan::runs(frame.plan, "pass_transind"));
  transmission_ = plan::runs(frame.plan, "transmission");
  occupancy_ = settings_.occupancy;
  if (occupancy_ == Occupancy::kAuto) {
    // Surfaces that nobody sees are lit by cells as well if they are to send that light on, and what
    // rays meet anyway. Cells that do not depend on the camera keep their light while a view turns.
    const bool rays = plan::runs(frame.plan, "specular_rays"), elsewhere = bounces_ > 1 || (world_light_ && bounces_ > 0);
    occupancy_ = rays || (elsewhere && frame.follows) ? Occupancy::kGeometry
                 : elsewhere                          ? Occupancy::kTiers
                                                      : Occupancy::kDepth;
  }
  // Samples of reflective shadow maps are as many in every cell.
  if (rsm_ && occupancy_ == Occupancy::kTiers) occupancy_ = Occupancy::kGeometry;
  camera_ = frame.camera;
  bounds_ = frame.scene.bounds();
  follows_ = frame.follows;
  if (!follows_) {
    history_.release();
    distance_ = 0;
  }
  next_ = state_of(frame);
}

bool RadianceCache::looks_far() const { return runs_ && choose_by_distance(settings_); }

void RadianceCache::place(double distance, const tracing::TriangleList& triangles,
                          const gpu_scene::GpuScene& gpu, gpu_scene::ViewBlock& view_block) {
  if (!runs_) return;
  // A view that turns to and fro does not change its volumes each time.
  if (!(distance_ > 0) || std::abs(std::log2(distance / distance_)) > kSameDistance) distance_ = distance;
  next_.grids = choose_grids(bounds_, camera_, settings_, distance_);
  kept_ = follows_ && lit_ && !stale_ && next_ == state_;
  if (kept_) return;
  stale_ = may_lag(triangles);
  lag_ = stale_ ? lag_ + 1 : 0;
  state_ = std::move(next_);
  lit_ = false;
  grids_ = state_.grids;
  const glm::dvec3 high = grids_.back().low + grids_.back().cell * glm::dvec3(grids_.back().cells);
  whole_ = glm::all(glm::lessThanEqual(grids_.back().low, glm::dvec3(bounds_.low))) &&
           glm::all(glm::greaterThanEqual(high, glm::dvec3(bounds_.high)));
  if (!stale_) update_volume(triangles, gpu, view_block);
  find_seeds();
  for (Tier& tier : tiers_) tier.cells = 0;
  const int64_t texels = int64_t(volume_.volumes().count.y) * cell_texels(settings_.encoding) *
                         (split_ ? 2 : 1);
  want(cells_, cells_texels_, GL_RGBA32F, texels * 16);
}

RadianceCache::State RadianceCache::state_of(const Frame& frame) {
  State state{frame.settings, frame.seed, {}, {}, frame.scene.lights(),
              {frame.gpu.geometry_revision(), frame.gpu.surface_revision(), frame.gpu.world_revision(),
               frame.gpu.emission_revision(), frame.gpu.shadow_revision()}};
  for (const plan::Effect& effect : frame.plan) state.effects.push_back(effect.runs);
  return state;
}

bool RadianceCache::may_lag(const tracing::TriangleList& triangles) const {
  return follows_ && volume_.solid() > 0 && lag_ + 1 < settings_.rebuild_every &&
         next_.settings == state_.settings && next_.grids == state_.grids &&
         list_origin_ == glm::dvec3(triangles.origin());
}

void RadianceCache::update_volume(const tracing::TriangleList& triangles, const gpu_scene::GpuScene& gpu,
                                  gpu_scene::ViewBlock& view_block) {
  list_origin_ = triangles.origin();
  if (volume_.update(grids_, settings_.voxel_fill, triangles, gpu, view_block, programs_, timer_))
    reached_ = false;
  write_block(list_block_, list_origin_);
}

void RadianceCache::catch_up(const tracing::TriangleList& triangles, const gpu_scene::GpuScene& gpu,
                             gpu_scene::ViewBlock& view_block) {
  stale_ = false;
  lag_ = 0;
  update_volume(triangles, gpu, view_block);
  find_seeds();
}

void RadianceCache::release() {
  runs_ = lit_ = kept_ = blended_ = stale_ = false;
  lag_ = 0;
  history_.release();
  reflective_.release();
  grids_.clear();
  volume_.release();
  tiers_ = {};
  for (gl::Texture* texture : {&met_sides_texels_, &radiosity_texels_, &cells_texels_, &seeds_texels_, &reach_texels_})
    *texture = gl::Texture();
  for (gl::Buffer* buffer : {&seeds_, &contents_, &reach_, &met_sides_, &radiosity_, &direct_, &cells_, &list_block_, &view_block_,
                            &scales_block_})
    *buffer = gl::Buffer();
}

}  // namespace panoptes::radiance_cache
