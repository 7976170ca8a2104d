// The waves of one sample: what becomes of paths between the camera and the film.
#include "gl/dispatch.h"
#include "gpu_scene/units.h"
#include "path_tracer/bindings.h"
#include "path_tracer/path_tracer.h"

namespace panoptes::path_tracer {

void PathTracer::trace(uint32_t count, const gl::Buffer* listed, float threshold,
                       const Surroundings& around) {
  gl::PassScope scope(timer_, "path_rays");
  tracing::OpacityBatch batch;
  batch.rays = &rays_buffer_;
  batch.hits = &hits_;
  batch.count = count;
  batch.listed = listed;
  batch.passed = &passed_;
  batch.most_layers = uint32_t(settings_.paths.bounces.transparent) + 1;
  batch.threshold = threshold;
  opacity_.trace(around.tracer, around.triangles, around.scene, batch,
                 tracing::OpacityMode::kClosest, false, programs_);
  rays_ += opacity_.rays();
}

// Positions are about the list's origin, images are read at their finest level.
void PathTracer::set_list_view() {
  shared::View view{};
  view.world_origin = glm::vec4(glm::vec3(list_origin_), 0);
  view.filtering = {-64.0f, 0, camera_.perspective() ? 1.0f : 0.0f, 0};
  list_block_.set(view);
}

void PathTracer::fetch(const Surroundings& around) {
  gl::PassScope scope(timer_, "path_surfaces");
  set_list_view();
  const std::vector<uint32_t>& counts = bins_.counts();
  uint32_t first = 0;
  for (size_t m = 0; m + 1 < counts.size(); first += counts[m++]) {
    if (counts[m] == 0) continue;
    const gpu_scene::GpuMaterial& material = around.scene.materials()[m];
    programs_.get(fetch_program(material, options_)).use();
    around.scene.bind_geometry();
    around.scene.bind_shading(material);
    around.triangles.texture().bind(gpu_scene::kFreeUnit);
    bind(0, rays_buffer_);
    bind(1, hits_);
    bind(2, states_);
    bind(3, bins_.sorted());
    bind(4, records_);
    glUniform2ui(1, first, counts[m]);
    gl::dispatch(counts[m], kBarriers);
  }
}

void PathTracer::miss(uint32_t first, uint32_t count, const Surroundings& around) {
  const auto& world = around.scene.world();
  if (count == 0 || !(world || lights_.any() || options_.transparent_film)) return;
  gl::PassScope scope(timer_, "path_world");
  programs_.get(miss_program(world ? &*world : nullptr, options_)).use();
  if (world) around.scene.bind_shading(*world);
  if (lights_.any()) lights_.bind();
  bind_texels(sums_texels_, kSumsUnit);
  bind_texels(rays_texels_, kRaysUnit);
  bind_texels(states_texels_, kStatesUnit);
  bind(0, bins_.sorted());
  bind(1, passed_);
  bind(6, sums_);
  glUniform2ui(1, first, count);
  gl::dispatch(count, kBarriers);
}

PathTracer::Sent PathTracer::shade(uint32_t count, uint32_t depth) {
  if (count == 0) return {};
  gl::PassScope scope(timer_, "path_shading");
  counters_.clear();
  programs_.get(shade_program(options_)).use();
  if (lights_.any()) lights_.bind();
  bind_texels(sums_texels_, kSumsUnit);
  bind_texels(rays_texels_, kRaysUnit);
  bind_texels(hits_texels_, kHitsUnit);
  bind_texels(states_texels_, kStatesUnit);
  bind_texels(records_texels_, kRecordsUnit);
  bind_texels(passed_texels_, kPassedUnit);
  bind(0, rays_buffer_);
  bind(1, states_);
  bind(2, counters_);
  bind(11, going_);
  bind(12, passed_);
  bind(6, sums_);
  if (lights_.any()) {
    bind(5, shadow_rays_);
    bind(7, shadow_list_);
    bind(8, arrivals_);
    bind(9, shadow_passed_);
    bind(13, lit_list_);
    if (options_.light_passes) bind(10, shares_);
  }
  glUniform1ui(0, count);
  glUniform1ui(1, depth);
  if (options_.shadow_maps) {
    map_shadows_.bind();
    glUniform1ui(2, map_shadows_.mapped());
  }
  gl::dispatch(count, kBarriers);
  Sent sent;
  counters_.read(0, sizeof sent, &sent);
  return sent;
}

void PathTracer::trace_shadows(uint32_t count, const Surroundings& around) {
  if (count == 0) return;
  tracing::OpacityBatch batch;
  batch.rays = &shadow_rays_;
  batch.hits = &shadow_hits_;
  batch.count = count;
  batch.listed = &shadow_list_;
  batch.passed = &shadow_passed_;
  batch.most_layers = uint32_t(settings_.paths.bounces.transparent);
  opacity_.trace(around.tracer, around.triangles, around.scene, batch,
                 options_.alpha ? tracing::OpacityMode::kTransmittance : tracing::OpacityMode::kAnyHit,
                 false, programs_);
  rays_ += opacity_.rays();
}

void PathTracer::bind_arrivals(const gl::Buffer& listed) const {
  bind(1, arrivals_);
  bind(2, listed);
  if (options_.light_passes) bind(3, shares_);
  bind(6, sums_);
}

void PathTracer::arrive(uint32_t count, bool traced) {
  if (count == 0) return;
  programs_.get(arrive_program(options_, traced)).use();
  bind_texels(sums_texels_, kSumsUnit);
  bind_arrivals(traced ? shadow_list_ : lit_list_);
  bind(0, shadow_hits_);
  if (options_.alpha) bind(4, shadow_passed_);
  if (options_.deferred) {
    counters_.clear();
    bind(5, deferred_);
    bind(7, counters_);
  }
  glUniform1ui(0, count);
  gl::dispatch(count, kBarriers);
}

void PathTracer::arrive_deferred(const Surroundings& around) {
  uint32_t waiting = 0;
  counters_.read(0, 4, &waiting);
  if (waiting == 0) return;
  const auto materials = uint32_t(around.scene.materials().size());
  bins_.sort({shadow_hits_, waiting, &deferred_, false}, materials, around.triangles, programs_);
  uint32_t first = 0;
  for (size_t m = 0; m <= materials; first += bins_.counts()[m++]) {
    const uint32_t rays = bins_.counts()[m];
    if (rays == 0) continue;
    if (m == materials) {
      programs_.get(arrive_world_program(*around.scene.world(), options_)).use();
      around.scene.bind_shading(*around.scene.world());
      bind_texels(sums_texels_, kSumsUnit);
    } else {
      const gpu_scene::GpuMaterial& material = around.scene.materials()[m];
      programs_.get(arrive_emitter_program(material, options_)).use();
      around.scene.bind_geometry();
      around.scene.bind_shading(material);
      around.triangles.texture().bind(gpu_scene::kFreeUnit);
      set_list_view();
    }
    bind(0, shadow_rays_);
    bind_arrivals(bins_.sorted());
    glUniform2ui(1, first, rays);
    gl::dispatch(rays, kBarriers);
  }
}

void PathTracer::ambient_occlusion(uint32_t count, const Surroundings& around) {
  if (count == 0) return;
  gl::PassScope scope(timer_, "pass_ao");
  counters_.clear();
  programs_.get(occlusion_rays_program(options_)).use();
  bind_texels(rays_texels_, kRaysUnit);
  bind_texels(records_texels_, kRecordsUnit);
  bind(0, shadow_rays_);
  bind(1, shadow_passed_);
  bind(2, shadow_list_);
  bind(3, counters_);
  glUniform1ui(0, count);
  gl::dispatch(count, kBarriers);
  uint32_t rays = 0;
  counters_.read(0, 4, &rays);
  trace_shadows(rays, around);
  programs_.get(occlusion_program(options_)).use();
  bind_texels(sums_texels_, kSumsUnit);
  bind(0, shadow_hits_);
  bind(1, shadow_passed_);
  bind(2, shadow_list_);
  bind(6, sums_);
  glUniform1ui(0, rays);
  gl::dispatch(rays, kBarriers);
}

}  // namespace panoptes::path_tracer
