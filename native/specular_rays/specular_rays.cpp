#include "specular_rays/specular_rays.h"

#include "gl/dispatch.h"
#include "gpu_scene/units.h"

#include <numeric>

namespace panoptes::specular_rays {

namespace {

// Units and bindings of shaders/specular_rays.
constexpr int kDirectUnit = 0, kIndirectUnit = 1, kRaysUnit = 5, kFollowedUnit = 6, kStatesUnit = 7,
              kRecordsUnit = 8;
constexpr unsigned kFrameBlock = 4;

constexpr GLbitfield kBarriers = GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                                 GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT;

struct Turned {
  uint32_t going = 0, ended = 0;
};

void bind(unsigned binding, const gl::Buffer& buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.id());
}

void bind_texels(const gl::Texture& texture, int unit) {
  texture.bind(unit);
  glBindSampler(GLuint(unit), 0);  // one of a material's images may still sit there
}

// A buffer of at least so many bytes and its texels, both made anew when it grows.
void reserve(gl::Buffer& buffer, gl::Texture& texels, GLenum format, int64_t bytes) {
  if (!buffer.reserve(bytes) && texels) return;
  texels = gl::Texture(format, buffer);
}

}  // namespace

void SpecularRays::begin(const gpu_scene::Camera& camera, const plan::Effects& plan,
                         const Settings& settings, uint32_t seed) {
  camera_ = camera;
  settings_ = settings;
  seed_ = seed;
  rays_ = 0;
  paths_ = ended_ = 0;
  runs_ = plan::runs(plan, "specular_rays");
  options_ = {rasterize::GBufferOptions::of(plan), plan::runs(plan, "alpha"),
              plan::runs(plan, "direct_light")};
  if (!runs_) {
    held_ = Held();
    return;
  }
  for (gl::Texture* texture : {&held_.direct, &held_.indirect})
    if (!*texture || texture->options().width != camera.width ||
        texture->options().height != camera.height) {
      *texture = gl::Texture();
      *texture = gl::Texture({GL_TEXTURE_2D, GL_RGBA32F, camera.width, camera.height, 1, 1});
    }
  held_.pixels.reserve(int64_t(camera.width) * camera.height * 4);
  held_.counters.reserve(int64_t(sizeof(Turned)));
}

void SpecularRays::reserve(uint32_t paths) {
  const int64_t n = paths;
  specular_rays::reserve(held_.rays, held_.rays_texels, GL_RGBA32F, n * int64_t(sizeof(shared::TracedRay)));
  specular_rays::reserve(held_.states, held_.states_texels, GL_RGBA32UI, n * int64_t(sizeof(shared::SpecularPath)));
  specular_rays::reserve(held_.records, held_.records_texels, GL_RGBA32UI, n * options_.surfaces.record_bytes());
  held_.hits.reserve(n * int64_t(sizeof(shared::TracedHit)));
  held_.going.reserve(n * 4);
  held_.ended.reserve(n * 4);
  if (options_.colored_alpha) held_.passed.reserve(n * 16);
}

void SpecularRays::trace(const Sample& sample, const std::atomic<bool>& cancelled) {
  gl::PassScope scope(timer_, "specular_rays");
  ended_ = 0;
  describe(sample);
  paths_ = select(sample);
  if (paths_ == 0) return;
  reserve(paths_);
  begin_paths(sample);
  uint32_t count = paths_;
  const gl::Buffer* listed = nullptr;
  for (uint32_t events = 0; count > 0; ++events) {
    if (events > 0) follow(sample, count, listed);
    held_.bins.sort({held_.hits, count, listed, false}, uint32_t(sample.scene.materials().size()),
               sample.triangles, programs_);
    stop_if(cancelled);
    const uint32_t missed = held_.bins.counts().back(), met = count - missed;
    fetch(sample);
    sample.view_block.set(sample.view);
    miss(sample, met, missed, events);
    count = go_on(met, events);
    listed = &held_.going;
    stop_if(cancelled);
  }
}

void SpecularRays::describe(const Sample& sample) {
  const scene::Bounds& bounds = sample.triangles.bounds();
  const glm::vec3 extent = bounds.empty() ? glm::vec3(1) : bounds.high - bounds.low;
  const glm::vec3 camera = glm::vec3(sample.view.world_origin) - sample.triangles.origin();
  const bool all = settings_.mode == Mode::kOn;
  const shared::SpecularFrame frame{glm::vec4(camera, 4 * glm::length(extent)),
                                    {all ? 1.0f : settings_.roughness, 0, 0, 0},
                                    {sample.index, seed_, 0, 0}};
  held_.frame_block.reserve(sizeof frame);
  held_.frame_block.write(0, sizeof frame, &frame);
  glBindBufferBase(GL_UNIFORM_BUFFER, kFrameBlock, held_.frame_block.id());
}

uint32_t SpecularRays::select(const Sample& sample) {
  held_.counters.clear();
  programs_.get(select_program(options_)).use();
  sample.g_buffer.bind_bins();
  sample.g_buffer.bind_surfaces();
  bind(3, held_.counters);
  bind(4, held_.pixels);
  held_.direct.bind_image(0, GL_WRITE_ONLY);
  held_.indirect.bind_image(1, GL_WRITE_ONLY);
  sample.g_buffer.dispatch_surfaces();
  glMemoryBarrier(kBarriers);
  uint32_t listed = 0;
  held_.counters.read(0, 4, &listed);
  return listed;
}

