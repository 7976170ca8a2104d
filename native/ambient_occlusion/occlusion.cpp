#include "ambient_occlusion/occlusion.h"

#include "ambient_occlusion/occlusion_shared.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace panoptes::ambient_occlusion {

namespace {

// Pixels that the choice of views asks, at least; fewer where the picture has not so many.
constexpr int kProbes = 4096;
// Lamps that the choice looks at, in the scene's order: each is estimated at every probe.
constexpr uint32_t kMostCandidates = 64;
// Lamps whose maps deepen shadows, the first that cast any.
constexpr size_t kDeepLamps = 4;
// A view that changes occlusion by less on average reveals nothing.
constexpr float kLeastContribution = 0.002f;
// Elevations below are the surface itself: its curvature, and rounding.
constexpr float kLeastSine = 0.02f;
// Pixels along a side of a work group of sample.comp.
constexpr int kTile = 16;

// b of (4.2), section 4.4.3.
float distance_share(Estimator estimator) { return estimator == Estimator::kSsao ? 1.0f : 0.85f; }

// How far occluders are looked for: no farther than anything is from anything else, since points
// beyond would be open whatever stands there.
float reach_of(const Settings& settings, const scene::Bounds& bounds) {
  const float longest = glm::length(bounds.high - bounds.low);
  return longest > 0 && std::isfinite(longest) ? std::min(settings.distance, longest)
                                               : settings.distance;
}

void want(gl::Texture& texture, bool wanted, const gl::TextureOptions& options) {
  const gl::TextureOptions& has = texture.options();
  const bool fits = texture && has.width == options.width && has.height == options.height &&
                    has.layers >= options.layers;
  if (wanted && fits) return;
  texture = gl::Texture();
  if (wanted) texture = gl::Texture(options);
}

}  // namespace

void AmbientOcclusion::begin(const gpu_scene::Camera& camera, const Settings& settings,
                             const plan::Effects& plan, uint32_t seed) {
  settings_ = settings;
  camera_ = camera;
  if (seed != seed_) phantom_revision_ = -1;  // alpha has other thresholds
  seed_ = seed;
  runs_ = plan::runs(plan, "ambient_occlusion");
  bent_ = runs_ && plan::runs(plan, "bent_normals");
  filter_ = runs_ && plan::runs(plan, "occlusion_filter");
  lamp_views_ = runs_ && settings.secondary_views > 0 && plan::runs(plan, "occlusion_lamp_views");
  deep_shadows_ = runs_ && plan::runs(plan, "deep_shadows");
  phantom_views_ = runs_ && plan::runs(plan, "occlusion_phantom_views") &&
                   (settings.phantoms != Phantoms::kOff || settings.phantom_camera_count > 0);
  allocate();
}

void AmbientOcclusion::release() {
  runs_ = bent_ = filter_ = lamp_views_ = deep_shadows_ = phantom_views_ = false;
  allocate();
}

void AmbientOcclusion::allocate() {
  decided_ = false;
  lamps_.clear();
  deep_lamps_.clear();
  phantoms_ = false;
  const auto image = [&](int layers) {
    return gl::TextureOptions{GLenum(layers ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D), GL_RGBA16F,
                              camera_.width, camera_.height, std::max(layers, 1), 1};
  };
  want(combined_, runs_, image(0));
  want(filtered_, filter_, image(0));
  want(deep_, deep_shadows_, image(0));
  if (!runs_) estimates_ = gl::Texture();
  if (!bent_) closed_ = gl::Texture();
  if (!phantom_views_) phantom_maps_.release();
}

SampleOptions AmbientOcclusion::options_for(const View& view, bool probes) const {
  return {.estimator = settings_.estimator,
          .view = view.kind,
          .cube = view.cube,
          .cascades = !view.cube && view.faces.size() > 1,
          .importance_sampling = settings_.importance_sampling && !probes &&
                                 settings_.estimator != Estimator::kHbao,
          .bent_normals = bent_ && !probes,
          .probes = probes};
}

