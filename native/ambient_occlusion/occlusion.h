// Multiview ambient occlusion (thesis, chapter 4): how much of the hemisphere over each visible
// surface is blocked nearby, as the camera, lamps' shadow maps and phantom views see it.
//
// Each view is estimated for itself into a layer of `estimates_`, by as many samples as it seems worth
// (section 4.3.2); their weighted mean is the occlusion (4.1), so the order of views does not matter.
#pragma once

#include "ambient_occlusion/choice.h"
#include "ambient_occlusion/phantoms.h"
#include "ambient_occlusion/settings.h"
#include "ambient_occlusion/views.h"
#include "film/film.h"
#include "gl/pass_timer.h"
#include "gl/program.h"
#include "plan/effect.h"
#include "rasterize/g_buffer.h"
#include "rasterize/shadow_maps.h"

#include <vector>

namespace panoptes::ambient_occlusion {

// Programs, for the frame and for the shader validation.
struct SampleOptions {
  Estimator estimator = Estimator::kAlchemy;
  bool obscurance = false;  // volumetric, in place of the estimator
  ViewKind view = ViewKind::kCamera;
  bool cube = false, cascades = false;
  bool importance_sampling = false, bent_normals = false, probes = false;
};
gl::ProgramSource sample_program(const SampleOptions& options);
gl::ProgramSource combine_program(bool bent_normals);
gl::ProgramSource filter_program();
gl::ProgramSource picture_program(Picture picture, const film::Film& film);

class AmbientOcclusion {
 public:
  AmbientOcclusion(gl::ProgramCache& programs, gl::PassTimer& timer)
      : programs_(programs), timer_(timer) {}

  // Prepares for a frame: allocates what the plan runs and releases what it does not.
  void begin(const gpu_scene::Camera& camera, const Settings& settings, const plan::Effects& plan,
             uint32_t seed);
  // What begin() does for a plan that runs none of it.
  void release();
  bool runs() const { return runs_; }

  // What a sample of the film sees. The lamps' maps hold the first batch of `lights`.
  struct Sample {
    uint32_t index = 0;      // of the film
    glm::dvec2 jitter{0};    // of the camera, pixels
    const shared::View& view;
    const rasterize::GBuffer& g_buffer;
    const rasterize::LightSet* lights = nullptr;  // none: no lamp casts shadows
    const rasterize::ShadowMaps* maps = nullptr;
    const gpu_scene::GpuScene& scene;
    scene::Bounds bounds;
    gpu_scene::ViewBlock& view_block;  // holds `view`, before and afterwards
  };

  // True until choose() was called for the frame, where there is something to choose.
  bool undecided() const { return runs_ && !decided_; }
  // Chooses the views of the frame by its sample 0.
  void choose(const Sample& sample);
  // Finds the occlusion of the sample's pixels.
  void estimate(const Sample& sample);

  // Bent normals (world axes, unit; without them the surface's own) and visibility, 0..1, where
  // there are surfaces.
  const gl::Texture& combined() const { return combined_; }
  // The same of deep shadows, where the plan runs them: visibility only.
  const gl::Texture& deep_shadows() const { return deep_; }
  // Binds what picture_program() reads.
  void bind_picture() const;
  // Writes into the plan what choose() found.
  void amend(plan::Effects& plan) const;

 private:
  void allocate();
  std::vector<View> views_of(const Sample& sample);
  void draw_phantoms(const Sample& sample);
  void bind_view(const View& view, const Sample& sample, int layer, int views, int stride,
                 const SampleOptions& options);
  SampleOptions options_for(const View& view, bool probes) const;
  // Of every probe that shows a surface, by every view; finds focus_.
  std::vector<Estimate> probe(const Sample& sample, const std::vector<View>& views);
  void estimate_view(const View& view, const Sample& sample, int layer,
                     const SampleOptions& options);
  // Views `first` to before `last` into `target`.
  void combine(const Sample& sample, int first, int last, bool bent, const gl::Texture& target);
  void estimate_deep_shadows(const Sample& sample);
  void filter(const Sample& sample, const gl::Texture& target);

  gl::ProgramCache& programs_;
  gl::PassTimer& timer_;
  Settings settings_;
  gpu_scene::Camera camera_;
  uint32_t seed_ = 0;
  bool runs_ = false, bent_ = false, filter_ = false, lamp_views_ = false, phantom_views_ = false;
  bool deep_shadows_ = false;

  bool decided_ = false;
  std::vector<uint32_t> lamps_;  // in the light set, largest contribution first
  std::vector<uint32_t> deep_lamps_;
  bool phantoms_ = false;
  double focus_ = 0;             // median depth of what is seen, metres
  float coverage_ = 0;

  PhantomMaps phantom_maps_;
  int64_t phantom_revision_ = -1;
  float phantom_cut_ = 0;        // the alpha threshold that they were drawn with
  int views_ = 0;                // of the last sample
  gl::Texture estimates_, closed_, combined_, filtered_, deep_;
  gl::Buffer block_;
};

}  // namespace panoptes::ambient_occlusion