void SpecularRays::begin_paths(const Sample& sample) {
  const std::vector<uint32_t>& firsts = sample.triangles.first_primitives();
  held_.first_primitives.reserve(int64_t(firsts.size()) * 4);
  held_.first_primitives.write(0, int64_t(firsts.size()) * 4, firsts.data());
  programs_.get(begin_program()).use();
  sample.g_buffer.bind_visibility();
  bind_texels(held_.direct, kFollowedUnit);
  bind(0, held_.rays);
  bind(1, held_.hits);
  bind(2, held_.states);
  bind(3, held_.pixels);
  bind(4, sample.scene.records());
  bind(5, held_.first_primitives);
  glUniform1ui(0, paths_);
  gl::dispatch(paths_, kBarriers);
}

void SpecularRays::follow(const Sample& sample, uint32_t count, const gl::Buffer* listed) {
  tracing::OpacityBatch batch;
  batch.rays = &held_.rays;
  batch.hits = &held_.hits;
  batch.count = count;
  batch.listed = listed;
  if (options_.colored_alpha) batch.passed = &held_.passed;
  batch.threshold = sample.view.alpha.x;
  held_.opacity.trace(sample.tracer, sample.triangles, sample.scene, batch,
                 tracing::OpacityMode::kClosest, false, programs_);
  rays_ += held_.opacity.rays();
}

void SpecularRays::fetch(const Sample& sample) {
  shared::View view = sample.view;
  view.world_origin = glm::vec4(sample.triangles.origin(), 0);
  held_.list_block.set(view);
  const std::vector<uint32_t>& counts = held_.bins.counts();
  uint32_t first = 0;
  for (size_t m = 0; m + 1 < counts.size(); first += counts[m++]) {
    if (counts[m] == 0) continue;
    const gpu_scene::GpuMaterial& material = sample.scene.materials()[m];
    programs_.get(fetch_program(material, options_)).use();
    sample.scene.bind_geometry();
    sample.scene.bind_shading(material);
    sample.triangles.texture().bind(gpu_scene::kFreeUnit);
    bind(0, held_.rays);
    bind(1, held_.hits);
    bind(2, held_.states);
    bind(3, held_.bins.sorted());
    bind(4, held_.records);
    glUniform2ui(1, first, counts[m]);
    gl::dispatch(counts[m], kBarriers);
  }
}

// What path.glsl reads and writes.
void SpecularRays::bind_paths() const {
  bind_texels(held_.rays_texels, kRaysUnit);
  bind_texels(held_.states_texels, kStatesUnit);
  bind_texels(held_.direct, kDirectUnit);
  bind_texels(held_.indirect, kIndirectUnit);
  held_.direct.bind_image(0, GL_WRITE_ONLY);
  held_.indirect.bind_image(1, GL_WRITE_ONLY);
  glBindBufferBase(GL_UNIFORM_BUFFER, kFrameBlock, held_.frame_block.id());
}

void SpecularRays::miss(const Sample& sample, uint32_t first, uint32_t count, uint32_t events) {
  const auto& world = sample.scene.world();
  if (count == 0 || !world) return;
  programs_.get(miss_program(*world, options_)).use();
  sample.scene.bind_shading(*world);
  bind_paths();
  bind(0, held_.bins.sorted());
  if (options_.colored_alpha) bind(1, held_.passed);
  glUniform2ui(1, first, count);
  glUniform1ui(2, events);
  gl::dispatch(count, kBarriers);
}

// The number of paths that go on, in held_.going; those that end join held_.ended.
uint32_t SpecularRays::go_on(uint32_t count, uint32_t events) {
  if (count == 0) return 0;
  const Turned before{0, ended_};
  held_.counters.write(0, sizeof before, &before);
  programs_.get(go_on_program(options_)).use();
  bind_paths();
  bind_texels(held_.records_texels, kRecordsUnit);
  bind(0, held_.rays);
  bind(1, held_.states);
  bind(2, held_.counters);
  bind(3, held_.bins.sorted());
  bind(4, held_.going);
  bind(5, held_.ended);
  if (options_.colored_alpha) bind(6, held_.passed);
  glUniform1ui(0, count);
  glUniform1ui(1, events);
  gl::dispatch(count, kBarriers);
  Turned turned;
  held_.counters.read(0, sizeof turned, &turned);
  ended_ = turned.ended;
  return turned.going;
}

void SpecularRays::bind_ends() const {
  bind_paths();
  bind_texels(held_.records_texels, kRecordsUnit);
  bind(0, held_.ended);
  glUniform1ui(0, ended_);
}

void SpecularRays::add_lamps(uint32_t first, uint32_t count, const LampOptions& options) {
  if (ended_ == 0 || count == 0) return;
  gl::PassScope scope(timer_, "specular_rays_lamps");
  programs_.get(lamps_program(options_, options)).use();
  bind_ends();
  glUniform2ui(1, first, count);
  gl::dispatch(ended_, kBarriers);
}

void SpecularRays::add_surroundings(const SurroundingsOptions& options,
                                    const std::function<void()>& bind) {
  if (ended_ == 0) return;
  gl::PassScope scope(timer_, "specular_rays_surroundings");
  programs_.get(surroundings_program(options_, options)).use();
  bind_ends();
  bind();
  gl::dispatch(ended_, kBarriers);
}

}  // namespace panoptes::specular_rays