void AmbientOcclusion::bind_view(const View& view, const Sample& sample, int layer, int views,
                                 int stride, const SampleOptions& options) {
  const bool hbao = settings_.estimator == Estimator::kHbao && !options.obscurance;
  const int most = hbao ? kHbaoSlices * kHbaoSteps : settings_.samples;
  shared::OcclusionView block{};
  // Obscurance is weighted by direction alone: where a view is blocked is what it shows.
  const float share = options.obscurance ? 0.0f : distance_share(settings_.estimator);
  const float reach = reach_of(settings_, sample.bounds);
  block.range = {reach, 1.0f / reach, share, kLeastSine};
  block.samples = {uint32_t(most), uint32_t(settings_.initial_samples),
                   sample.index * uint32_t(hbao ? 1 : most), seed_};
  block.place = {uint32_t(layer), uint32_t(view.faces.size()), uint32_t(stride), uint32_t(views)};
  std::copy_n(view.faces.begin(), std::min(view.faces.size(), std::size(block.faces)), block.faces);
  if (!block_) block_ = gl::Buffer(sizeof block);
  block_.write(0, int64_t(sizeof block - sizeof block.faces + view.faces.size() * sizeof block.faces[0]),
               &block);

  programs_.get(sample_program(options)).use();
  sample.g_buffer.bind_surfaces();
  sample.g_buffer.depth().bind(1);
  glBindSampler(1, 0);
  glBindBufferBase(GL_UNIFORM_BUFFER, 1, block_.id());
  switch (view.kind) {
    case ViewKind::kCamera: sample.g_buffer.depth().bind(0); break;
    case ViewKind::kLamp: sample.maps->bind(0); break;
    case ViewKind::kPhantom: phantom_maps_.bind(0); break;
  }
  glBindSampler(0, 0);
}

std::vector<View> AmbientOcclusion::views_of(const Sample& sample) {
  std::vector<View> views{ambient_occlusion::camera_view(camera_, sample.jitter)};
  for (uint32_t lamp : lamps_)
    if (std::optional<View> view = lamp_view(*sample.lights, lamp)) views.push_back(*view);
  if (phantoms_)
    for (View& view : phantom_maps_.views(glm::inverse(camera_.world_to_camera)[3]))
      views.push_back(std::move(view));
  return views;
}

std::vector<Estimate> AmbientOcclusion::probe(const Sample& sample, const std::vector<View>& views) {
  const int pixels = camera_.width * camera_.height;
  const int stride = std::max(pixels / kProbes, 1), probes = (pixels + stride - 1) / stride;
  gl::Buffer buffer(int64_t(probes) * int64_t(views.size()) * int64_t(sizeof(shared::OcclusionProbe)));
  buffer.clear();
  for (size_t k = 0; k < views.size(); ++k) {
    bind_view(views[k], sample, int(k), int(views.size()), stride, options_for(views[k], true));
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, buffer.id());
    glDispatchCompute(GLuint(probes + kTile * kTile - 1) / (kTile * kTile), 1, 1);
  }
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  std::vector<shared::OcclusionProbe> found(size_t(probes) * views.size());
  buffer.read(0, buffer.bytes(), found.data());
  std::vector<Estimate> estimates;
  std::vector<float> depths;
  for (size_t i = 0; i < found.size(); ++i) {
    if (!found[i - i % views.size()].covered) continue;
    estimates.push_back({found[i].occlusion, found[i].weight});
    if (i % views.size() == 0) depths.push_back(found[i].depth);
  }
  if (!depths.empty()) {
    const auto middle = depths.begin() + std::ptrdiff_t(depths.size() / 2);
    std::nth_element(depths.begin(), middle, depths.end());
    focus_ = *middle;
  }
  return estimates;
}

