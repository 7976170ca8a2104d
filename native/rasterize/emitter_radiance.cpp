#include "rasterize/emitter_radiance.h"

#include "gl/dispatch.h"

#include <fmt/format.h>

#include <map>

namespace panoptes::rasterize {

gl::ProgramSource emitter_program(const gpu_scene::GpuMaterial& material) {
  gl::ProgramSource source;
  source.name = fmt::format("light of material '{}'", material.name);
  source.stages = {{GL_COMPUTE_SHADER, "rasterize/emitters.comp"}};
  gpu_scene::GpuScene::add_material(material, source);
  return source;
}

std::vector<shared::EmitterRadiance> emitted_radiance(std::span<const EmitterProbe> probes,
                                                      const gpu_scene::GpuScene& gpu,
                                                      gl::ProgramCache& programs) {
  std::vector<shared::EmitterRadiance> result(probes.size());
  if (probes.empty()) return result;
  // Each material runs over its own points, which lie together.
  std::map<scene::Id, std::vector<size_t>> by_material;
  for (size_t i = 0; i < probes.size(); ++i) by_material[probes[i].material].push_back(i);
  std::vector<shared::EmitterPlace> places;
  for (const auto& [id, indices] : by_material)
    for (size_t i : indices) places.push_back(probes[i].place);
  const gl::Buffer input{std::span<const shared::EmitterPlace>(places)};
  const gl::Buffer output(int64_t(places.size() * sizeof(shared::EmitterRadiance)));
  gpu.bind_geometry();
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, input.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 4, output.id());
  GLuint first = 0;
  for (const auto& [id, indices] : by_material) {
    const gpu_scene::GpuMaterial& material = gpu.materials()[gpu.material_index(id)];
    programs.get(emitter_program(material)).use();
    gpu.bind_shading(material);
    glUniform2ui(1, first, GLuint(indices.size()));
    gl::dispatch(uint32_t(indices.size()), GL_BUFFER_UPDATE_BARRIER_BIT);
    first += GLuint(indices.size());
  }
  std::vector<shared::EmitterRadiance> sorted(places.size());
  output.read(0, output.bytes(), sorted.data());
  size_t next = 0;
  for (const auto& [id, indices] : by_material)
    for (size_t i : indices) result[i] = sorted[next++];
  return result;
}

}  // namespace panoptes::rasterize
