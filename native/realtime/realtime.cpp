#include "realtime/realtime.h"

#include "film/sampling.h"
#include "realtime/sample_dimensions.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace panoptes::realtime {

namespace {

// Where a single threshold has to do: Blender's own for its depth pass.
constexpr float kCutAlpha = 0.5f;

// Where programs of the frame look up the radiance cache.
constexpr int kCacheUnit = 16, kCacheBlock = 2;

void want(gl::Texture& texture, bool wanted, int width, int height) {
  const bool fits = texture && texture.options().width == width &&
                    texture.options().height == height;
  if (wanted == fits) return;
  texture = gl::Texture();
  if (wanted) texture = gl::Texture({GL_TEXTURE_2D, GL_RGBA32F, width, height, 1, 1});
}

}  // namespace

void Realtime::begin(const gpu_scene::Camera& camera, const plan::Effects& plan,
                     const Settings& settings, bool single, const scene::Scene& scene,
                     const gpu_scene::GpuScene& gpu, const tracing::TriangleList* triangles) {
  camera_ = camera;
  // Emitters have other points, and alpha other thresholds.
  if (settings.seed != settings_.seed || single != single_) shadow_revision_ = -1;
  settings_ = settings;
  plan_ = plan;
  surfaces_ = rasterize::GBufferOptions::of(plan);
  alpha_ = runs(plan, "alpha");
  emissive_light_ = runs(plan, "emissive_light");
  lamps_ = emissive_light_ || runs(plan, "direct_light");
  single_ = single;
  soft_ = runs(plan, "soft_shadows");
  filtered_ = runs(plan, "filtered_penumbrae");
  shadows_ = lamps_ && (runs(plan, "sun_shadows") || runs(plan, "point_shadows") ||
                        runs(plan, "spot_shadows") || runs(plan, "area_shadows") ||
                        runs(plan, "emissive_shadows"));
  cascades_ = shadows_ && runs(plan, "sun_cascades");
  background_ = runs(plan, "world_background") && gpu.world();
  world_light_ = runs(plan, "world_light");
  triangles_ = triangles;
  depth_ = runs(plan, "pass_depth");
  deep_shadows_ = runs(plan, "deep_shadows");
  lights_ = scene.lights();
  bounds_ = scene.bounds();

  const int width = camera.width, height = camera.height;
  g_buffer_.resize(width, height, surfaces_);
  want(diffuse_light_, lamps_, width, height);
  want(glossy_light_, lamps_ && surfaces_.glossy, width, height);
  want(environment_, background_, width, height);
  if (!shadows_) shadow_maps_.release();
  specular_rays_.begin(camera, plan, settings.specular_rays, settings.seed);
  if (!emissive_light_) {
    emitters_.clear();
    emitter_revision_ = -1;
  } else {
    gl::PassScope scope(timer_, "emissive_light");
    if (emitter_revision_ != gpu.emission_revision()) {
      emitters_.update(scene, {gpu, programs_, view_block_, gpu_scene::camera_view(camera, {0, 0})});
      emitter_revision_ = gpu.emission_revision();
      shadow_revision_ = -1;  // their points may stand elsewhere
    }
    emitters_.start(
        [seed = settings.seed](uint32_t index) {
          return film::sample_point(index, seed, kEmitterDimension);
        },
        single);
  }
  if (world_light_) {
    gl::PassScope scope(timer_, "world_light");
    world_.update(scene.world(), gpu, programs_);
  }
  if (triangles)
    cache_.begin({camera, plan, settings.cache, settings.seed, scene, gpu, world_, settings.follows});
  else
    cache_.release();
  if (!cache_.runs()) begin_occlusion();
}

