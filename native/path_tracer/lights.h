// All light that paths can be sent to: lamps, glowing triangles and the world, as
// shaders/path_tracer/lights.glsl samples them.
//
// One of the lamps and triangles is chosen by a walk down a tree, by what each is estimated to give to
// the place at hand (light_tree.h), the world against all of these by its mean. A world of one colour
// is left to scattered rays, which find it as well. What the scene does not have is not compiled in.
#pragma once

#include "gl/context.h"
#include "gl/handles.h"
#include "gl/pass_timer.h"
#include "gl/program.h"
#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/view_block.h"
#include "path_tracer/light_records.h"
#include "path_tracer/world_map.h"
#include "tracing/triangle_list.h"

#include <cstdint>
#include <string>
#include <vector>

namespace panoptes::path_tracer {

// Texture units and the uniform block of programs that include path_tracer/lights.glsl.
inline constexpr int kRecordUnit = 0, kNodeUnit = 1, kGlowingUnit = 2, kWorldMapUnit = 3;
inline constexpr unsigned kLightBlock = 3;

class Lights {
 public:
  explicit Lights(const gl::DeviceInfo& device) : device_(device) {}

  // Lists and measures what has changed since the last call. `gpu` and `triangles` must be up to date
  // with `scene`. Throws Error when the device cannot address so many lights.
  void update(const scene::Scene& scene, const gpu_scene::GpuScene& gpu,
              const tracing::TriangleList& triangles, gl::ProgramCache& programs,
              gl::PassTimer& timer);
  void add_defines(gl::ProgramSource& source) const;
  // For the program in use.
  void bind() const;

  // Is there anything that light_sample() could find?
  bool any() const { return count_ > 0 || world_sampled(); }
  // Samples go to the world as well, so that its radiance has to be evaluated for them.
  bool world_sampled() const { return world_.any(); }
  // Some triangle's radiance is another at each place, so that its material has to be asked.
  bool emitters_vary() const { return kinds_.varying; }
  // Some lamp has an extent: scattered rays may meet it.
  bool lamps_seen() const { return kinds_.seen; }
  // Without those that give no light.
  uint32_t lamp_count() const { return count_ - uint32_t(triangles_.size()); }
  uint32_t triangle_count() const { return uint32_t(triangles_.size()); }
  // What could not be done as asked, for the artist.
  const std::vector<std::string>& warnings() const { return warnings_; }
  int64_t bytes() const;

 private:
  // What there is of each, for the defines.
  struct Kinds {
    bool suns = false, points = false, spots = false, areas = false, triangles = false;
    bool varying = false, seen = false;
  };
  void list(const scene::Scene& scene, const glm::vec3& origin);
  void upload(std::vector<DescribedLight> lights);
  void map_primitives(uint32_t first_record);
  gl::Texture store(gl::Buffer& buffer, GLenum format, const void* data, size_t texels,
                    size_t texel_bytes, const char* what) const;

  gl::DeviceInfo device_;
  int64_t emission_revision_ = -1, geometry_revision_ = -1, lamp_revision_ = -1, world_revision_ = -1;
  gpu_scene::ViewBlock view_block_;
  std::vector<DescribedLight> triangles_;
  WorldMap world_;
  uint32_t count_ = 0;
  Kinds kinds_;
  shared::LightConstants constants_{};
  std::vector<std::string> warnings_;
  gl::Buffer records_, nodes_, glowing_, constant_block_;
  gl::Texture record_texture_, node_texture_, glowing_texture_;
};

}  // namespace panoptes::path_tracer
