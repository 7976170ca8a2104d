// All triangles that rays may meet, transformed to one space: what every tracer is built over.
//
// Positions are relative to origin(), the middle of the scene, so that a scene far from the world's
// origin loses no precision that its own coordinates have.
#pragma once

#include "gl/context.h"
#include "gl/pass_timer.h"
#include "gl/program.h"
#include "gpu_scene/gpu_scene.h"
#include "scene/scene.h"
#include "tracing/flatten_shared.h"
#include "tracing/rays_shared.h"

#include <span>
#include <vector>

namespace panoptes::tracing {

class TriangleList {
 public:
  explicit TriangleList(const gl::DeviceInfo& device) : device_(device) {}

  // Writes the list again if geometry, places, visibility or alphas have changed since the last call;
  // true if so. The order is that of the scene's instances, then that of their meshes. `gpu` must be
  // up to date with `scene`. Throws Error when the driver cannot address so many triangles.
  bool update(const scene::Scene& scene, const gpu_scene::GpuScene& gpu, gl::ProgramCache& programs,
              gl::PassTimer& timer);
  // Takes triangles from the host, about `origin`.
  void assign(std::span<const shared::TracedTriangle> triangles,
              const glm::vec3& origin = glm::vec3(0));

  uint32_t count() const { return count_; }
  // Triangles that the last update() found not finite or too far from the others to be met; they
  // are in the list, but nobody sees them.
  uint32_t lost() const { return lost_; }
  // Of each instance that update() has listed, by its place on the GPU: the primitive that is its
  // mesh's first triangle.
  const std::vector<uint32_t>& first_primitives() const { return first_primitives_; }
  // Where positions are relative to, world space.
  const glm::vec3& origin() const { return origin_; }
  // Holds all triangles that somebody sees; relative to the origin. Empty if there are none.
  const scene::Bounds& bounds() const { return bounds_; }
  const gl::Buffer& buffer() const { return buffer_; }
  // RGBA32F, three texels a triangle.
  const gl::Texture& texture() const { return texture_; }
  // The list as the GPU has it, for tracers that are built on the host.
  std::vector<shared::TracedTriangle> read() const;

 private:
  void reserve(uint64_t count);
  void flatten(const std::vector<shared::TriangleSpan>& spans, const gpu_scene::GpuScene& gpu,
               gl::ProgramCache& programs);

  gl::DeviceInfo device_;
  uint32_t count_ = 0, lost_ = 0;
  glm::vec3 origin_{0};
  scene::Bounds bounds_;
  int64_t revision_ = -1;
  std::vector<uint32_t> first_primitives_;
  gl::Buffer buffer_;
  gl::Texture texture_;
  gl::Buffer spans_, summary_;
};

// For the validation of shaders.
gl::ProgramSource flatten_program();

}  // namespace panoptes::tracing
