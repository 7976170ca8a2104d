// Shadows of lamps by maps in place of rays: the thesis' fast option (section 7.3, Figure 7.9). In
// each sample a lamp is one of its points, whose map is looked up from wherever a path turns; many
// samples make penumbrae. Emissive surfaces and the world keep their rays, and so do lamps beyond those
// whose maps fit into memory together.
#pragma once

#include "gl/context.h"
#include "gl/pass_timer.h"
#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/view_block.h"
#include "rasterize/shadow_maps.h"
#include "scene/scene.h"

#include <vector>

namespace panoptes::path_tracer {

class MapShadows {
 public:
  explicit MapShadows(const gl::DeviceInfo& device) : device_(device) {}

  // `lamps` as scene::Scene has them; positions will be about `origin`, world space.
  void begin(const std::vector<scene::Light>& lamps, const scene::Bounds& bounds,
             const glm::dvec3& origin, int resolution);
  // Draws the maps of sample `index`. `camera` says by its sample and seed which points of lamps, and
  // which alpha thresholds, these are.
  void render(const shared::View& camera, const gpu_scene::GpuScene& scene,
              gpu_scene::ViewBlock& view_block, gl::ProgramCache& programs, gl::PassTimer& timer);
  // For programs that include rasterize/shadow_lookup.glsl.
  void bind() const;
  // Lamps from the first on that have maps, or cast no shadows.
  uint32_t mapped() const { return mapped_; }
  void release();

 private:
  gl::DeviceInfo device_;
  std::vector<scene::Light> lamps_;
  scene::Bounds bounds_;
  glm::dvec3 origin_{0};
  rasterize::ShadowSettings settings_;
  rasterize::ShadowMaps maps_;
  gl::Buffer lights_, faces_;
  uint32_t mapped_ = 0;
};

}  // namespace panoptes::path_tracer
