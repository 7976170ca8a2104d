#include "engine/traced_scene.h"

#include "engine/tracers.h"

#include <fmt/format.h>

namespace panoptes::engine {

void TracedScene::update(const scene::Scene& scene, const gpu_scene::GpuScene& gpu,
                         gl::ProgramCache& programs, gl::PassTimer& timer) {
  if (!triangles_) triangles_.emplace(device_);
  // Only a list that was written whole is built over.
  const bool held = built_;
  built_ = false;
  built_ = !triangles_->update(scene, gpu, programs, timer) && held;
}

void TracedScene::build(const std::string& tracer, gl::ProgramCache& programs,
                        gl::PassTimer& timer) {
  if (!tracer_ || name_ != tracer) {
    tracer_.reset();  // before the other takes its memory
    tracer_ = make_tracer(tracer, device_);
    name_ = tracer;
    built_ = false;
  }
  if (built_) return;
  tracer_->build(*triangles_, programs, timer);
  built_ = true;
}

void TracedScene::release() {
  tracer_.reset();
  triangles_.reset();
  built_ = false;
}

std::vector<std::string> TracedScene::warnings() const {
  if (!triangles_ || triangles_->lost() == 0) return {};
  return {fmt::format("Rays meet all but {} of {} triangles, which are not finite or lie too far from "
                      "the others: check the scale of objects and their modifiers.",
                      triangles_->lost(), triangles_->count())};
}

}  // namespace panoptes::engine
