// What lives on the render thread: the context and all that was made in it.
#pragma once

#include "denoise/denoiser.h"
#include "engine/engine.h"
#include "engine/traced_scene.h"
#include "film/film.h"
#include "gl/pass_timer.h"
#include "gl/program.h"
#include "gpu_scene/gpu_scene.h"
#include "path_tracer/path_tracer.h"
#include "ray_picture/ray_picture.h"
#include "realtime/realtime.h"

#include <set>
#include <vector>

namespace panoptes::engine {

class RenderThread {
 public:
  explicit RenderThread(const gl::ContextOptions& options);

  const gl::DeviceInfo& device() const { return context_.device(); }

  // Renders the job and ends it, whatever happens. Holds the scene only while it is uploaded. Before the job ends,
  // `spoiled` becomes true if the driver has failed.
  void render(Job& job, SharedScene& scene, std::atomic<bool>& spoiled);
  // Uploads an image that waits, if there is one; what fails is left for the frame that needs it.
  bool upload_ahead(SharedScene& scene);

 private:
  void render_frame(Job& job, SharedScene& shared);
  static plan::Effects plan_of(const RenderRequest& request, const scene::Scene& scene);
  // Which effects of a plan run.
  static std::vector<bool> running(const plan::Effects& plan);
  // Where the job is one of a 3D View and its effects have never run: shows the scene without the rarer
  // ones, while the driver has not yet compiled their programs.
  void look_first(Job& job, SharedScene& shared);
  // Prepares for a frame that shows the scene, and frees what rays need.
  void begin_realtime(const RenderRequest& request, const plan::Effects& plan, scene::Scene& scene);
  void begin_paths(const RenderRequest& request, const plan::Effects& plan, scene::Scene& scene);
  void render_sample(const Job& job, uint32_t index);
  void publish(Job& job, const film::PassSet& passes);
  // Combined, and what is shown of it.
  void publish_live(Job& job);
  // The passes that the film sums: those that the request asks for, and what the denoiser needs.
  film::PassSet filmed(const RenderRequest& request) const;
  // The denoised picture of `paths`, with the noise that it has.
  film::Mixture denoised(const Job& job, const film::Mixture& paths);
  // Shows what lies between the picture that the request has and that of paths so far, which is denoised if wanted.
  void mix(Job& job);
  // In place of Combined.
  void publish_denoised(Job& job);

  // Declared first, destroyed last: everything below holds GL objects.
  gl::Context context_;
  gl::ProgramCache programs_;
  gl::PassTimer timer_;
  gpu_scene::GpuScene gpu_scene_;
  film::Film film_;
  std::optional<double> mixture_error_;  // of the frame under way
  realtime::Realtime realtime_;
  TracedScene traced_;
  ray_picture::RayPicture ray_picture_;
  path_tracer::PathTracer path_tracer_;
  denoise::Denoise denoise_;
  bool denoises_ = false;  // in the frame under way
  std::set<std::vector<bool>> compiled_;  // the effects of frames that have been rendered
};

}  // namespace panoptes::engine
