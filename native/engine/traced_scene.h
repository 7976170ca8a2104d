// The scene as rays meet it: the list of its triangles and a tracer's structure over them. Both are
// kept from frame to frame while geometry rests, whatever the camera does.
#pragma once

#include "gl/context.h"
#include "gl/pass_timer.h"
#include "gl/program.h"
#include "gpu_scene/gpu_scene.h"
#include "scene/scene.h"
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
  // Builds the structure of the tracer of that name, if it does not hold the list as it is now.
  void build(const std::string& tracer, gl::ProgramCache& programs, gl::PassTimer& timer);
  // Frees both.
  void release();

  const tracing::TriangleList& triangles() const { return *triangles_; }
  const tracing::Tracer& tracer() const { return *tracer_; }
  // What rays do not meet as the scene asks for, for the artist.
  std::vector<std::string> warnings() const;

 private:
  gl::DeviceInfo device_;
  std::optional<tracing::TriangleList> triangles_;
  std::unique_ptr<tracing::Tracer> tracer_;
  std::string name_;
  bool built_ = false;
};

}  // namespace panoptes::engine
