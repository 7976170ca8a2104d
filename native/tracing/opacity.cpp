#include "tracing/opacity.h"

#include "gl/dispatch.h"
#include "gpu_scene/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace panoptes::tracing {

namespace {

// Bindings of shaders/tracing/opacity_*.comp and open_rays.comp.
constexpr unsigned kHits = 0, kRays = 1, kCounter = 2, kListIn = 3, kListOut = 4, kPassed = 6;

constexpr GLbitfield kBarriers = GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                                 GL_BUFFER_UPDATE_BARRIER_BIT;

void bind(unsigned binding, const gl::Buffer& buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.id());
}

uint32_t read_word(const gl::Buffer& buffer) {
  uint32_t word = 0;
  buffer.read(0, 4, &word);
  return word;
}

}  // namespace

struct OpacityWaves::Frame {
  const Tracer& tracer;
  const TriangleList& triangles;
  const gpu_scene::GpuScene& scene;
  const OpacityBatch& batch;
  bool transmittance, any_hit, count_work;
  gl::ProgramCache& programs;
};

gl::ProgramSource open_rays_program(bool listed, bool transmittance) {
  gl::ProgramSource source;
  source.name = "open rays";
  source.stages = {{GL_COMPUTE_SHADER, "tracing/open_rays.comp"}};
  source.defines = {fmt::format("LISTED {}", int(listed)),
                    fmt::format("TRANSMITTANCE {}", int(transmittance))};
  return source;
}

gl::ProgramSource opacity_program(const gpu_scene::GpuMaterial& material,
                                  const OpacityOptions& options) {
  gl::ProgramSource source;
  source.name = fmt::format("opacity of material '{}'", material.name);
  source.stages = {{GL_COMPUTE_SHADER, "tracing/opacity_decide.comp"}};
  source.defines = {fmt::format("TRANSMITTANCE {}", int(options.transmittance)),
                    fmt::format("WEIGHTED {}", int(options.weighted))};
  gpu_scene::GpuScene::add_material(material, source);
  return source;
}

void OpacityWaves::trace(const Tracer& tracer, const TriangleList& triangles,
                         const gpu_scene::GpuScene& scene, const OpacityBatch& batch,
                         OpacityMode mode, bool count_work, gl::ProgramCache& programs) {
  rounds_ = 0;
  rays_ = 0;
  if (batch.count == 0) return;
  const Frame frame{tracer, triangles, scene, batch, mode == OpacityMode::kTransmittance,
                    mode != OpacityMode::kClosest, count_work, programs};
  const bool alpha = std::any_of(scene.materials().begin(), scene.materials().end(),
                                 [](const auto& material) { return material.facts.alpha; });
  if (alpha || frame.transmittance) counter_.reserve(4);

  // What an opaque surface blocks anyhow need not be followed through others.
  run_waves(frame, alpha && frame.any_hit ? Surfaces::kOpaque : Surfaces::kAll, batch.count,
            batch.listed);
  uint32_t count = batch.count;
  const gl::Buffer* listed = batch.listed;
  if (frame.transmittance || (alpha && frame.any_hit)) {
    count = list_open(frame);
    listed = &list_;
    if (alpha) run_waves(frame, Surfaces::kAlpha, count, listed);
  }
  if (!alpha) return;

  // The closest surface is what follows, whatever the mode: it takes its layers in order.
  shared::View view{};
  view.world_origin = glm::vec4(triangles.origin(), 0);
  const Surfaces surfaces = frame.any_hit ? Surfaces::kAlpha : Surfaces::kAll;
  while (count > 0) {
    bins_.sort({*batch.hits, count, listed, true}, uint32_t(scene.materials().size()), triangles,
               programs);
    view_block_.set(view);
    count = decide(frame);
    listed = &list_;
    run_waves(frame, surfaces, count, listed);
    rounds_ += count > 0;
  }
}

void OpacityWaves::run_waves(const Frame& frame, Surfaces surfaces, uint32_t count,
                             const gl::Buffer* listed) {
  RayBatch batch = frame.batch;
  batch.count = count;
  batch.listed = listed;
  const bool any = frame.any_hit && surfaces != Surfaces::kAlpha;
  waves_.trace(frame.tracer, frame.triangles, batch, {any, frame.count_work, surfaces},
               frame.programs);
  rays_ += count;
}

uint32_t OpacityWaves::list_open(const Frame& frame) {
  const RayBatch& batch = frame.batch;
  list_.reserve(int64_t(batch.count) * 4);
  counter_.clear();
  frame.programs.get(open_rays_program(batch.listed != nullptr, frame.transmittance)).use();
  bind(kHits, *batch.hits);
  if (batch.listed) bind(kListIn, *batch.listed);
  bind(kCounter, counter_);
  bind(kListOut, list_);
  if (frame.transmittance) bind(kPassed, *frame.batch.passed);
  glUniform1ui(1, batch.count);
  gl::dispatch(batch.count, kBarriers);
  return read_word(counter_);
}

uint32_t OpacityWaves::decide(const Frame& frame) {
  const std::vector<uint32_t>& bins = bins_.counts();
  const uint32_t total = std::accumulate(bins.begin(), bins.end(), 0u);
  if (total == 0) return 0;
  list_.reserve(int64_t(total) * 4);
  counter_.clear();
  const OpacityOptions options{frame.transmittance, frame.batch.passed != nullptr};
  uint32_t first = 0;
  for (size_t m = 0; m < bins.size(); first += bins[m++]) {
    if (bins[m] == 0) continue;
    const gpu_scene::GpuMaterial& material = frame.scene.materials()[m];
    frame.programs.get(opacity_program(material, options)).use();
    frame.scene.bind_geometry();
    frame.scene.bind_shading(material);
    frame.triangles.texture().bind(gpu_scene::kFreeUnit);
    bind(kHits, *frame.batch.hits);
    bind(kRays, *frame.batch.rays);
    bind(kCounter, counter_);
    bind(kListIn, bins_.sorted());
    bind(kListOut, list_);
    if (options.weighted) bind(kPassed, *frame.batch.passed);
    glUniform2ui(1, first, bins[m]);
    if (options.weighted) glUniform1f(2, float(frame.batch.most_layers));
    if (!options.transmittance) glUniform1f(3, frame.batch.threshold);
    gl::dispatch(bins[m], kBarriers);
  }
  return read_word(counter_);
}

}  // namespace panoptes::tracing
