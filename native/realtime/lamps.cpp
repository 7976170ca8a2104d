// Lamps and glowing meshes: their points in a sample, their maps, and what they light.
#include "film/sampling.h"
#include "realtime/realtime.h"
#include "realtime/sample_dimensions.h"

#include <algorithm>

namespace panoptes::realtime {

namespace {

// The points of each lamp of a size that light the cache: more would hardly change its light.
constexpr uint32_t kCachePoints = 8;

void clear(const gl::Texture& texture) {
  const float zero[4] = {0, 0, 0, 0};
  glClearTexImage(texture.id(), 0, GL_RGBA, GL_FLOAT, zero);
}

// Rewrites `buffer`, larger if it must be.
void store(gl::Buffer& buffer, const void* data, size_t bytes) {
  if (buffer.bytes() < int64_t(bytes) || !buffer) buffer = gl::Buffer(int64_t(bytes));
  buffer.write(0, int64_t(bytes), data);
}

}  // namespace

void Realtime::find_cascades(const std::vector<rasterize::Slab>& slabs, const shared::View& view) {
  std::vector<scene::Bounds> cascades = rasterize::choose_cascades(
      slabs, bounds_, view.filtering.y, camera_.perspective(), settings_.shadows.resolution);
  if (cascades != sun_cascades_) shadow_revision_ = -1;
  sun_cascades_ = std::move(cascades);
}

rasterize::LightSet Realtime::place(uint32_t index, const shared::View& view,
                                    const gpu_scene::GpuScene& gpu,
                                    const std::vector<scene::Light>& lamps,
                                    const rasterize::Placement& placement) {
  std::vector<rasterize::LightSamplePoint> points;
  if (soft_)
    for (size_t i = 0; i < lights_.size(); ++i) {
      const uint32_t dimension = kLampDimension + 2 * uint32_t(i);
      const glm::vec2 u = film::sample_point(index, settings_.seed, dimension);
      const glm::vec2 s = film::sample_point(index, settings_.seed, dimension + 1);
      points.push_back({u.x, u.y, lights_[i].extended() ? s - 0.5f : glm::vec2(0)});
    }
  std::vector<rasterize::MeshLight> mesh_lights;
  if (!emitters_.empty()) {
    gl::PassScope scope(timer_, "emissive_light");
    mesh_lights = emitters_.sample(index, {gpu, programs_, view_block_, view});
    view_block_.set(view);
  }
  return rasterize::place_lights(lamps, points, mesh_lights, placement);
}

rasterize::Placement Realtime::placement_of_lamps() const {
  return {.shadows = shadows_,
          .bounds = bounds_,
          .sun_cascades = cascades_ ? sun_cascades_ : std::vector<scene::Bounds>{},
          .camera_origin = glm::inverse(camera_.world_to_camera)[3],
          .resolution = settings_.shadows.resolution,
          .layers = rasterize::ShadowMaps::layer_limit(settings_.shadows, device_)};
}

void Realtime::store_lights(const rasterize::LightSet& set) {
  std::vector<shared::Light> lights;
  for (const rasterize::PlacedLight& placed : set.lights) lights.push_back(placed.light);
  store(lights_buffer_, lights.data(), lights.size() * sizeof(shared::Light));
  store(faces_buffer_, set.faces.data(), set.faces.size() * sizeof(shared::ShadowFace));
}

uint32_t Realtime::cache_points(uint32_t sharing) const {
  const bool many = soft_ || (!emitters_.empty() && !single_);
  // Frames that follow each other show something first.
  return cache_.runs() && many && !settings_.follows ? std::min(sharing, kCachePoints) : 1;
}

void Realtime::light_cache_further(uint32_t points, const shared::View& view, const gpu_scene::GpuScene& gpu,
                                   const std::atomic<bool>& cancelled) {
  for (uint32_t index = 1; index < points; ++index) {
    const rasterize::LightSet set = place(index, view, gpu, lights_, placement_of_lamps());
    store_lights(set);
    for (const rasterize::LightBatch& batch : set.batches) {
      if (shadows_) draw_shadow_maps(set, batch, view, gpu, false, false);
      stop_if(cancelled);
      light_cache(batch, view, points);
    }
  }
}

void Realtime::add_lamps(uint32_t index, const shared::View& view,
                         const gpu_scene::GpuScene& gpu, uint32_t points,
                         const std::atomic<bool>& cancelled) {
  const rasterize::LightSet set = place(index, view, gpu, lights_, placement_of_lamps());
  store_lights(set);
  clear(diffuse_light_);
  if (surfaces_.glossy) clear(glossy_light_);

  // Maps hold for the next sample and frame unless a lamp's point or an alpha threshold moves on,
  // or another batch has overwritten them.
  const bool lasting = !soft_ && (!alpha_ || single_ || filtered_) && set.batches.size() <= 1 &&
                       (emitters_.empty() || single_);
  const bool keep = lasting && shadow_revision_ == gpu.shadow_revision();
  shadow_revision_ = lasting ? gpu.shadow_revision() : -1;
  if (set.batches.empty()) find_occlusion(index, view, nullptr, gpu, cancelled);
  for (const rasterize::LightBatch& batch : set.batches) {
    if (shadows_) draw_shadow_maps(set, batch, view, gpu, lasting, keep);
    stop_if(cancelled);
    if (&batch == &set.batches.front())
      find_occlusion(index, view, shadows_ ? &set : nullptr, gpu, cancelled);
    if (points > 0) light_cache(batch, view, points);
    gl::PassScope scope(timer_, "direct_light");
    const bool rays = specular_rays_.runs() && emissive_light_;
    programs_.get(direct_light_program({shadows_, filtered_, rays, surfaces_})).use();
    g_buffer_.bind_bins();
    g_buffer_.bind_surfaces();
    if (shadows_) shadow_maps_.bind(13);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, lights_buffer_.id());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 4, faces_buffer_.id());
    if (rays) specular_rays_.direct().bind(6);
    diffuse_light_.bind(0);
    diffuse_light_.bind_image(0, GL_WRITE_ONLY);
    if (surfaces_.glossy) glossy_light_.bind(1);
    if (surfaces_.glossy) glossy_light_.bind_image(1, GL_WRITE_ONLY);
    glUniform1ui(2, batch.first_light);
    glUniform1ui(3, batch.light_count);
    g_buffer_.dispatch_surfaces();
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    if (specular_rays_.runs())
      specular_rays_.add_lamps(batch.first_light, batch.light_count, {shadows_, filtered_});
    stop_if(cancelled);
  }
  light_cache_further(points, view, gpu, cancelled);
}

