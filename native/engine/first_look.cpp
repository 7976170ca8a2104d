// The first picture of effects whose programs may have to be compiled.
#include "engine/render_thread.h"
#include "plan/plan.h"

namespace panoptes::engine {

namespace {

// What every scene needs: surfaces, lamps and the world, without what is gathered from around.
RenderRequest simplest(RenderRequest request) {
  request.first_sample = 0;
  request.last_sample = 1;
  request.passes.reset();
  request.passes.set(size_t(film::Pass::kCombined));
  request.occlusion.strength = 0;
  request.occlusion.picture = ambient_occlusion::Picture::kNone;
  request.cache.enabled = false;
  request.cache.picture = radiance_cache::Picture::kNone;
  request.specular_rays.mode = specular_rays::Mode::kOff;
  request.filter_penumbrae = false;
  request.noise_threshold = request.time_budget = 0;
  return request;
}

}  // namespace

std::vector<bool> RenderThread::running(const plan::Effects& plan) {
  std::vector<bool> found;
  for (const plan::Effect& effect : plan) found.push_back(effect.runs);
  return found;
}

void RenderThread::look_first(Job& job, SharedScene& shared) {
  const RenderRequest& request = job.request();
  const RenderRequest simple = simplest(request);
  {
    const SharedScene::Hold held = shared.hold();
    const std::vector<bool> effects = running(plan_of(request, *held));
    const plan::Effects plan = plan_of(simple, *held);
    if (compiled_.count(effects) || running(plan) == effects) return;
    job.set_status("compiling shaders", 0);
    gpu_scene_.update(*held);
    film_.start(request.camera.width, request.camera.height, simple.passes);
    begin_realtime(simple, plan, *held);
  }
  realtime_.render_sample(0, 0, 1, {gpu_scene_}, film_, job.cancelled_);
  film_.end_sample(0);
  gl::check_errors("render");
  job.look(film_.read(film::Pass::kCombined, request.exposure));
}

}  // namespace panoptes::engine
