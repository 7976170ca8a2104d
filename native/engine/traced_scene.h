// The scene as rays meet it: the list of its triangles and a tracer's structure over them. Both are
// kept from frame to frame while geometry rests, whatever the camera does.
#pragma once

#include "engine/structure.h"
#include "gl/context.h"
#include "gl/pass_timer.h"
#include "gl/program.h"
#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/view.h"
#include "scene/scene.h"
#include "tracing/cost_book.h"
#include "tracing/tracer.h"
#include "tracing/triangle_list.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace panoptes::engine {

class TracedScene {
 public:
  explicit TracedScene(const gl::DeviceInfo& device) : device_(device) {}

  // Brings the list of triangles up to date with `scene`, of which `gpu` is.
  void update(const scene::Scene& scene, const gpu_scene::GpuScene& gpu, gl::ProgramCache& programs,
              gl::PassTimer& timer);
  // Builds the structure that `settings` ask for, if it does not hold the list as it is now. kAuto
  // takes the one that will have cost least after about `rays` rays; kView and kFragments are made for
  // `camera`.
  void build(const StructureSettings& settings, const gpu_scene::Camera& camera, int64_t rays,
             gl::ProgramCache& programs, gl::PassTimer& timer);
  // What so many rays took, for later choices. The first after another structure was made do not
  // count, since they have compiled programs.
  void note_rays(int64_t rays, double ms);
  // Frees both, or the structure alone.
  void release();
  void release_structure();

  bool built() const { return built_; }
  // Only after update() and build().
  const tracing::TriangleList& triangles() const { return *triangles_; }
  const tracing::Tracer& tracer() const { return *tracer_; }
  // What rays do not meet as the scene asks for, for the artist.
  std::vector<std::string> warnings() const;

 private:
  static std::string name_of(Structure structure) {
    return std::string(kStructureNames[size_t(structure)]);
  }
  Structure choose(int64_t rays) const;

  gl::DeviceInfo device_;
  std::optional<tracing::TriangleList> triangles_;
  std::unique_ptr<tracing::Tracer> tracer_;
  StructureSettings made_;  // what tracer_ was made for
  gpu_scene::Camera made_for_;
  bool built_ = false;
  bool warm_ = false;       // has traced
  tracing::CostBook costs_;
};

}  // namespace panoptes::engine
