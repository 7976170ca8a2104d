#include "engine/render_thread.h"

#include "base/cancelled.h"
#include "base/error.h"
#include "film/display.h"
#include "film/mixture.h"
#include "gl/counters.h"
#include "gl/heap_pieces.h"
#include "plan/plan.h"
#include "plan/shown_pass.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>

namespace panoptes::engine {

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// A live picture is copied out at most this often; more would cost more than it shows.
constexpr double kLiveIntervalMs = 100;
// And rendering gets at least so many times what showing takes, which is much where the picture is denoised.
constexpr double kLiveShare = 3;
// The estimated error needs a copy of the film: look at it every so many samples.
constexpr uint32_t kErrorInterval = 4;

bool traces_paths(const RenderRequest& request) {
  return request.method != Method::kRealtime &&
         request.debug_picture == ray_picture::Kind::kNone;
}

// About the rays of a path, for the choice of a structure before any was traced.
constexpr int64_t kRaysOfPath = 6;

// How many samples share a pixel's footprint with this one. Where ranges are to be merged nobody knows
// how many there will be: then it is as many as there are up to the end of its octave.
uint32_t sharing(const RenderRequest& request, uint32_t index) {
  return request.pieces ? std::bit_ceil(std::max(index + 1, film::kBlock)) : request.last_sample;
}

// Whether the picture will have no other sample than its first.
bool single(const RenderRequest& request) { return request.last_sample == 1 && !request.pieces; }

// The passes of an effect have its name, or begin with it: "structure_lists".
bool belongs(const std::string& pass, const std::string& effect) {
  return pass == effect || pass.starts_with(effect + '_');
}

std::vector<EffectReport> report(const plan::Effects& plan,
                                 const std::vector<gl::PassTime>& times) {
  std::vector<EffectReport> effects;
  for (const plan::Effect& effect : plan) {
    EffectReport r{effect, 0};
    for (const gl::PassTime& time : times)
      if (belongs(time.name, effect.name)) r.ms += time.ms;
    effects.push_back(std::move(r));
  }
  return effects;
}

}  // namespace

RenderThread::RenderThread(const gl::ContextOptions& options)
    : context_(options), timer_(context_.device()), gpu_scene_(context_.device()),
      realtime_(context_.device(), programs_, timer_), traced_(context_.device()),
      path_tracer_(context_.device(), programs_, timer_) {
  if (context_.device().software) gl::keep_heap_in_pieces();
}

void RenderThread::render(Job& job, SharedScene& scene, std::atomic<bool>& spoiled) {
  std::string error;
  job.begin();
  try {
    const RenderRequest& request = job.request();
    const bool looks = request.viewport && request.shown_pass == film::Pass::kCombined && !request.force_all_effects &&
                       !traces_paths(request) && request.debug_picture == ray_picture::Kind::kNone;
    if (looks && !job.cancelled()) look_first(job, scene);
    if (!job.cancelled()) render_frame(job, scene);
  } catch (const Cancelled&) {
  } catch (const DriverError& e) {
    error = e.what();
    spoiled = true;
  } catch (const std::bad_alloc&) {
    error = "the computer ran out of memory: lower the resolution or simplify the scene";
  } catch (const std::exception& e) {
    error = e.what();
  }
  job.end(std::move(error));
}

bool RenderThread::upload_ahead(SharedScene& scene) {
  try {
    return gpu_scene_.upload_ahead(*scene.hold());
  } catch (const std::exception&) {
    return false;
  }
}

plan::Effects RenderThread::plan_of(const RenderRequest& request, const scene::Scene& scene) {
  // Ranges that are to be merged have the plan of a picture of many samples, whichever they are.
  const int samples = request.pieces    ? std::numeric_limits<int>::max()
                      : single(request) ? 1
                                        : std::max(int(request.last_sample), 2);
  return plan::make_plan(scene.facts(), {samples, request.soft_shadows, request.filter_penumbrae,
                                         request.force_all_effects, request.passes,
                                         request.shown_pass, request.debug_picture, traces_paths(request),
                                         {request.paths, request.camera.lens.radius > 0}, request.denoise,
                                         request.occlusion, request.cache, request.specular_rays});
}

