#include "scene/scene.h"

#include "base/error.h"
#include "scene/mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace panoptes::scene {

namespace {

// Of the default grey of slots without a material, which gpu_scene/gpu_scene.cpp has.
constexpr MaterialFacts kDefaultFacts{.least_roughness = 0.5f};

bool finite(const glm::mat4& m) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!std::isfinite(m[c][r])) return false;
  return true;
}

void check_id(Id id, const char* what) {
  if (id <= 0) fail("a {} was handed over with id {}: ids must be positive", what, id);
}

void check_scale(const glm::vec2& scale) {
  for (const float s : {scale.x, scale.y})
    if (!(s >= 0 && s <= kMostIndirectScale))
      fail("an instance was handed over with a scale of {} for its indirect light: only 0 to {} have a "
           "meaning",
           s, kMostIndirectScale);
}

// Less than this many equal elements between two edited runs are sent along.
constexpr size_t kRunGap = 64;

template <class T>
ArrayChange change_of(const std::vector<T>& before, const std::vector<T>& now) {
  if (before.size() != now.size()) return {};
  return {false, differing_runs(std::span<const T>(before), std::span<const T>(now), kRunGap)};
}

ArrayChange change_of(const Attribute& before, const Attribute& now) {
  if (before.channels != now.channels || before.values.size() != now.values.size()) return {};
  // In pairs of floats, as they are stored.
  return {false, differing_runs(before.values.data(), now.values.data(), now.values.size() / 2,
                                2 * sizeof(float), kRunGap)};
}

MeshChange change_of(const Mesh& before, const Mesh& now) {
  MeshChange change{change_of(before.positions, now.positions),
                    change_of(before.triangles, now.triangles),
                    change_of(before.corner_normals, now.corner_normals),
                    {}};
  const size_t common = std::min(before.attributes.size(), now.attributes.size());
  for (size_t i = 0; i < common; ++i)
    change.attributes.push_back(change_of(before.attributes[i], now.attributes[i]));
  return change;
}

void join(ArrayChange& due, const ArrayChange& change) {
  due.all |= change.all;
  due.runs.insert(due.runs.end(), change.runs.begin(), change.runs.end());
  merge_runs(due.runs, kRunGap);
}

}  // namespace

Bounds placed_bounds(const Bounds& bounds, const glm::mat4& m) {
  Bounds placed;
  if (bounds.empty()) return placed;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 p{corner & 1 ? bounds.high.x : bounds.low.x,
                      corner & 2 ? bounds.high.y : bounds.low.y,
                      corner & 4 ? bounds.high.z : bounds.low.z};
    placed.add(glm::vec3(m * glm::vec4(p, 1.0f)));
  }
  return placed;
}

void Scene::set_mesh(Id id, Mesh mesh) {
  check_id(id, "mesh");
  const auto found = meshes_.find(id);
  // New ranges change what is drawn, new places only where.
  const auto same = [](const MaterialRange& a, const MaterialRange& b) {
    return a.slot == b.slot && a.first == b.first && a.count == b.count;
  };
  if (found == meshes_.end() ||
      !std::equal(found->second.ranges.begin(), found->second.ranges.end(), mesh.ranges.begin(),
                  mesh.ranges.end(), same))
    changes_.instances = true;
  note_change(id, found == meshes_.end() ? MeshChange{} : change_of(found->second, mesh));
  meshes_.insert_or_assign(id, std::move(mesh));
}

void Scene::note_change(Id id, MeshChange change) {
  const auto [it, fresh] = changes_.meshes.try_emplace(id, std::move(change));
  if (fresh) return;
  // An earlier change is still waiting: what either touched is sent.
  MeshChange& due = it->second;
  join(due.positions, change.positions);
  join(due.triangles, change.triangles);
  join(due.corner_normals, change.corner_normals);
  if (change.attributes.size() < due.attributes.size())
    due.attributes.resize(change.attributes.size());
  for (size_t i = 0; i < due.attributes.size(); ++i) join(due.attributes[i], change.attributes[i]);
}

void Scene::remove_mesh(Id id) {
  if (meshes_.erase(id)) {
    changes_.meshes[id] = {};
    changes_.instances = true;
  }
}

void Scene::set_instances(std::vector<Instance> instances, std::vector<Id> material_table) {
  for (const Instance& instance : instances) {
    if (instance.visibility & ~shared::SEEN_BY_ALL)
      fail("an instance was handed over with visibility {}: only bits of {} have a meaning",
           instance.visibility, shared::SEEN_BY_ALL);
    check_scale(instance.indirect_scale);
  }
  instances_ = std::move(instances);
  material_table_ = std::move(material_table);
  changes_.instances = true;
  forget_single_instances();
}

void Scene::set_instance_matrices(std::span<const int> indices,
                                  std::span<const glm::mat4> matrices) {
  check_indices(indices, matrices.size(), "matrices");
  for (size_t i = 0; i < indices.size(); ++i) {
    Instance& instance = instances_[size_t(indices[i])];
    // Whoever comes or goes changes the list of what is drawn.
    if (finite(instance.object_to_world) != finite(matrices[i])) changes_.instances = true;
    instance.object_to_world = matrices[i];
    changes_.instance_matrices.insert(uint32_t(indices[i]));
  }
  if (changes_.instances) forget_single_instances();
}