void AmbientOcclusion::choose(const Sample& sample) {
  gl::PassScope scope(timer_, "ambient_occlusion_choice");
  decided_ = true;
  std::vector<View> views{ambient_occlusion::camera_view(camera_, sample.jitter)};
  std::vector<uint32_t> candidates;
  if ((lamp_views_ || deep_shadows_) && sample.lights && !sample.lights->batches.empty()) {
    const rasterize::LightBatch& batch = sample.lights->batches.front();
    for (uint32_t i = 0; i < batch.light_count && candidates.size() < kMostCandidates; ++i)
      if (std::optional<View> view = lamp_view(*sample.lights, batch.first_light + i)) {
        views.push_back(*view);
        candidates.push_back(batch.first_light + i);
      }
  }
  if (deep_shadows_)
    deep_lamps_.assign(candidates.begin(), candidates.begin() + std::ptrdiff_t(std::min<size_t>(
                                               candidates.size(), kDeepLamps)));
  if (!lamp_views_) {
    candidates.clear();
    views.resize(1);
  }
  const bool pair = phantom_views_ && settings_.phantom_camera_count == 0;
  // What there is no choice in needs no probes.
  if (candidates.empty() && !pair) {
    phantoms_ = phantom_views_;
    return;
  }
  const std::vector<Estimate> estimates = probe(sample, views);
  const std::vector<int> chosen =
      choose_views(estimates, int(views.size()), settings_.secondary_views, kLeastContribution);
  for (int view : chosen) lamps_.push_back(candidates[size_t(view - 1)]);
  coverage_ = coverage(estimates, int(views.size()), chosen);
  phantoms_ = phantom_views_ && (settings_.phantoms != Phantoms::kAuto || !pair || coverage_ < kCovered);
  if (!phantoms_) phantom_maps_.release();
}

void AmbientOcclusion::draw_phantoms(const Sample& sample) {
  const std::vector<gpu_scene::LightView> from =
      settings_.phantom_camera_count > 0 ? phantom_cameras(settings_)
                                         : phantom_pair(camera_, focus_, sample.bounds);
  // Maps hold for the next sample and frame unless something moved: alpha has the thresholds of the
  // picture's first sample.
  shared::View view = sample.view;
  view.size.z = 0;
  const bool keep = phantom_revision_ == sample.scene.shadow_revision() && phantom_cut_ == view.alpha.x;
  phantom_cut_ = view.alpha.x;
  phantom_maps_.render(from, settings_.phantom_resolution, view, sample.scene, programs_, timer_,
                       sample.view_block, keep);
  phantom_revision_ = sample.scene.shadow_revision();
  sample.view_block.set(sample.view);
}

void AmbientOcclusion::estimate(const Sample& sample) {
  if (phantoms_) draw_phantoms(sample);
  const std::vector<View> views = views_of(sample);
  views_ = int(views.size());
  const int deep = int(deep_lamps_.size());
  const gl::TextureOptions layers{GL_TEXTURE_2D_ARRAY, GL_RGBA16F,     camera_.width,
                                  camera_.height,      views_ + deep, 1};
  want(estimates_, true, layers);
  want(closed_, bent_, layers);
  for (int k = 0; k < views_; ++k) {
    const View& view = views[size_t(k)];
    constexpr const char* kNames[] = {"ambient_occlusion_camera", "occlusion_lamp_views",
                                      "occlusion_phantom_views"};
    gl::PassScope scope(timer_, kNames[int(view.kind)]);
    estimate_view(view, sample, k, options_for(view, false));
  }
  if (deep_shadows_) estimate_deep_shadows(sample);
  {
    gl::PassScope scope(timer_, "ambient_occlusion_combine");
    combine(sample, 0, views_, bent_, combined_);
  }
  if (!filter_) return;
  gl::PassScope scope(timer_, "occlusion_filter");
  filter(sample, combined_);
}