void RenderThread::publish(Job& job, const film::PassSet& passes) {
  const RenderRequest& request = job.request();
  // False colours are to be read by their scale.
  const bool light = request.debug_picture == ray_picture::Kind::kNone;
  for (int i = 0; i < film::kPassCount; ++i)
    if (passes[size_t(i)]) {
      const film::Pass shown = film::Pass(i) == film::Pass::kCombined ? request.shown_pass : film::Pass(i);
      std::vector<float> pixels = film_.read(shown, light ? request.exposure : 1.0f);
      if (shown != film::Pass(i)) pixels = film::display(shown, pixels);
      job.publish(film::Pass(i), std::move(pixels), film_.samples());
    }
}

void RenderThread::publish_live(Job& job) {
  film::PassSet combined;
  combined.set(size_t(film::Pass::kCombined));
  publish(job, combined);
  if (!job.over_.smooth.empty()) mix(job);
}

film::PassSet RenderThread::filmed(const RenderRequest& request) const {
  film::PassSet passes = request.passes;
  if (request.force_all_effects) passes.set();
  if (denoises_) passes |= denoise::features(request.camera.lens.radius > 0);
  return passes;
}

film::Mixture RenderThread::denoised(const Job& job, const film::Mixture& paths) {
  const RenderRequest& request = job.request();
  return denoise_.run(request.denoise,
                      denoise::gather(film_, paths.pixels, paths.variance, request.exposure,
                                      request.camera.lens.radius > 0),
                      programs_, timer_, job.cancelled_);
}

void RenderThread::mix(Job& job) {
  const RenderRequest& request = job.request();
  film::Mixture paths{job.read(film::Pass::kCombined), 0, film_.variance(request.exposure)};
  if (paths.variance.empty()) return;
  const TakeOver& over = job.over_;
  if (over.before_samples > 0) {
    // Samples of the earlier job are as noisy.
    const float share = float(film_.samples()) / float(film_.samples() + over.before_samples);
    for (size_t i = 0; i < paths.pixels.size(); ++i) paths.pixels[i] = std::lerp(over.before[i], paths.pixels[i], share);
    for (float& v : paths.variance) v *= share;
  }
  if (denoises_) paths = denoised(job, paths);
  film::Mixture mixture = film::mix_by_error(request.camera.width, request.camera.height, over.smooth, paths.pixels,
                                             paths.variance);
  mixture_error_ = mixture.error;
  job.show(std::move(mixture.pixels));
}

void RenderThread::publish_denoised(Job& job) {
  const film::Mixture paths{job.read(film::Pass::kCombined), 0, film_.variance(job.request().exposure)};
  if (paths.variance.empty()) return;
  film::Mixture found = denoised(job, paths);
  mixture_error_ = found.error;
  job.publish(film::Pass::kCombined, std::move(found.pixels), film_.samples());
}

void RenderThread::begin_realtime(const RenderRequest& request, const plan::Effects& plan,
                                  scene::Scene& scene) {
  ray_picture_.release();
  path_tracer_.release();
  realtime::Settings settings;
  settings.shadows.resolution = request.shadow_resolution;
  settings.seed = request.seed;
  settings.transparent_film = request.transparent_film;
  settings.filter_width = request.filter_width;
  settings.occlusion = request.occlusion;
  settings.cache = request.cache;
  settings.specular_rays = request.specular_rays;
  settings.follows = request.viewport && request.last_sample - request.first_sample > 1;
  const rasterize::GBufferOptions surfaces = rasterize::GBufferOptions::of(plan);
  gpu_scene_.check_programs(
      [&](const gpu_scene::GpuMaterial& material) {
        programs_.get(rasterize::surface_program(material, surfaces));
      },
      [&](const gpu_scene::GpuShading& world) {
        programs_.get(realtime::background_program(world));
      });
  // Samples that come after others are part of a picture of many, even if only one is asked for.
  const bool triangles = plan::runs(plan, "radiance_cache");
  realtime_.begin(request.camera, plan, settings, single(request), scene, gpu_scene_,
                  triangles ? &traced_.triangles() : nullptr);
}

