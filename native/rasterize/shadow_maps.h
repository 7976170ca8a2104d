// Shadow maps of all lamps, in layers of one depth array: one layer for a sun, a narrow spot or a
// lamp outside the scene, up to six faces of a world-aligned cube for others.
//
// Lamps whose layers do not fit together are worked off in batches, so that memory is bounded
// whatever the number of lamps. Maps that hold for the next sample or frame are kept.
#pragma once

#include "gl/pass_timer.h"
#include "gl/program.h"
#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/lights_shared.h"
#include "gpu_scene/view.h"
#include "gpu_scene/view_block.h"
#include "rasterize/depth_views.h"
#include "rasterize/emitter_lights.h"
#include "rasterize/shadow_views.h"

#include <glm/glm.hpp>

#include <vector>

namespace panoptes::rasterize {

struct ShadowSettings {
  int resolution = 2048;           // texels a side; 14 mm on a hall of 28 m
  int64_t max_bytes = 512 << 20;   // of the depth array
};

// Kinds of lamps as the statistics tell their shadows apart; the first four are scene::LightType.
enum class ShadowKind { kPoint = 0, kSun = 1, kSpot = 2, kArea = 3, kMesh = 4 };

// A lamp in one sample: what shaders read, and the views of its map.
struct PlacedLight {
  shared::Light light;
  ShadowKind kind;
  int resolution;     // texels a side of each view, at most the maps'
  ShadowViews views;  // none: casts no shadow
};

// Lamps whose maps fit into the layers together. Their layers count from 0.
struct LightBatch {
  uint32_t first_light = 0, light_count = 0;
  uint32_t layers = 0;
};

struct LightSet {
  std::vector<PlacedLight> lights;
  std::vector<shared::ShadowFace> faces;  // of all lights, in order
  std::vector<LightBatch> batches;
};

// Which of a lamp's points this sample uses.
struct LightSamplePoint {
  float u = 0.5f, v = 0.5f;
  glm::vec2 texel_shift{0};  // of the map's grid, -.5 .. .5, so that samples smooth its edges
};

// What all lamps of a sample are placed by.
struct Placement {
  bool shadows = true;
  scene::Bounds bounds;      // of everything that casts or catches shadows
  std::vector<scene::Bounds> sun_cascades;  // that suns' maps show, finest first; empty: all
  glm::dvec3 camera_origin{0};
  int resolution = 2048;     // of the maps
  int layers = 6;            // that a batch may have, at least 6
};

// Places lamps for one sample: `points` is empty for the lamps' centres or has an entry a lamp; then
// come the mesh lights. No GL.
LightSet place_lights(const std::vector<scene::Light>& lights,
                      const std::vector<LightSamplePoint>& points,
                      const std::vector<MeshLight>& mesh_lights, const Placement& placement);

class ShadowMaps {
 public:
  // Layers that `settings` allow for; at least the six that one lamp can need.
  static int layer_limit(const ShadowSettings& settings, const gl::DeviceInfo& device);

  // Renders the maps of one batch unless `keep` says that they still hold.
  void render(const LightSet& set, const LightBatch& batch, const ShadowSettings& settings,
              const shared::View& camera, const gpu_scene::GpuScene& scene,
              gl::ProgramCache& programs, gl::PassTimer& timer, gpu_scene::ViewBlock& view_block,
              bool keep);
  void bind(int unit) const { maps_.bind(unit); }
  void release() { maps_.release(); }

 private:
  DepthViews maps_;
};

}  // namespace panoptes::rasterize
