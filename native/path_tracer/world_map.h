// Where the world is bright: a map of directions that samples are drawn from.
#pragma once

#include "gl/context.h"
#include "gl/handles.h"
#include "gl/program.h"
#include "gpu_scene/gpu_scene.h"

#include <glm/glm.hpp>

#include <span>
#include <vector>

namespace panoptes::path_tracer {

// Cumulative probabilities of a map's texels: those of the rows (height + 1 values, the first 0, the
// last 1), then width + 1 of the texels of each row. `brightness` is by row from +Z down, of a texel's
// share of the sphere; not negative. A twentieth of all samples is spread evenly, so that no direction
// is without. No GL.
std::vector<float> world_distribution(std::span<const float> brightness, int width, int height);

class WorldMap {
 public:
  // Measures the world of `gpu`, which there must be. As many directions as its images have texels,
  // within what a frame and the device can bear.
  void update(const gpu_scene::GpuScene& gpu, const gl::DeviceInfo& device,
              gl::ProgramCache& programs);
  void clear();

  // False where there is none, or where it is black.
  bool any() const { return irradiance_ > 0; }
  glm::ivec2 size() const { return size_; }
  // The mean over the sphere times pi, W/m2.
  float irradiance() const { return irradiance_; }
  const gl::Texture& texture() const { return texture_; }
  int64_t bytes() const { return buffer_.bytes(); }

 private:
  glm::ivec2 size_{0};
  float irradiance_ = 0;
  gl::Buffer buffer_;
  gl::Texture texture_;
};

// For the validation of shaders.
gl::ProgramSource world_map_program(const gpu_scene::GpuShading& world);

}  // namespace panoptes::path_tracer
