#include "gpu_scene/mesh_store.h"

#include "gpu_scene/units.h"

#include <bit>

namespace panoptes::gpu_scene {

namespace {

// Of geometry.glsl: NO_ATTRIBUTE, IS_COLOR, MESH_ATTRIBUTES.
constexpr uint32_t kNoAttribute = 0xffffffffu, kIsColor = 0x80000000u;
constexpr size_t kMeshWords = 9;
// The first names: UV_DEFAULT and COLOR_DEFAULT.
constexpr uint32_t kDefaultNames = 2;

// Tells meshes apart that are placed alike, by what does not depend on the order of things.
uint32_t seed_of(const scene::Mesh& mesh) {
  uint32_t seed = 2166136261u;  // FNV-1a, by words
  const auto add = [&](uint32_t word) { seed = (seed ^ word) * 16777619u; };
  add(uint32_t(mesh.positions.size()));
  add(uint32_t(mesh.triangles.size()));
  for (int axis = 0; axis < 3; ++axis) {
    add(std::bit_cast<uint32_t>(mesh.bounds.low[axis]));
    add(std::bit_cast<uint32_t>(mesh.bounds.high[axis]));
  }
  return seed;
}

template <class T>
void store(Heap& heap, Range& range, const std::vector<T>& values, size_t elements,
           const scene::ArrayChange& change) {
  if (change.all || range.count != elements)
    heap.store(range, uint32_t(elements), values.data());
  else
    heap.write(range, change.runs, values.data());
}

}  // namespace

MeshStore::MeshStore(const gl::DeviceInfo& device)
    : vertices_("vertices", GL_RGB32F, 12, 1, device.max_texture_buffer_texels),
      triangles_("triangles", GL_RGB32UI, 12, 1, device.max_texture_buffer_texels),
      normals_("triangles", GL_RGB32UI, 12, 1, device.max_texture_buffer_texels),
      attributes_("UV and colour values", GL_RG32F, 8, 1, device.max_texture_buffer_texels),
      tables_("meshes and attributes", GL_R32UI, 4, device.max_texture_buffer_texels) {}

void MeshStore::update(const scene::Scene& scene, const scene::Changes& changes) {
  for (const auto& [id, change] : changes.meshes) {
    const auto source = scene.meshes().find(id);
    if (source == scene.meshes().end()) {
      if (const auto found = meshes_.find(id); found != meshes_.end()) {
        remove(found->second);
        meshes_.erase(found);
      }
      continue;
    }
    GpuMesh& mesh = meshes_[id];
    update_arrays(mesh, source->second, change);
    update_record(mesh, source->second);
  }
}

void MeshStore::update_arrays(GpuMesh& mesh, const scene::Mesh& m,
                              const scene::MeshChange& change) {
  store(vertices_, mesh.vertices, m.positions, m.positions.size(), change.positions);
  store(triangles_, mesh.triangles, m.triangles, m.triangles.size(), change.triangles);
  store(normals_, mesh.normals, m.corner_normals, m.corner_normals.size(), change.corner_normals);
  while (mesh.attributes.size() > m.attributes.size()) {
    attributes_.release(mesh.attributes.back());
    mesh.attributes.pop_back();
  }
  mesh.attributes.resize(m.attributes.size());
  for (size_t i = 0; i < m.attributes.size(); ++i) {
    const std::vector<float>& values = m.attributes[i].values;
    store(attributes_, mesh.attributes[i], values, values.size() / 2,
          i < change.attributes.size() ? change.attributes[i] : scene::ArrayChange{true, {}});
  }
}

void MeshStore::remove(GpuMesh& mesh) {
  vertices_.release(mesh.vertices);
  triangles_.release(mesh.triangles);
  normals_.release(mesh.normals);
  for (Range& range : mesh.attributes) attributes_.release(range);
  tables_.release(mesh.record);
}

bool MeshStore::set_names(const scene::Scene& scene, const std::set<std::string>& names) {
  std::set<std::string> fresh;
  for (const std::string& name : names)
    if (!names_.count(name)) fresh.insert(name);
  const size_t before = names_.size();
  std::erase_if(names_, [&](const auto& item) { return !names.count(item.first); });
  if (fresh.empty() && names_.size() == before) return false;

  // Those that stay keep their words, new ones take what is free.
  std::set<uint32_t> taken;
  for (const auto& [name, index] : names_) taken.insert(index);
  uint32_t index = kDefaultNames;
  for (const std::string& name : fresh) {
    while (taken.count(index)) ++index;
    names_[name] = index++;
  }
  const bool grows = index > name_words_;
  if (grows) {
    name_words_ = std::bit_ceil(index);
    for (auto& [id, mesh] : meshes_) tables_.release(mesh.record);
  }
  for (auto& [id, mesh] : meshes_) update_record(mesh, scene.meshes().at(id));
  return grows;
}

void MeshStore::update_record(GpuMesh& mesh, const scene::Mesh& source) {
  std::vector<uint32_t> record(kMeshWords + name_words_, kNoAttribute);
  record[0] = mesh.vertices.first;
  record[1] = mesh.triangles.first;
  record[8] = seed_of(source);
  for (int axis = 0; axis < 3; ++axis) {
    const scene::Bounds& space = source.texture_space;
    const float low = space.empty() ? 0 : space.low[axis];
    const float extent = space.empty() ? 0 : space.high[axis] - low;
    const float scale = extent > 0 ? 1 / extent : 0;
    record[size_t(2 + axis)] = std::bit_cast<uint32_t>(scale);
    record[size_t(5 + axis)] = std::bit_cast<uint32_t>(scale > 0 ? -low * scale : 0.5f);
  }
  for (size_t i = 0; i < source.attributes.size(); ++i) {
    const scene::Attribute& attribute = source.attributes[i];
    const uint32_t first = mesh.attributes[i].first | (attribute.channels == 4 ? kIsColor : 0);
    if (attribute.channels == 2 && attribute.name == source.default_uv) record[kMeshWords] = first;
    if (attribute.channels == 4 && attribute.name == source.default_color)
      record[kMeshWords + 1] = first;
    if (const auto name = names_.find(attribute.name); name != names_.end())
      record[kMeshWords + name->second] = first;
  }
  tables_.store(mesh.record, std::span<const uint32_t>(record));
}

void MeshStore::bind() const {
  vertices_.texture().bind(kVertexUnit);
  triangles_.texture().bind(kTriangleUnit);
  normals_.texture().bind(kNormalUnit);
  attributes_.texture().bind(kAttributeUnit);
  tables_.texture().bind(kTableUnit);
}

}  // namespace panoptes::gpu_scene
