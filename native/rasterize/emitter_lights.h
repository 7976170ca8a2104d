// Emissive meshes as lamps: in each sample of the film a few points of glowing surfaces shine as
// lamps with shadow maps of their own, so that many samples make their light exact.
//
// All emitters share one sequence of points, half of it by their power and half evenly, so that a
// faint emitter close to a wall is not forgotten. How many points a sample has follows from what a
// shadow map of this scene costs.
#pragma once

#include "gl/program.h"
#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/view_block.h"
#include "rasterize/emitter_radiance.h"
#include "rasterize/g_buffer.h"
#include "scene/emitters.h"

#include <glm/glm.hpp>

#include <functional>
#include <vector>

namespace panoptes::rasterize {

// A point of a glowing surface that stands for all of it.
struct MeshLight {
  glm::dvec3 position;  // world space, metres
  glm::vec3 normal;     // unit
  glm::vec3 front, back;  // radiance times the area that the point stands for, W/sr along the normal
  float reach = 0;  // metres: nearer than that, light is bounded as at that distance
};

// The `index`-th of a sequence of points in [0,1)^2, stratified over every power of two of them.
using PointSequence = std::function<glm::vec2(uint32_t index)>;

class EmitterLights {
 public:
  static constexpr uint32_t kMostPoints = 8;  // a sample; a power of two

  // What reading materials needs. The view gives the origin that positions are relative to.
  struct Gpu {
    const gpu_scene::GpuScene& scene;
    gl::ProgramCache& programs;
    gpu_scene::ViewBlock& view_block;
    const shared::View& view;
  };

  // Finds the emitters of `scene` and measures their power. Emitters that turn out black are left
  // out.
  void update(const scene::Scene& scene, const Gpu& gpu);
  void clear();
  bool empty() const { return emitters_.empty(); }

  // Begins a frame. `single` says that it has one sample, which then gets all kMostPoints.
  void start(PointSequence sequence, bool single);
  // The lamps of sample `index`.
  const std::vector<MeshLight>& sample(uint32_t index, const Gpu& gpu);

 private:
  static constexpr uint32_t kBlock = 16;  // samples that are read from the GPU at once

  struct Source {
    scene::Emitter emitter;
    double power;        // area times mean brightness of both sides
    double probability;  // that a point of the sequence lies on it
  };
  // A point and the area of its source that it stands for in its sample.
  struct Draw {
    scene::EmitterPoint point;
    size_t source;
    double area;
  };

  void choose_probabilities();
  Draw draw(uint32_t index) const;
  std::vector<shared::EmitterRadiance> radiances(const std::vector<Draw>& draws,
                                                 const Gpu& gpu) const;

  std::vector<Source> emitters_;
  std::vector<double> cumulative_;  // of the probabilities
  uint32_t affordable_ = 1;         // points a sample
  PointSequence sequence_;
  uint32_t points_ = 1;             // a sample of this frame
  bool single_ = false;
  uint32_t block_ = ~0u;            // number of the one that is held
  std::vector<std::vector<MeshLight>> lights_;  // a sample of the block
};

}  // namespace panoptes::rasterize