void Realtime::place_by(const shared::View& view, const gpu_scene::GpuScene& gpu) {
  std::vector<rasterize::Slab> slabs;
  if (cascades_ || cache_.looks_far()) {
    gl::PassScope scope(timer_, cascades_ ? "sun_cascades" : "radiance_cache_distance");
    slabs = rasterize::visible_slabs(g_buffer_, bounds_, glm::inverse(camera_.world_to_camera)[3], programs_);
  }
  if (cascades_) find_cascades(slabs, view);
  if (!cache_.runs()) return;
  cache_.place(rasterize::median_distance(slabs), *triangles_, gpu, view_block_);
  view_block_.set(view);
  begin_occlusion();
}

void Realtime::begin_occlusion() {
  const ambient_occlusion::Settings& asked = settings_.occlusion;
  const bool picture = asked.picture != ambient_occlusion::Picture::kNone;
  // Whether light is darkened by what the AO pass shows as well.
  const bool same = picture || !cache_.runs() || (runs(plan_, "pass_ao") && asked.distance <= cache_.voxel());
  const bool pass = runs(plan_, "pass_ao") && !same;
  occlusion_.begin(camera_, same ? asked : ambient_occlusion::contact(asked, cache_.voxel()), plan_,
                   settings_.seed);
  if (pass)
    pass_occlusion_.begin(camera_, settings_.occlusion, plan_, settings_.seed);
  else
    pass_occlusion_.release();
}

glm::dvec2 Realtime::sample_jitter(uint32_t index) const {
  // A single sample looks through the pixel's centre; many follow the pixel filter.
  if (single_) return {0, 0};
  const glm::vec2 u = film::sample_point(index, settings_.seed, kPixelDimension);
  return {film::blackman_harris_offset(u.x, settings_.filter_width),
          film::blackman_harris_offset(u.y, settings_.filter_width)};
}

shared::View Realtime::sample_view(uint32_t index, uint32_t sharing) const {
  shared::View view = gpu_scene::camera_view(camera_, sample_jitter(index));
  view.size.z = int(index);
  view.size.w = int(settings_.seed);
  view.alpha = {single_ ? kCutAlpha : -1.0f, 0, 0, 0};
  // N samples share the pixel's footprint, so each may look sqrt(N) times finer.
  view.filtering.x = -0.5f * std::log2(float(sharing));
  return view;
}

void Realtime::render_sample(uint32_t index, uint32_t first, uint32_t sharing,
                             const Surroundings& around, film::Film& film,
                             const std::atomic<bool>& cancelled) {
  const gpu_scene::GpuScene& gpu = around.scene;
  // What the cache makes once a picture, and again where frames that follow each other have put it off.
  const bool late = cache_.runs() && index > first && cache_.stale();
  const bool lights_cache = cache_.runs() && (index == 0 || late);
  if (late) cache_.catch_up(*triangles_, gpu, view_block_);
  if (index == first && first > 0 && (cascades_ || undecided() || cache_.runs()))
    look_at_first_sample(sharing, gpu, cancelled);
  const shared::View view = sample_view(index, sharing);
  if (index == first && depth_) {
    // Where a surface is half transparent or more, depth is that of what lies behind.
    shared::View cut = view;
    cut.alpha.x = kCutAlpha;
    view_block_.set(cut);
    g_buffer_.rasterize(gpu, programs_, timer_);
    write_depth(gpu, film);
  }
  view_block_.set(view);
  if (!(index == first && depth_ && (!alpha_ || single_)))
    g_buffer_.rasterize(gpu, programs_, timer_);
  stop_if(cancelled);
  g_buffer_.shade(gpu, programs_, timer_);
  stop_if(cancelled);
  if (index == 0) place_by(view, gpu);
  if (lights_cache) {
    cache_.see(g_buffer_, glm::dvec3(glm::vec3(view.world_origin)));
    cache_.begin_lamps();
  }
  if (specular_rays_.runs() && !shows_occlusion() && !shows_cache()) trace_specular(index, view, around, cancelled);
  if (lamps_)
    add_lamps(index, view, gpu, lights_cache ? cache_points(sharing) : 0, cancelled);
  else
    find_occlusion(index, view, nullptr, gpu, cancelled);
  if (lights_cache) gather_cache(view, gpu, cancelled);
  if (index > first) cache_.settle();
  stop_if(cancelled);

  if (background_) {
    gl::PassScope scope(timer_, "world_background");
    programs_.get(background_program(*gpu.world())).use();
    gpu.bind_shading(*gpu.world());
    g_buffer_.bind_bins();
    environment_.bind_image(0, GL_WRITE_ONLY);
    g_buffer_.dispatch_background();
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    stop_if(cancelled);
  }

  if (specular_rays_.runs() && (world_light_ || cache_.runs())) {
    const std::optional<radiance_cache::LookUpOptions> cache = look_up();
    specular_rays_.add_surroundings({world_light_, cache}, [&] { bind_ambient(cache, gpu, view); });
  }
  if (shows_cache())
    show_cache(view, film);
  else if (shows_occlusion())
    show_picture(film);
  else
    compose(gpu, view, film);
}

