// The placed instances on the GPU, in an order of their own: whoever comes or goes leaves the
// others where they are.
#pragma once

#include "gl/context.h"
#include "gpu_scene/mesh_store.h"
#include "gpu_scene/mirrored_buffer.h"
#include "scene/scene.h"

#include <array>
#include <vector>

namespace panoptes::gpu_scene {

class InstanceList {
 public:
  static constexpr uint32_t kNotPlaced = 0xffffffffu;

  explicit InstanceList(const gl::DeviceInfo& device);

  // All instances, after the list or what they refer to has changed.
  void place_all(const scene::Scene& scene, const MeshStore& meshes);
  // Just these, whose matrices or scales have changed.
  void place(const scene::Scene& scene, const MeshStore& meshes, const std::set<uint32_t>& indices);
  void flush() { buffer_.flush(); }

  // Where an instance of the scene is in the buffer; kNotPlaced for those that show no mesh.
  uint32_t place_of(size_t index) const { return places_[index]; }
  void bind() const;
  void bind(int unit) const { buffer_.texture().bind(unit); }

 private:
  using Record = std::array<uint32_t, 16>;  // as geometry.glsl describes it

  static Record record_of(const scene::Instance& instance, const GpuMesh& mesh);

  MirroredBuffer buffer_;
  std::vector<Record> placed_;
  std::vector<uint32_t> places_;  // by index in the scene
};

}  // namespace panoptes::gpu_scene
