#include "gpu_scene/instance_list.h"

#include "gpu_scene/placement.h"
#include "gpu_scene/units.h"

#include <glm/gtc/packing.hpp>

#include <bit>

namespace panoptes::gpu_scene {

InstanceList::InstanceList(const gl::DeviceInfo& device)
    : buffer_("objects", GL_RGBA32F, 16, device.max_texture_buffer_texels) {}

InstanceList::Record InstanceList::record_of(const scene::Instance& instance, const GpuMesh& mesh) {
  Record record{};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      record[size_t(row * 4 + column)] =
          std::bit_cast<uint32_t>(instance.object_to_world[column][row]);
  record[12] = mesh.record.first;
  record[13] = instance.visibility;
  // Tells places apart by what does not depend on the order of instances: FNV-1a, by words.
  uint32_t seed = 2166136261u;
  for (size_t i = 0; i < 12; ++i) seed = (seed ^ record[i]) * 16777619u;
  record[14] = seed;
  record[15] = glm::packHalf2x16(instance.indirect_scale);
  return record;
}

void InstanceList::place_all(const scene::Scene& scene, const MeshStore& meshes) {
  std::vector<Record> records;
  std::vector<size_t> indices;
  for (size_t i = 0; i < scene.instances().size(); ++i) {
    const scene::Instance& instance = scene.instances()[i];
    if (!scene.mesh_of(instance)) continue;
    records.push_back(record_of(instance, meshes.mesh(instance.mesh)));
    indices.push_back(i);
  }
  const std::vector<uint32_t> places = gpu_scene::place(records, placed_);
  places_.assign(scene.instances().size(), kNotPlaced);
  for (size_t i = 0; i < places.size(); ++i) places_[indices[i]] = places[i];
  buffer_.write(0, std::span<const Record>(placed_));
}

void InstanceList::place(const scene::Scene& scene, const MeshStore& meshes,
                         const std::set<uint32_t>& indices) {
  for (const uint32_t index : indices) {
    const uint32_t at = places_[index];
    if (at == kNotPlaced) continue;
    const scene::Instance& instance = scene.instances()[index];
    placed_[at] = record_of(instance, meshes.mesh(instance.mesh));
    buffer_.write(at, placed_[at]);
  }
}

void InstanceList::bind() const { buffer_.texture().bind(kInstanceUnit); }

}  // namespace panoptes::gpu_scene