void RenderThread::begin_paths(const RenderRequest& request, const plan::Effects& plan,
                               scene::Scene& scene) {
  ray_picture_.release();
  path_tracer_.begin(request.camera, plan,
                     {plan::shortened(request.paths, request.shown_pass), request.seed, request.filter_width,
                      request.transparent_film, request.shadow_resolution},
                     scene, gpu_scene_, traced_.triangles(), film::with_divisors(filmed(request)));
}

void RenderThread::render_sample(const Job& job, uint32_t index) {
  const RenderRequest& request = job.request();
  if (traces_paths(request)) {
    const Clock::time_point start = Clock::now();
    const int64_t before = path_tracer_.rays();
    path_tracer_.render_sample(index, index == request.first_sample,
                               {gpu_scene_, traced_.tracer(), traced_.triangles()}, film_,
                               job.cancelled_);
    traced_.note_rays(path_tracer_.rays() - before, ms_since(start));
    return;
  }
  if (request.debug_picture == ray_picture::Kind::kNone) {
    realtime::Surroundings around{gpu_scene_};
    if (traced_.built()) {
      around.tracer = &traced_.tracer();
      around.triangles = &traced_.triangles();
    }
    realtime_.render_sample(index, request.first_sample, sharing(request, index), around, film_,
                            job.cancelled_);
    return;
  }
  const Clock::time_point start = Clock::now();
  ray_picture_.render(request.camera, request.debug_picture, traced_.tracer(), traced_.triangles(),
                      film_, programs_, timer_, job.cancelled_);
  glFinish();
  traced_.note_rays(int64_t(request.camera.width) * request.camera.height, ms_since(start));
}

