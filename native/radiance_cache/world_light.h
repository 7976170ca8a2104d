// The world as a light: its harmonics, and how bright it is where rays leave the scene.
#pragma once

#include "gl/handles.h"
#include "gl/program.h"
#include "gpu_scene/gpu_scene.h"
#include "scene/scene.h"

#include <glm/glm.hpp>

#include <array>
#include <span>

namespace panoptes::radiance_cache {

// A map of directions: latitudes from +Z down, longitudes from +X on, rows first.
constexpr int kWorldWidth = 128, kWorldHeight = 64;

// Coefficients of the first nine harmonics (base/spherical_harmonics.glsl) of the radiance in such a
// map. No GL.
std::array<glm::vec4, 9> world_harmonics(std::span<const glm::vec4> radiance);

// The map seen through a lobe as wide as one of `directions` rays that share the sphere: cosines to
// a power whose lobe has 4 pi / directions of solid angle. A map of a quarter of the width and height.
// No GL.
std::vector<glm::vec4> blurred_world(std::span<const glm::vec4> radiance, int directions);

class WorldLight {
 public:
  // Measures the world of `gpu` anew if it has changed.
  void update(const scene::World& world, const gpu_scene::GpuScene& gpu, gl::ProgramCache& programs);
  // The blurred map, as GL_RGBA32F, made at the first call.
  const gl::Texture& map(int directions);
  // Nine vec4s: coefficients of the radiance, for a uniform block.
  const gl::Buffer& harmonics() const { return harmonics_; }

 private:
  int64_t revision_ = -1;
  std::vector<glm::vec4> radiance_;
  int directions_ = 0;  // that map_ was made for; 0: not at all
  gl::Texture map_;
  gl::Buffer harmonics_;
};

// For the validation of shaders.
gl::ProgramSource world_radiance_program(const gpu_scene::GpuShading& world);

}  // namespace panoptes::radiance_cache