void Realtime::draw_shadow_maps(const rasterize::LightSet& set, const rasterize::LightBatch& batch,
                                const shared::View& view, const gpu_scene::GpuScene& gpu,
                                bool lasting, bool keep) {
  shared::View from = view;
  if (lasting) from.size.z = 0;  // alpha thresholds are those of the picture's first sample
  shadow_maps_.render(set, batch, settings_.shadows, from, gpu, programs_, timer_, view_block_, keep);
  view_block_.set(view);
}

void Realtime::light_cache(const rasterize::LightBatch& batch, const shared::View& view, uint32_t points) {
  cache_.add_lamps({.origin = glm::dvec3(glm::vec3(view.world_origin)),
                    .shadows = shadows_,
                    .share = 1.0f / float(points),
                    .first = batch.first_light,
                    .count = batch.light_count,
                    .lights = lights_buffer_,
                    .faces = faces_buffer_,
                    .bind_maps = [this](int unit) { shadow_maps_.bind(unit); }});
}

void Realtime::gather_cache(const shared::View& view, const gpu_scene::GpuScene& gpu,
                            const std::atomic<bool>& cancelled) {
  if (cache_.reflective()) {
    rasterize::Placement placement = placement_of_lamps();
    placement.shadows = true;  // since maps are drawn by the views of shadow maps
    placement.sun_cascades.clear();
    placement.resolution = settings_.cache.rsm_resolution;
    std::vector<scene::Light> lamps = lights_;
    for (scene::Light& lamp : lamps) lamp.cast_shadow = true;
    cache_.reflect_lamps({.set = place(0, view, gpu, lamps, placement),
                          .origin = placement.camera_origin,
                          .camera = view,
                          .gpu = gpu,
                          .view_block = view_block_,
                          .cancelled = cancelled});
    view_block_.set(view);
  }
  cache_.gather();
}

}  // namespace panoptes::realtime
