#include "path_tracer/path_tracer.h"

#include "base/cancelled.h"
#include "film/sampling.h"
#include "gl/dispatch.h"
#include "path_tracer/bindings.h"

#include <algorithm>
#include <cmath>

namespace panoptes::path_tracer {

namespace {

// Paths at a time: enough to keep a device busy, few enough for its memory (about 500 bytes each).
constexpr uint32_t kBatch = 1 << 18;

// Steps of the table by which the pixel filter is sampled.
constexpr int kFilterSteps = 4096;

// A buffer of at least so many bytes and its texels, both made anew when it grows.
void reserve(gl::Buffer& buffer, gl::Texture& texels, GLenum format, int64_t bytes) {
  if (!buffer.reserve(bytes) && texels) return;
  texels = gl::Texture(format, buffer);
}

}  // namespace

void PathTracer::begin(const gpu_scene::Camera& camera, const plan::Effects& plan,
                       const FrameSettings& settings, const scene::Scene& scene,
                       gpu_scene::GpuScene& gpu, const tracing::TriangleList& triangles,
                       const film::PassSet& passes) {
  camera_ = camera;
  settings_ = settings;
  rays_ = 0;
  torn_ = false;
  list_origin_ = triangles.origin();
  const Settings& paths = settings.paths;
  {
    gl::PassScope scope(timer_, "lights");
    lights_.update(scene, gpu, triangles, programs_, timer_);
  }
  options_ = {};
  options_.surfaces = rasterize::GBufferOptions::of(plan);
  options_.add_passes(passes);
  if (lights_.any()) {
    gl::ProgramSource source;
    lights_.add_defines(source);
    options_.light_defines = source.defines;
  }
  options_.clamp = paths.clamp_direct > 0 || paths.clamp_indirect > 0;
  options_.filter_glossy = paths.filter_glossy > 0 && options_.surfaces.glossy;
  options_.lens = runs(plan, "depth_of_field");
  options_.alpha = runs(plan, "alpha");
  options_.shines = options_.surfaces.emission || gpu.world() || lights_.lamps_seen();
  options_.deferred = lights_.world_sampled() || lights_.emitters_vary();
  options_.transparent_film = settings.transparent_film;
  options_.shadow_maps = paths.shadow_maps && lights_.lamp_count() > 0;
  if (options_.shadow_maps)
    map_shadows_.begin(scene.lights(), scene.bounds(), list_origin_, settings.shadow_resolution);
  else
    map_shadows_.release();
  depth_passes_ = passes[size_t(film::Pass::kDepth)] ||
                  passes[size_t(film::Pass::kPosition)];

  gpu.check_programs(
      [&](const gpu_scene::GpuMaterial& material) {
        programs_.get(fetch_program(material, options_));
      },
      [&](const gpu_scene::GpuShading& world) { programs_.get(miss_program(&world, options_)); });

  describe_frame(triangles.bounds());
}

// What all paths of the frame share, but for the sample that they are of.
void PathTracer::describe_frame(const scene::Bounds& bounds) {
  const Settings& paths = settings_.paths;
  const glm::vec3 extent = bounds.empty() ? glm::vec3(1) : bounds.high - bounds.low;
  const glm::dmat4 world = glm::inverse(camera_.world_to_camera);
  const shared::View view = gpu_scene::camera_view(camera_, {0, 0});
  const gpu_scene::Lens& lens = camera_.lens;
  const glm::dvec3 right = glm::normalize(glm::dvec3(world[0])),
                   up = glm::normalize(glm::dvec3(world[1]));
  const double c = std::cos(lens.rotation), s = std::sin(lens.rotation);
  const auto axis = [&](double x, double y, double w) {
    return glm::vec4(glm::vec3(lens.radius * (x / std::max(lens.ratio, 1e-6) * right + y * up)),
                     float(w));
  };
  frame_.camera = glm::vec4(glm::vec3(glm::dvec3(world[3]) - list_origin_),
                            4 * glm::length(extent));
  const glm::dvec2 depths = gpu_scene::clip_depths(camera_);
  // What is nearer than the near plane is not seen, so nothing there can be in focus.
  frame_.lens_x = axis(c, s, std::max(lens.focus_distance, depths.x));
  frame_.lens_y = axis(-s, c, lens.blades);
  frame_.clip = {float(depths.x), float(depths.y), settings_.filter_width, view.filtering.y};
  frame_.clamps = {paths.clamp_direct, paths.clamp_indirect,
                   paths.filter_glossy > 0 ? 1 / paths.filter_glossy : 0.0f, paths.ao_distance};
  frame_.limits = {paths.bounces.total, paths.bounces.diffuse, paths.bounces.glossy,
                   paths.bounces.transmission};
  frame_.size = {uint32_t(camera_.width), paths.bounces.transparent, 0, 0};

  if (!filter_offsets_) {
    std::vector<float> offsets(kFilterSteps + 1);
    for (int i = 0; i <= kFilterSteps; ++i)
      offsets[size_t(i)] = film::blackman_harris_offset(float(i) / kFilterSteps, 1.0f);
    filter_buffer_ = gl::Buffer(std::span<const float>(offsets));
    filter_offsets_ = gl::Texture(GL_R32F, filter_buffer_);
  }
}

void PathTracer::reserve(uint32_t paths) {
  const int64_t n = paths;
  path_tracer::reserve(rays_buffer_, rays_texels_, GL_RGBA32F, n * int64_t(sizeof(shared::TracedRay)));
  path_tracer::reserve(hits_, hits_texels_, GL_RGBA32UI, n * int64_t(sizeof(shared::TracedHit)));
  path_tracer::reserve(states_, states_texels_, GL_RGBA32UI, n * (options_.light_passes ? 64 : 32));
  path_tracer::reserve(passed_, passed_texels_, GL_RGBA32F, n * 16);
  path_tracer::reserve(records_, records_texels_, GL_RGBA32UI, n * options_.surfaces.record_bytes());
  path_tracer::reserve(sums_, sums_texels_, GL_RGBA32F, n * 16 * int64_t(options_.passes.size()));
  going_.reserve(n * 4);
  counters_.reserve(int64_t(sizeof(Sent)));
  if (!lights_.any() && !options_.occlusion) return;
  shadow_rays_.reserve(n * int64_t(sizeof(shared::TracedRay)));
  shadow_hits_.reserve(n * int64_t(sizeof(shared::TracedHit)));
  shadow_passed_.reserve(n * 16);
  arrivals_.reserve(n * int64_t(sizeof(shared::Arrival)));
  shadow_list_.reserve(n * 4);
  lit_list_.reserve(n * 4);
  if (options_.light_passes) shares_.reserve(n * 32);
  if (options_.deferred) deferred_.reserve(n * 4);
}

void PathTracer::release() {
  for (gl::Texture* texels : {&rays_texels_, &hits_texels_, &states_texels_, &passed_texels_,
                              &records_texels_, &sums_texels_})
    *texels = gl::Texture();
  for (gl::Buffer* buffer : {&rays_buffer_, &hits_, &states_, &passed_, &records_, &sums_,
                             &shadow_rays_, &shadow_hits_, &shadow_passed_, &arrivals_, &shares_,
                             &going_, &shadow_list_, &lit_list_, &deferred_, &counters_})
    *buffer = gl::Buffer();
  raster_.release();
  lights_ = Lights(device_);
}

void PathTracer::set_frame(uint32_t index, uint32_t first_pixel, uint32_t count) {
  frame_.range = {index, settings_.seed, first_pixel, count};
  frame_block_.reserve(sizeof frame_);
  frame_block_.write(0, sizeof frame_, &frame_);
  glBindBufferBase(GL_UNIFORM_BUFFER, 1, frame_block_.id());
}

void PathTracer::render_sample(uint32_t index, bool first, const Surroundings& around,
                               film::Film& film, const std::atomic<bool>& cancelled) {
  const auto pixels = film.all_active() ? uint32_t(film.width()) * uint32_t(film.height())
                                        : uint32_t(film.active_count());
  reserve(std::min(pixels, kBatch));
  shared::View view = camera_view(index);
  view.size.z = int(index);
  view.size.w = int(settings_.seed);
  view.alpha.x = -1;  // by chance
  if (settings_.paths.raster_primary)
    raster_.rasterize(view, around.scene, camera_block_, programs_, timer_);
  if (options_.shadow_maps)
    map_shadows_.render(view, around.scene, camera_block_, programs_, timer_);
  for (uint32_t start = 0; start < pixels; start += kBatch) {
    const uint32_t count = std::min(pixels - start, kBatch);
    set_frame(index, start, count);
    if (first && depth_passes_) write_depth(count, around, film);
    begin_paths(count, settings_.paths.raster_primary, view, film);
    trace_paths(count, around, cancelled);
    resolve(count, film);
    torn_ = start + count < pixels;
  }
}

void PathTracer::write_depth(uint32_t count, const Surroundings& around, film::Film& film) {
  // Where a surface is half transparent or more, depth is that of what lies behind: as Blender's.
  constexpr float kCutAlpha = 0.5f;
  const shared::View view = gpu_scene::camera_view(camera_, {0, 0});
  begin_paths(count, true, view, film);
  trace(count, nullptr, kCutAlpha, around);
  gl::PassScope scope(timer_, "pass_depth");
  camera_block_.set(view);
  programs_.get(depth_program(film)).use();
  film.bind();
  bind_texels(rays_texels_, kRaysUnit);
  bind_texels(hits_texels_, kHitsUnit);
  gl::dispatch(count, kBarriers | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

// With rasterised primary hits all pixels are seen through one place of them.
shared::View PathTracer::camera_view(uint32_t index) const {
  glm::dvec2 jitter(0);
  if (settings_.paths.raster_primary) {
    const glm::vec2 u = film::sample_point(index, settings_.seed, 0);
    jitter = {film::blackman_harris_offset(u.x, settings_.filter_width),
              film::blackman_harris_offset(u.y, settings_.filter_width)};
  }
  return gpu_scene::camera_view(camera_, jitter);
}

void PathTracer::begin_paths(uint32_t count, bool centre, const shared::View& view,
                             const film::Film& film) {
  gl::PassScope scope(timer_, "camera_rays");
  camera_block_.set(view);
  const gl::Buffer* listed = film.all_active() ? nullptr : &film.active_pixels();
  programs_.get(begin_paths_program(options_, listed != nullptr, centre)).use();
  if (!centre) bind_texels(filter_offsets_, kFilterUnit);
  bind(0, rays_buffer_);
  bind(1, states_);
  bind(2, passed_);
  bind(3, sums_);
  if (listed) bind(4, *listed);
  gl::dispatch(count, kBarriers);
}

void PathTracer::trace_paths(uint32_t count, const Surroundings& around,
                             const std::atomic<bool>& cancelled) {
  const gl::Buffer* listed = nullptr;
  const auto materials = uint32_t(around.scene.materials().size());
  for (uint32_t depth = 0; count > 0; ++depth) {
    if (depth == 0 && settings_.paths.raster_primary) {
      gl::PassScope scope(timer_, "camera_rays");
      set_list_view();
      raster_.write_hits(count, rays_buffer_, hits_, around.scene, around.triangles, programs_);
    } else {
      trace(count, listed, -1, around);
    }
    stop_if(cancelled);
    {
      gl::PassScope scope(timer_, "path_hits_sorted");
      bins_.sort({hits_, count, listed, false}, materials, around.triangles, programs_);
    }
    const uint32_t missed = bins_.counts().back(), met = count - missed;
    fetch(around);
    miss(met, missed, around);
    if (depth == 0 && options_.occlusion) ambient_occlusion(met, around);
    const Sent sent = shade(met, depth);
    stop_if(cancelled);
    {
      gl::PassScope scope(timer_, "shadow_rays");
      trace_shadows(sent.shadow_rays, around);
    }
    {
      gl::PassScope scope(timer_, "direct_light");
      arrive(sent.lit, false);
      arrive(sent.shadow_rays, true);
      if (options_.deferred && sent.shadow_rays > 0) arrive_deferred(around);
    }
    stop_if(cancelled);
    count = sent.paths;
    listed = &going_;
  }
}

void PathTracer::resolve(uint32_t count, film::Film& film) {
  gl::PassScope scope(timer_, "film");
  const gl::Buffer* listed = film.all_active() ? nullptr : &film.active_pixels();
  programs_.get(resolve_program(options_, listed != nullptr, film)).use();
  film.bind();
  bind_texels(sums_texels_, kSumsUnit);
  if (listed) bind(4, *listed);
  gl::dispatch(count, kBarriers | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

}  // namespace panoptes::path_tracer