void Realtime::trace_specular(uint32_t index, const shared::View& view, const Surroundings& around,
                              const std::atomic<bool>& cancelled) {
  specular_rays_.trace({index, view, g_buffer_, around.scene, *around.tracer, *around.triangles,
                        view_block_},
                       cancelled);
  view_block_.set(view);
}

void Realtime::look_at_first_sample(uint32_t sharing, const gpu_scene::GpuScene& gpu,
                                    const std::atomic<bool>& cancelled) {
  // Views and maps follow what the picture's first sample sees, in whatever ranges it is rendered.
  const shared::View view = sample_view(0, sharing);
  view_block_.set(view);
  g_buffer_.rasterize(gpu, programs_, timer_);
  g_buffer_.shade(gpu, programs_, timer_);
  stop_if(cancelled);
  place_by(view, gpu);
  if (!undecided() && !cache_.runs()) return;
  const rasterize::LightSet set =
      lamps_ ? place(0, view, gpu, lights_, placement_of_lamps()) : rasterize::LightSet{};
  store_lights(set);
  shadow_revision_ = -1;  // these maps are of another sample than the next
  cache_.see(g_buffer_, glm::dvec3(glm::vec3(view.world_origin)));
  cache_.begin_lamps();
  if (!shadows_ || set.batches.empty()) choose_views(0, view, nullptr, gpu);
  for (const rasterize::LightBatch& batch : set.batches) {
    if (shadows_) draw_shadow_maps(set, batch, view, gpu, false, false);
    stop_if(cancelled);
    if (shadows_ && &batch == &set.batches.front()) choose_views(0, view, &set, gpu);
    if (!cache_.runs()) return;
    light_cache(batch, view, cache_points(sharing));
  }
  light_cache_further(cache_points(sharing), view, gpu, cancelled);
  gather_cache(view, gpu, cancelled);
}

bool Realtime::undecided() const {
  return occlusion_.undecided() || pass_occlusion_.undecided();
}

void Realtime::choose_views(uint32_t index, const shared::View& view,
                            const rasterize::LightSet* lights, const gpu_scene::GpuScene& gpu) {
  const auto sample = occlusion_sample(index, view, lights, gpu);
  for (ambient_occlusion::AmbientOcclusion* occlusion : {&occlusion_, &pass_occlusion_})
    if (occlusion->undecided()) occlusion->choose(sample);
}

ambient_occlusion::AmbientOcclusion::Sample Realtime::occlusion_sample(
    uint32_t index, const shared::View& view, const rasterize::LightSet* lights,
    const gpu_scene::GpuScene& gpu) {
  return {.index = index,
          .jitter = sample_jitter(index),
          .view = view,
          .g_buffer = g_buffer_,
          .lights = lights,
          .maps = &shadow_maps_,
          .scene = gpu,
          .bounds = bounds_,
          .view_block = view_block_};
}

