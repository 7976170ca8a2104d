#include "engine/traced_scene.h"

#include "engine/tracers.h"

#include <fmt/format.h>

#include <array>
#include <chrono>

namespace panoptes::engine {

void TracedScene::update(const scene::Scene& scene, const gpu_scene::GpuScene& gpu,
                         gl::ProgramCache& programs, gl::PassTimer& timer) {
  if (!triangles_) triangles_.emplace(device_);
  // Only a list that was written whole is built over.
  const bool held = built_;
  built_ = false;
  built_ = !triangles_->update(scene, gpu, programs, timer) && held;
}

Structure TracedScene::choose(int64_t rays) const {
  const std::array<std::string, 2> candidates{name_of(Structure::kOrthographic),
                                              name_of(Structure::kBvh)};
  return find_structure(costs_.choose(candidates, built_ ? name_of(made_.structure) : "",
                                      triangles_->count(), rays));
}

void TracedScene::build(const StructureSettings& settings, const gpu_scene::Camera& camera,
                        int64_t rays, gl::ProgramCache& programs, gl::PassTimer& timer) {
  StructureSettings wanted = settings;
  if (wanted.structure == Structure::kAuto) wanted.structure = choose(rays);
  // A view's structure holds for one camera, and for one origin of the list.
  const bool views = wanted.structure == Structure::kView || wanted.structure == Structure::kFragments;
  const bool moved = views && (!built_ || made_for_.world_to_camera != camera.world_to_camera ||
                               made_for_.projection != camera.projection || made_for_.width != camera.width ||
                               made_for_.height != camera.height);
  const bool fresh = !tracer_ || made_ != wanted || moved;
  if (fresh) {
    tracer_.reset();  // before the other takes its memory
    tracer_ = make_tracer(wanted, device_, camera, triangles_->origin());
    made_ = wanted;
    made_for_ = camera;
    built_ = warm_ = false;
  }
  if (built_) return;
  glFinish();
  const auto start = std::chrono::steady_clock::now();
  tracer_->build(*triangles_, programs, timer);
  glFinish();
  built_ = true;
  // A first build compiles programs and grows pools, which says nothing of the next.
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  if (!fresh) costs_.add_build(name_of(made_.structure), triangles_->count(), took.count());
}

void TracedScene::note_rays(int64_t rays, double ms) {
  if (warm_) costs_.add_trace(name_of(made_.structure), rays, ms);
  warm_ = true;
}

void TracedScene::release() {
  release_structure();
  triangles_.reset();
}

void TracedScene::release_structure() {
  tracer_.reset();
  built_ = false;
}

std::vector<std::string> TracedScene::warnings() const {
  if (!triangles_ || triangles_->lost() == 0) return {};
  return {fmt::format("Rays meet all but {} of {} triangles, which are not finite or lie too far from "
                      "the others: check the scale of objects and their modifiers.",
                      triangles_->lost(), triangles_->count())};
}

}  // namespace panoptes::engine
