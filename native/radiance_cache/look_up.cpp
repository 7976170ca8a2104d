// Where programs look the radiance cache up.
#include "radiance_cache/bindings.h"
#include "radiance_cache/radiance_cache.h"
#include "radiance_cache/scales_shared.h"

#include <glm/gtc/matrix_transform.hpp>

namespace panoptes::radiance_cache {

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