void AmbientOcclusion::estimate_deep_shadows(const Sample& sample) {
  gl::PassScope scope(timer_, "deep_shadows");
  int layer = views_;
  for (uint32_t lamp : deep_lamps_) {
    const std::optional<View> view = lamp_view(*sample.lights, lamp);
    if (!view) continue;
    SampleOptions options = options_for(*view, false);
    options.obscurance = true;
    options.importance_sampling = options.bent_normals = false;
    estimate_view(*view, sample, layer++, options);
  }
  if (layer == views_) {
    // No map shows anything in this sample: nothing is darkened.
    const float open[4] = {0, 0, 0, 1};
    glClearTexImage(deep_.id(), 0, GL_RGBA, GL_FLOAT, open);
    return;
  }
  combine(sample, views_, layer, false, deep_);
  if (filter_) filter(sample, deep_);
}

void AmbientOcclusion::estimate_view(const View& view, const Sample& sample, int layer,
                                     const SampleOptions& options) {
  // Phantom views come last, and ask what others have seen.
  const int earlier = std::min(layer, 1 + int(lamps_.size()));
  bind_view(view, sample, layer, earlier, 1, options);
  estimates_.bind_image(0, GL_WRITE_ONLY);
  if (options.bent_normals) closed_.bind_image(1, GL_WRITE_ONLY);
  if (view.kind == ViewKind::kPhantom) {
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    estimates_.bind(2);
    glBindSampler(2, 0);
  }
  glDispatchCompute(GLuint(camera_.width + kTile - 1) / kTile,
                    GLuint(camera_.height + kTile - 1) / kTile, 1);
}

void AmbientOcclusion::combine(const Sample& sample, int first, int last, bool bent,
                               const gl::Texture& target) {
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  programs_.get(combine_program(bent)).use();
  sample.g_buffer.bind_bins();
  sample.g_buffer.bind_surfaces();
  estimates_.bind(0);
  if (bent) closed_.bind(1);
  target.bind_image(0, GL_WRITE_ONLY);
  glUniform2i(2, first, last);
  sample.g_buffer.dispatch_surfaces();
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

void AmbientOcclusion::filter(const Sample& sample, const gl::Texture& target) {
  programs_.get(filter_program()).use();
  sample.g_buffer.bind_bins();
  sample.g_buffer.bind_surfaces();
  sample.g_buffer.depth().bind(1);
  glUniform1f(3, reach_of(settings_, sample.bounds));
  const std::array<std::pair<const gl::Texture*, const gl::Texture*>, 2> passes{
      {{&target, &filtered_}, {&filtered_, &target}}};
  for (int axis = 0; axis < 2; ++axis) {
    passes[size_t(axis)].first->bind(0);
    passes[size_t(axis)].second->bind_image(0, GL_WRITE_ONLY);
    glUniform2i(2, axis == 0 ? 1 : 0, axis == 0 ? 0 : 1);
    sample.g_buffer.dispatch_surfaces();
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  }
}

void AmbientOcclusion::bind_picture() const {
  estimates_.bind(0);
  combined_.bind(1);
  glUniform1i(2, views_);
}

void AmbientOcclusion::amend(plan::Effects& plan) const {
  if (!runs_ || !decided_) return;
  for (plan::Effect& effect : plan) {
    if (effect.name == "occlusion_lamp_views" && lamp_views_) {
      effect.runs = !lamps_.empty();
      effect.reason = lamps_.empty() ? "no lamp's shadow map shows more than the camera"
                                     : fmt::format("{} lamp{} what the camera does not see",
                                                   lamps_.size(), lamps_.size() > 1 ? "s show" : " shows");
    }
    if (effect.name == "occlusion_phantom_views" && phantom_views_ &&
        settings_.phantoms == Phantoms::kAuto && settings_.phantom_camera_count == 0) {
      effect.runs = phantoms_;
      effect.reason = fmt::format("other views cover {:.0f} % of the picture", 100 * coverage_);
    }
  }
}

}  // namespace panoptes::ambient_occlusion
