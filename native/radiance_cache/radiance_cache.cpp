#include "radiance_cache/radiance_cache.h"

#include "gl/dispatch.h"
#include "radiance_cache/bindings.h"
#include "radiance_cache/placement.h"
#include "radiance_cache/scales_shared.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace panoptes::radiance_cache {

namespace {

// Squares of pixels along the shorter side of a picture that tell which cells are seen, if it has so many.
constexpr int kLeastSquares = 60;

// How far before surfels their shadows are looked up, in voxels. None leaves lit walls of several faces
// up to a tenth too dark, a whole one lets light around thin columns.
constexpr float kShadowsBefore = 0.5f;

// A buffer of at least `bytes`, with room to spare so that it is not made anew each time.
void want(gl::Buffer& buffer, int64_t bytes) {
  if (!buffer || buffer.bytes() < bytes) {
    buffer = gl::Buffer();
    buffer = gl::Buffer(bytes + bytes / 4);
  }
}

void want(gl::Buffer& buffer, gl::Texture& texels, GLenum format, int64_t bytes) {
  if (buffer && buffer.bytes() >= bytes) return;
  texels = gl::Texture();
  want(buffer, bytes);
  texels = gl::Texture(format, buffer);
}

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
  const std::vector<Grid> grids = choose_grids(frame.scene.bounds(), frame.camera, settings_);
  State state = state_of(frame, grids);
  kept_ = frame.follows && lit_ && !stale_ && state == state_;
  follows_ = frame.follows;
  if (!follows_) history_.release();
  if (kept_) return;
  stale_ = may_lag(frame, state);
  lag_ = stale_ ? lag_ + 1 : 0;
  state_ = std::move(state);
  lit_ = false;
  grids_ = grids;
  const glm::dvec3 high = grids_.back().low + grids_.back().cell * glm::dvec3(grids_.back().cells);
  whole_ = glm::all(glm::lessThanEqual(grids_.back().low, glm::dvec3(frame.scene.bounds().low))) &&
           glm::all(glm::greaterThanEqual(high, glm::dvec3(frame.scene.bounds().high)));
  transmission_ = plan::runs(frame.plan, "transmission");
  occupancy_ = settings_.occupancy;
  if (occupancy_ == Occupancy::kAuto) {
    // Surfaces that nobody sees are lit by cells as well if they are to send that light on, and what
    // rays meet anyway.
    const bool elsewhere = bounces_ > 1 || (world_light_ && bounces_ > 0) ||
                           plan::runs(frame.plan, "specular_rays");
    occupancy_ = elsewhere ? Occupancy::kGeometry : Occupancy::kDepth;
  }
  if (!stale_) update_volume(frame.triangles, frame.gpu, frame.view_block);
  find_seeds();
  active_ = 0;
  const int64_t texels = int64_t(volume_.volumes().count.y) * cell_texels(settings_.encoding) *
                         (split_ ? 2 : 1);
  want(cells_, cells_texels_, GL_RGBA32F, texels * 16);
}

RadianceCache::State RadianceCache::state_of(const Frame& frame, const std::vector<Grid>& grids) {
  State state{frame.settings, frame.seed, {}, grids, frame.scene.lights(),
              {frame.gpu.geometry_revision(), frame.gpu.surface_revision(), frame.gpu.world_revision(),
               frame.gpu.emission_revision(), frame.gpu.shadow_revision()}};
  for (const plan::Effect& effect : frame.plan) state.effects.push_back(effect.runs);
  return state;
}

bool RadianceCache::may_lag(const Frame& frame, const State& state) const {
  return frame.follows && volume_.solid() > 0 && lag_ + 1 < settings_.rebuild_every &&
         state.settings == state_.settings && state.grids == state_.grids &&
         list_origin_ == glm::dvec3(frame.triangles.origin());
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
  for (gl::Texture* texture : {&met_texels_, &radiosity_texels_, &cells_texels_, &seeds_texels_, &reach_texels_}) *texture = gl::Texture();
  for (gl::Buffer* buffer : {&list_, &seeds_, &reach_, &met_, &radiosity_, &direct_, &cells_, &list_block_, &view_block_,
                            &scales_block_})
    *buffer = gl::Buffer();
}

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

void RadianceCache::begin_lamps() {
  if (!lamps_ || kept_) return;
  want(direct_, std::max(int64_t(volume_.solid()), int64_t(1)) * 2 * 16);
  direct_.clear();
}

void RadianceCache::add_lamps(const Lamps& lamps) {
  if (!lamps_ || kept_ || volume_.solid() == 0) return;
  gl::PassScope scope(timer_, "cache_first_bounce");
  programs_.get(light_surfels_program(lamps.shadows)).use();
  bind_volume();
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
  gl::dispatch(volume_.solid(), GL_SHADER_STORAGE_BARRIER_BIT);
}

