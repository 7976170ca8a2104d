#include "radiance_cache/radiance_cache.h"

#include "gl/dispatch.h"
#include "radiance_cache/bindings.h"
#include "radiance_cache/placement.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace panoptes::radiance_cache {

namespace {

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
  bounces_ = settings_.bounces;
  split_ = world_light_ && bounces_ > 0 &&
           (plan::runs(frame.plan, "pass_diffdir") || plan::runs(frame.plan, "pass_diffind") ||
            plan::runs(frame.plan, "pass_glossdir") || plan::runs(frame.plan, "pass_glossind"));
  list_origin_ = frame.triangles.origin();
  grids_ = choose_grids(frame.scene.bounds(), frame.camera, settings_);
  volume_.update(grids_, settings_.voxel_fill, frame.triangles, frame.gpu, frame.view_block,
                 programs_, timer_);
  write_block(list_block_, list_origin_);
  list_cells();
  march();
  if (getenv("RCDBG")) { printf("cells %d active %u solid %u layers %d grid %d %d %d cell %g bounces %d world %d lamps %d split %d\n", volume_.volumes().count.y, active_, volume_.solid(), 0, grids_[0].cells.x, grids_[0].cells.y, grids_[0].cells.z, grids_[0].cell, bounces_, world_light_, lamps_, split_); std::vector<uint32_t> m(size_t(active_)*settings_.directions); if (active_) met_.read(0, m.size()*4, m.data()); size_t lost=0, miss=0; for (auto x : m) { lost += x==0xfffffffeu; miss += x==0xffffffffu; } printf("rays %zu lost %zu miss %zu\n", m.size(), lost, miss); }
  glm::ivec3 size(0);
  for (const Grid& grid : grids_)
    size = {std::max(size.x, grid.cells.x), std::max(size.y, grid.cells.y), size.z + grid.cells.z};
  size.x *= split_ ? 2 : 1;
  size.z *= cell_texels(settings_.encoding);
  const gl::TextureOptions wanted{GL_TEXTURE_3D, GL_RGBA32F, size.x, size.y, size.z, 1};
  if (!cells_ || cells_.options().width != size.x || cells_.options().height != size.y ||
      cells_.options().layers != size.z) {
    cells_ = gl::Texture();
    cells_ = gl::Texture(wanted);
  }
  if (!linear_) linear_ = gl::Sampler(gl::SamplerOptions{});
}

void RadianceCache::release() {
  runs_ = false;
  grids_.clear();
  volume_.release();
  for (gl::Texture* texture : {&met_texels_, &radiosity_texels_, &cells_}) *texture = gl::Texture();
  for (gl::Buffer* buffer : {&list_, &met_, &radiosity_, &direct_, &list_block_, &view_block_})
    *buffer = gl::Buffer();
}

void RadianceCache::list_cells() {
  gl::PassScope scope(timer_, "radiance_cache_cells");
  const int64_t cells = volume_.volumes().count.y;
  want(list_, cells * 4);
  gl::Buffer counter(4);
  counter.clear();
  programs_.get(list_cells_program(settings_.dilate)).use();
  bind_volume();
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, list_.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, counter.id());
  gl::dispatch(uint32_t(cells), GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  counter.read(0, 4, &active_);
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
  const uint32_t rays = active_ * uint32_t(settings_.directions);
  want(met_, met_texels_, GL_R32UI, std::max(int64_t(rays), int64_t(1)) * 4);
  if (rays == 0) return;
  programs_.get(march_program(settings_.march_steps)).use();
  bind_volume();
  glUniform3ui(0, active_, unsigned(settings_.directions), seed_);
  bind_lattice(1);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, list_.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, met_.id());
  gl::dispatch(rays, GL_TEXTURE_FETCH_BARRIER_BIT);
}

void RadianceCache::begin_lamps() {
  if (!lamps_) return;
  want(direct_, std::max(int64_t(volume_.solid()), int64_t(1)) * 2 * 16);
  direct_.clear();
}

void RadianceCache::add_lamps(const Lamps& lamps) {
  if (!lamps_ || volume_.solid() == 0) return;
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
  gl::dispatch(volume_.solid(), GL_SHADER_STORAGE_BARRIER_BIT);
}