void Realtime::find_occlusion(uint32_t index, const shared::View& view,
                              const rasterize::LightSet* lights, const gpu_scene::GpuScene& gpu,
                              const std::atomic<bool>& cancelled) {
  if (undecided()) choose_views(index, view, lights, gpu);
  stop_if(cancelled);
  const auto sample = occlusion_sample(index, view, lights, gpu);
  for (ambient_occlusion::AmbientOcclusion* occlusion : {&occlusion_, &pass_occlusion_}) {
    if (!occlusion->runs()) continue;
    occlusion->estimate(sample);
    stop_if(cancelled);
  }
}

void Realtime::show_cache(const shared::View& view, film::Film& film) {
  g_buffer_.bind_visibility();
  g_buffer_.bind_surfaces();
  cache_.show(*look_up(), glm::dvec3(glm::vec3(view.world_origin)), film);
  dispatch_pixels();
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

void Realtime::show_picture(film::Film& film) {
  gl::PassScope scope(timer_, "ambient_occlusion_picture");
  programs_.get(ambient_occlusion::picture_program(settings_.occlusion.picture, film)).use();
  g_buffer_.bind_visibility();
  occlusion_.bind_picture();
  film.bind();
  dispatch_pixels();
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

std::optional<radiance_cache::LookUpOptions> Realtime::look_up() const {
  if (!cache_.runs()) return {};
  return cache_.look_up(kCacheUnit, kCacheBlock);
}

void Realtime::bind_ambient(const std::optional<radiance_cache::LookUpOptions>& cache,
                            const gpu_scene::GpuScene& gpu, const shared::View& view) {
  if (world_light_) glBindBufferBase(GL_UNIFORM_BUFFER, 1, world_.harmonics().id());
  if (cache) cache_.bind(*cache, gpu, glm::dvec3(glm::vec3(view.world_origin)));
  if (cache && cache->scaled)
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, gpu.records().id());
}

void Realtime::compose(const gpu_scene::GpuScene& gpu, const shared::View& view, film::Film& film) {
  gl::PassScope scope(timer_, "compose");
  const ComposeOptions options{.lamps = lamps_,
                         .background = background_,
                         .world_light = world_light_,
                         .transparent_film = settings_.transparent_film,
                         .occlusion = occlusion_.runs(),
                         .deep_shadows = deep_shadows_,
                         .pass_occlusion = pass_occlusion_.runs(),
                         .specular_rays = specular_rays_.runs(),
                         .cache = look_up(),
                         .surfaces = surfaces_};
  programs_.get(compose_program(options, film)).use();
  g_buffer_.bind_visibility();
  g_buffer_.bind_surfaces();
  if (lamps_) diffuse_light_.bind(0);
  if (lamps_ && surfaces_.glossy) glossy_light_.bind(1);
  if (surfaces_.emission) g_buffer_.emission().bind(2);
  if (background_) environment_.bind(3);
  if (occlusion_.runs()) {
    occlusion_.combined().bind(4);
    glUniform1f(2, settings_.occlusion.strength);
    if (deep_shadows_) {
      occlusion_.deep_shadows().bind(5);
      glUniform1f(3, settings_.occlusion.deep_shadows);
    }
  }
  if (pass_occlusion_.runs()) pass_occlusion_.combined().bind(17);
  if (specular_rays_.runs()) {
    specular_rays_.direct().bind(6);
    specular_rays_.indirect().bind(13);
  }
  bind_ambient(options.cache, gpu, view);
  film.bind();
  dispatch_pixels();
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

void Realtime::write_depth(const gpu_scene::GpuScene& gpu, film::Film& film) {
  gl::PassScope scope(timer_, "pass_depth");
  programs_.get(depth_program(film)).use();
  gpu.bind_geometry();
  g_buffer_.bind_bins();
  g_buffer_.bind_visibility();
  film.bind();
  dispatch_pixels();
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

void Realtime::dispatch_pixels() const {
  glDispatchCompute(GLuint(camera_.width + 7) / 8, GLuint(camera_.height + 7) / 8, 1);
}

}  // namespace panoptes::realtime