void Scene::set_instance_scales(std::span<const int> indices, std::span<const glm::vec2> scales) {
  check_indices(indices, scales.size(), "scales");
  for (const glm::vec2& scale : scales) check_scale(scale);
  for (size_t i = 0; i < indices.size(); ++i) {
    instances_[size_t(indices[i])].indirect_scale = scales[i];
    changes_.instance_scales.insert(uint32_t(indices[i]));
  }
  if (changes_.instances) forget_single_instances();
}

void Scene::check_indices(std::span<const int> indices, size_t values, const char* what) const {
  if (indices.size() != values)
    fail("{} {} were handed over for {} instances: please report it", values, what, indices.size());
  for (const int index : indices)
    if (index < 0 || size_t(index) >= instances_.size())
      fail("instance {} does not exist: please report it", index);
}

void Scene::forget_single_instances() {
  changes_.instance_matrices.clear();
  changes_.instance_scales.clear();
}

void Scene::set_material(Id id, Material material) {
  check_id(id, "material");
  materials_.insert_or_assign(id, std::move(material));
  changes_.materials.insert(id);
}

void Scene::set_material_params(Id id, std::vector<glm::vec4> params, float least_roughness) {
  const auto found = materials_.find(id);
  if (found == materials_.end()) fail("material {} does not exist: please report it", id);
  if (found->second.params.size() != params.size()) {
    changes_.materials.insert(id);
  } else {
    changes_.material_params.insert(id);
  }
  found->second.params = std::move(params);
  found->second.facts.least_roughness = least_roughness;
}

void Scene::remove_material(Id id) {
  if (materials_.erase(id)) changes_.materials.insert(id);
}

void Scene::set_image(Id id, Image image) {
  check_id(id, "image");
  image.serial = ++image_serial_;
  images_.insert_or_assign(id, std::move(image));
  changes_.images.insert(id);
}

void Scene::remove_image(Id id) {
  if (images_.erase(id)) changes_.images.insert(id);
}

const Image* Scene::image_with_pixels(Id id) {
  const auto found = images_.find(id);
  if (found == images_.end()) return nullptr;
  Image& image = found->second;
  if (image.levels.empty() && image.reload) image.levels = image.reload().levels;
  return &image;
}

void Scene::release_pixels(Id id) {
  const auto found = images_.find(id);
  if (found != images_.end() && found->second.reload) found->second.levels.clear();
}

void Scene::set_lights(std::vector<Light> lights) {
  std::erase_if(lights, [](const Light& l) {
    return !finite(l.object_to_world) || !std::isfinite(l.energy) || !finite(l.color) ||
           l.energy * l.color == glm::vec3(0);
  });
  for (Light& light : lights) make_finite(light);
  lights_ = std::move(lights);
  changes_.lights = true;
}

void Scene::set_world(World world) {
  world_ = std::move(world);
  changes_.world = true;
}

const Mesh* Scene::mesh_of(const Instance& instance) const {
  if (!instance.visibility || !finite(instance.object_to_world)) return nullptr;
  const auto mesh = meshes_.find(instance.mesh);
  return mesh != meshes_.end() ? &mesh->second : nullptr;
}

Id Scene::material_of(const Instance& instance, int slot) const {
  const int64_t index = int64_t(instance.material_offset) + slot;
  if (index < 0 || index >= int64_t(material_table_.size())) return 0;
  const Id id = material_table_[size_t(index)];
  return materials_.count(id) ? id : 0;
}

Facts Scene::facts() const {
  Facts facts;
  std::set<Id> used;
  for (const Instance& instance : instances_) {
    const Mesh* mesh = mesh_of(instance);
    if (!mesh) continue;
    ++facts.instances;
    facts.triangles += int64_t(mesh->triangles.size());
    for (const MaterialRange& range : mesh->ranges)
      used.insert(material_of(instance, range.slot));
  }
  for (Id id : used) {
    const auto found = materials_.find(id);
    const MaterialFacts m = found == materials_.end() ? kDefaultFacts : found->second.facts;
    facts.alpha |= m.alpha;
    facts.emission |= m.emission;
    facts.normal_map |= m.normal_map;
    facts.glossy |= m.glossy;
    facts.transmission |= m.transmission;
    facts.layers |= m.layers;
    if (m.glossy) facts.least_roughness = std::min(facts.least_roughness, m.least_roughness);
  }
  for (const Light& light : lights_) {
    ++facts.lamps[int(light.type)];
    facts.shadow_lamps[int(light.type)] += light.cast_shadow;
    facts.extended_lamps |= light.extended();
  }
  facts.world = !world_.black();
  return facts;
}

Bounds Scene::bounds() const {
  Bounds all;
  for (const Instance& instance : instances_) {
    const Mesh* mesh = mesh_of(instance);
    if (!mesh) continue;
    const Bounds placed = placed_bounds(mesh->bounds, instance.object_to_world);
    if (placed.empty()) continue;
    all.add(placed.low);
    all.add(placed.high);
  }
  return all;
}

std::vector<std::string> Scene::warnings() const {
  std::vector<std::string> result;
  for (const auto& [id, mesh] : meshes_)
    if (!mesh.warning.empty()) result.push_back(mesh.warning);
  const auto lost = std::count_if(instances_.begin(), instances_.end(), [](const Instance& i) {
    return !finite(i.object_to_world);
  });
  if (lost > 0)
    result.push_back(fmt::format("{} objects have a matrix that is not finite and are left out: "
                                 "check their location, rotation, scale and constraints.",
                                 lost));
  return result;
}

Changes Scene::take_changes() { return std::exchange(changes_, {}); }

}  // namespace panoptes::scene