void RadianceCache::gather() {
  const float none[4] = {0, 0, 0, 0};
  glClearTexImage(cells_.id(), 0, GL_RGBA, GL_FLOAT, none);
  if (active_ == 0) return;
  if (world_light_) gather_rays(false);
  for (int i = 0; i < bounces_; ++i) {
    const bool cache = world_light_ || i > 0;
    if (!cache && !lamps_) break;
    bounce(cache);
    gather_rays(true);
  }
}

static void dump(const gl::Texture& t);
void RadianceCache::bounce(bool cache) {
  gl::PassScope scope(timer_, cache ? "cache_bounces" : "cache_first_bounce");
  const uint32_t sides = volume_.solid() * 2;
  want(radiosity_, radiosity_texels_, GL_R32UI, std::max(int64_t(sides), int64_t(1)) * 4);
  if (sides == 0) return;
  const LookUpOptions options = look_up(kCellsUnit, kCellsBlock);
  programs_.get(bounce_program(options, lamps_, cache)).use();
  bind_volume();
  if (cache) {
    cells_.bind(options.unit);
    linear_.bind(options.unit);
    glBindBufferBase(GL_UNIFORM_BUFFER, GLuint(options.block), list_block_.id());
  }
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, radiosity_.id());
  if (lamps_) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, direct_.id());
  glUniform1ui(0, sides);
  gl::dispatch(sides, GL_TEXTURE_FETCH_BARRIER_BIT);
  glBindSampler(GLuint(options.unit), 0);
}

void RadianceCache::gather_rays(bool bounced) {
  gl::PassScope scope(timer_, "radiance_cache_gather");
  programs_.get(gather_program({settings_.encoding, split_, world_light_, bounced})).use();
  met_texels_.bind(0);
  if (bounced) radiosity_texels_.bind(1);
  if (world_light_) world_->map(settings_.directions).bind(2);
  cells_.bind_image(0, GL_WRITE_ONLY);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, list_.id());
  glBindBufferBase(GL_UNIFORM_BUFFER, kCellsBlock, list_block_.id());
  glUniform3ui(0, active_, unsigned(settings_.directions), seed_);
  bind_lattice(1);
  gl::dispatch(active_, GL_TEXTURE_FETCH_BARRIER_BIT);
  if (getenv("RCDBG")) dump(cells_);
}

[[maybe_unused]] static void dump(const gl::Texture& t) {
  std::vector<float> v(size_t(t.options().width)*t.options().height*t.options().layers*4);
  glGetTextureImage(t.id(), 0, GL_RGBA, GL_FLOAT, GLsizei(v.size()*4), v.data());
  double sum=0, mx=0; for (float f : v) { sum += std::abs(f); mx = std::max(mx, double(std::abs(f))); }
  printf("cells %dx%dx%d sum %g max %g\n", t.options().width, t.options().height, t.options().layers, sum, mx);
}

void RadianceCache::write_block(gl::Buffer& block, const glm::dvec3& origin) const {
  shared::CacheVolumes volumes = volume_.volumes();
  int layers = 0;
  for (size_t v = 0; v < grids_.size(); ++v) {
    volumes.volumes[v].low =
        glm::vec4(glm::vec3(grids_[v].low - origin), volumes.volumes[v].low.w);
    volumes.volumes[v].first.w = layers;
    layers += grids_[v].cells.z;
  }
  volumes.count.w = layers;
  if (!block) block = gl::Buffer(int64_t(sizeof volumes));
  block.write(0, int64_t(sizeof volumes), &volumes);
}

LookUpOptions RadianceCache::look_up(int unit, int block) const {
  return {settings_.encoding, split_, unit, block};
}

void RadianceCache::bind(const LookUpOptions& options, const glm::dvec3& origin) {
  write_block(view_block_, origin);
  cells_.bind(options.unit);
  linear_.bind(options.unit);
  glBindBufferBase(GL_UNIFORM_BUFFER, GLuint(options.block), view_block_.id());
}

}  // namespace panoptes::radiance_cache