void RadianceCache::reflect_lamps(const ReflectiveMaps::Lamps& lamps) {
  uint32_t longest = 0;  // a ray passes each plane between voxels once
  for (const Grid& grid : grids_)
    longest += uint32_t((grid.cells.x + grid.cells.y + grid.cells.z) * grid.voxels);
  const auto bind = [this] {
    bind_volume();
    bind_lattice(1);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, list_.id());
    seeds_texels_.bind(0);
    if (settings_.walls) reach_texels_.bind(kReachUnit);
  };
  reflective_.update(lamps, {active_, list_origin_, longest, seed_, bind}, settings_);
}

void RadianceCache::gather() {
  blended_ = false;
  if (kept_) {
    remember(0);
    return;
  }
  cells_.clear();  // cells that are not listed hold no light
  lit_ = true;
  if (active_ == 0) return;
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
                list_, active_},
               share);
}

void RadianceCache::bounce(bool cache) {
  gl::PassScope scope(timer_, cache ? "cache_bounces" : "cache_first_bounce");
  const uint32_t sides = volume_.solid() * 2;
  want(radiosity_, radiosity_texels_, GL_R32UI, std::max(int64_t(sides), int64_t(1)) * 4);
  if (sides == 0) return;
  const LookUpOptions options = look_up(kCellsUnit, kCellsBlock);
  programs_.get(bounce_program(options, lamps_, cache)).use();
  bind_volume();
  if (cache) {
    cells_texels_.bind(options.unit);
    if (options.walls) reach_texels_.bind(options.unit + 3);
    glBindBufferBase(GL_UNIFORM_BUFFER, GLuint(options.block), list_block_.id());
  }
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, radiosity_.id());
  if (lamps_) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, direct_.id());
  glUniform1ui(0, sides);
  gl::dispatch(sides, GL_TEXTURE_FETCH_BARRIER_BIT);
}

void RadianceCache::gather_rays(bool bounced, bool reflected) {
  gl::PassScope scope(timer_, "radiance_cache_gather");
  programs_.get(gather_program({settings_.encoding, split_, world_light_, bounced, reflected})).use();
  met_texels_.bind(0);
  if (bounced) radiosity_texels_.bind(1);
  if (world_light_) world_->map(directions_).bind(2);
  seeds_texels_.bind(3);
  if (reflected) reflective_.light().bind(6);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, cells_.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, list_.id());
  glBindBufferBase(GL_UNIFORM_BUFFER, kCellsBlock, list_block_.id());
  glUniform3ui(0, active_, unsigned(directions_), seed_);
  bind_lattice(1);
  gl::dispatch(active_, GL_TEXTURE_FETCH_BARRIER_BIT);
}

void RadianceCache::write_block(gl::Buffer& block, const glm::dvec3& origin) const {
  shared::CacheVolumes volumes = volume_.volumes();
  for (size_t v = 0; v < grids_.size(); ++v)
    volumes.volumes[v].low =
        glm::vec4(glm::vec3(grids_[v].low - origin), volumes.volumes[v].low.w);
  volumes.count.w = whole_;
  if (!block) block = gl::Buffer(int64_t(sizeof volumes));
  block.write(0, int64_t(sizeof volumes), &volumes);
}

LookUpOptions RadianceCache::look_up(int unit, int block) const {
  return {settings_.encoding, split_, scaled_, unit, block, settings_.walls};
}

void RadianceCache::bind(const LookUpOptions& options, const gpu_scene::GpuScene& gpu,
                         const glm::dvec3& origin) {
  write_block(view_block_, origin);
  shown().bind(options.unit);
  if (options.walls) reach_texels_.bind(options.unit + 3);
  glBindBufferBase(GL_UNIFORM_BUFFER, GLuint(options.block), view_block_.id());
  if (options.scaled) bind_scales(options, gpu, origin);
}

void RadianceCache::bind_scales(const LookUpOptions& options, const gpu_scene::GpuScene& gpu,
                                const glm::dvec3& origin) {
  shared::CacheScales scales{};
  scales.scale = {settings_.luminance, settings_.chrominance, 0, 0};
  scales.count.x = settings_.region_count;
  for (int i = 0; i < settings_.region_count; ++i) {
    const Region& region = settings_.regions[size_t(i)];
    scales.regions[i] = {glm::mat4(glm::translate(region.world_to_box, origin)),
                         {region.luminance, region.chrominance, 0, 0}};
  }
  scales_block_.reserve(sizeof scales);
  scales_block_.write(0, sizeof scales, &scales);
  glBindBufferBase(GL_UNIFORM_BUFFER, GLuint(options.block) + 1, scales_block_.id());
  gpu.bind_instances(options.unit + 2);
}

void RadianceCache::show(const LookUpOptions& options, const glm::dvec3& origin,
                         const film::Film& film) {
  gl::PassScope scope(timer_, "radiance_cache_picture");
  programs_.get(picture_program(settings_.picture, options, film)).use();
  bind_volume();
  write_block(view_block_, origin);
  shown().bind(options.unit);
  if (options.walls) reach_texels_.bind(options.unit + 3);
  glBindBufferBase(GL_UNIFORM_BUFFER, GLuint(options.block), view_block_.id());
  seeds_texels_.bind(0);
  const glm::vec3 offset(origin - list_origin_);
  glUniform3f(2, offset.x, offset.y, offset.z);
  film.bind();
}

}  // namespace panoptes::radiance_cache