void RenderThread::render_frame(Job& job, SharedScene& shared) {
  const Clock::time_point start = Clock::now();
  const RenderRequest& request = job.request();
  timer_.reset();
  mixture_error_.reset();

  // Take over what changed. The plan is made from the same state of the scene.
  job.set_status("uploading the scene", 0);
  const uint32_t wanted = request.last_sample - request.first_sample;
  const bool debug = request.debug_picture != ray_picture::Kind::kNone;
  const bool paths = traces_paths(request);
  const bool mixes = !job.over_.smooth.empty();
  // Errors are those of Combined.
  const bool estimates = (wanted > 1 || mixes) && !debug && request.shown_pass == film::Pass::kCombined;
  plan::Effects plan;
  std::vector<std::string> warnings;
  bool traces = false;
  {
    const SharedScene::Hold held = shared.hold();
    scene::Scene& scene = *held;
    gpu_scene_.update(scene);
    plan = plan_of(request, scene);
    denoises_ = !debug && plan::runs(plan, "denoiser");
    if (!denoises_) denoise_.release();
    film_.start(request.camera.width, request.camera.height, filmed(request),
                {.moments = estimates,
                 .pieces = request.pieces,
                 // Real-time renders all pixels, and stops when the whole picture is good enough.
                 .noise_threshold = paths && estimates ? request.noise_threshold : 0});
    job.set_status(debug ? "gathering triangles" : "compiling shaders", 0);
    traces = debug || paths || plan::runs(plan, "specular_rays");
    if (traces || plan::runs(plan, "radiance_cache"))
      traced_.update(scene, gpu_scene_, programs_, timer_);
    else
      traced_.release();
    if (!traces) traced_.release_structure();
    if (paths) begin_paths(request, plan, scene);
    if (!debug && !paths) begin_realtime(request, plan, scene);
    warnings = scene.warnings();
  }
  if (traces) {
    job.set_status("building the structure for rays", 0);
    const int64_t pixels = int64_t(request.camera.width) * request.camera.height;
    StructureSettings structure = request.structure;
    if (request.method == Method::kFragment) structure.structure = Structure::kFragments;
    traced_.build(structure, request.camera, paths ? pixels * wanted * kRaysOfPath : pixels, programs_,
                  timer_);
  }
  for (const std::string& warning : gpu_scene_.warnings()) warnings.push_back(warning);
  for (const std::string& warning : traced_.warnings()) warnings.push_back(warning);
  if (paths)
    for (const std::string& warning : path_tracer_.warnings()) warnings.push_back(warning);
  glFinish();
  gl::check_errors("upload");
  const double build_ms = ms_since(start);

  const Clock::time_point trace_start = Clock::now();
  Clock::time_point last_live = start;
  double live_ms = 0;  // that showing the picture took
  uint32_t done = 0, error_at = 1;
  std::optional<double> live_error;
  const auto so_far = [&](std::optional<double> error) {
    RenderStats stats;
    stats.trace_ms = ms_since(trace_start);
    const std::vector<gl::PassTime> times = timer_.times();
    stats.device = context_.device().renderer;
    stats.width = request.camera.width;
    stats.height = request.camera.height;
    stats.samples = done;
    if (!debug && !paths) realtime_.amend(plan);
    stats.effects = report(plan, times);
    for (const gl::PassTime& time : times) stats.passes.emplace_back(time.name, time.ms);
    stats.build_ms = build_ms;
    stats.total_ms = ms_since(start);
    stats.rays = debug   ? int64_t(done) * stats.width * stats.height
                 : paths ? path_tracer_.rays()
                         : realtime_.rays();
    stats.memory_bytes = gl::counters().memory_bytes;
    stats.estimated_error = error;
    stats.warnings = warnings;
    return stats;
  };
  while (done < wanted) {
    job.set_status(fmt::format("sample {} of {}", done + 1, wanted), float(done) / float(wanted));
    try {
      render_sample(job, request.first_sample + done);
    } catch (const Cancelled&) {
      // The samples before are whole, unless this one has begun to join them.
      if (done == 0 || (paths && path_tracer_.torn())) throw;
      break;
    }
    film_.end_sample(request.first_sample + done);
    ++done;
    gl::check_errors("render");
    if (done == 1) {
      compiled_.insert(running(plan));
      glFinish();
      job.end_first_sample();
    }
    if (!film_.all_active() && film_.active_count() == 0) break;
    // The last sample's picture follows with all passes.
    const bool due = done == 1 || ms_since(last_live) > std::max(kLiveIntervalMs, kLiveShare * live_ms);
    if (request.live && due && done < wanted) {
      // It changes slowly, and is not worth a copy of the film each time.
      if (!mixes && done >= 2 * error_at) {
        live_error = film_.estimated_error();
        error_at = done;
      }
      // Before the picture: who sees that finds its statistics.
      job.tell(so_far(mixes ? mixture_error_ : live_error));
      const Clock::time_point shows = Clock::now();
      publish_live(job);
      last_live = Clock::now();
      live_ms = ms_since(shows);
    }
    // Stop before a sample that would overrun the budget.
    const double spent = ms_since(start), each = ms_since(trace_start) / done;
    if (request.time_budget > 0 && spent + each > request.time_budget * 1000) break;
    if (request.noise_threshold > 0 && film_.all_active() && done % kErrorInterval == 0 &&
        done < wanted) {
      const std::optional<double> error = film_.estimated_error();
      if (error && *error < request.noise_threshold) break;
    }
  }
  glFinish();

  RenderStats stats = so_far(std::nullopt);
  publish(job, request.passes);
  if (mixes)
    mix(job);
  else if (denoises_)
    publish_denoised(job);
  if (denoises_) {
    stats = so_far(std::nullopt);  // with the time that it took
    if (!denoise_.warning().empty()) stats.warnings.push_back(denoise_.warning());
  }
  stats.total_ms = ms_since(start);
  stats.estimated_error = mixes || denoises_ ? mixture_error_ : film_.estimated_error();
  if (!debug && !paths) {
    stats.cache = realtime_.cache_occupied();
    if (std::string warning = realtime_.cache_warning(); !warning.empty())
      stats.warnings.push_back(std::move(warning));
  }
  if (const uint32_t spoiled = film_.spoiled_samples(); spoiled > 0)
    stats.warnings.push_back(fmt::format("{} samples of pixels were infinite or no number and count as black: "
                                         "look for extreme values in materials, lamps and the world",
                                         spoiled));
  job.set_status("done", 1);
  std::shared_ptr<const film::Pieces> pieces;
  if (request.pieces)
    pieces = std::make_shared<film::Pieces>(film_.take_pieces(request.exposure));
  std::lock_guard lock(job.mutex_);
  job.pieces_ = std::move(pieces);
  job.stats_ = std::move(stats);
}

}  // namespace panoptes::engine
