#include "gpu_scene/gpu_scene.h"

#include "base/error.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace panoptes::gpu_scene {

namespace {

// What a slot without a material shows, as in Blender.
constexpr const char* kDefaultMaterial =
    "void evaluate_material(const Hit hit, inout Surface surface) {\n"
    "  closure_principled_v3(surface, vec3(1.0), principled_defaults(hit));\n"
    "}\n";

// What a material shows whose program does not compile.
constexpr const char* kBrokenMaterial =
    "void evaluate_material(const Hit hit, inout Surface surface) {\n"
    "  closure_diffuse(surface, vec3(1.0), vec3(1.0, 0.0, 1.0), 0.0, hit.normal);\n"
    "}\n";

// NO_ATTRIBUTE and IS_COLOR of geometry.glsl.
constexpr uint32_t kNoAttribute = 0xffffffffu, kIsColor = 0x80000000u;
constexpr size_t kMeshWords = 8;                // MESH_ATTRIBUTES of geometry.glsl

struct DrawCommand {
  uint32_t count, instance_count, first_index;
  int32_t base_vertex;
  uint32_t base_instance;
};

uint32_t bits(float value) {
  uint32_t result;
  std::memcpy(&result, &value, sizeof result);
  return result;
}

}  // namespace

GpuScene::GpuScene(const gl::DeviceInfo& device)
    : device_(device),
      vertices_("vertices", GL_RGB32F, 12, 1, device.max_texture_buffer_texels),
      triangles_("triangles", GL_RGB32UI, 12, 1, device.max_texture_buffer_texels),
      normals_("triangles", GL_RGB32UI, 12, 1, device.max_texture_buffer_texels),
      attributes_("UV and colour values", GL_RG32F, 8, 1, device.max_texture_buffer_texels) {
  const GLenum wraps[3] = {GL_REPEAT, GL_CLAMP_TO_EDGE, GL_CLAMP_TO_BORDER};
  for (int closest = 0; closest < 2; ++closest)
    for (int wrap = 0; wrap < 3; ++wrap)
      samplers_[closest][wrap] =
          gl::Sampler({closest ? GLenum(GL_NEAREST_MIPMAP_NEAREST) : GLenum(GL_LINEAR_MIPMAP_LINEAR),
                       closest ? GLenum(GL_NEAREST) : GLenum(GL_LINEAR), wraps[wrap], wraps[wrap],
                       true});
  vertex_array_ = gl::VertexArray::make();
}

void GpuScene::update(scene::Scene& scene) {
  const scene::Changes changes = scene.take_changes();
  if (changes.any()) ++revision_;
  if (changes.world || !changes.images.empty()) ++world_revision_;
  update_meshes(scene, changes);
  const bool structure = changes.instances || !changes.materials.empty();
  if (structure || changes.world) {
    update_materials(scene);
  }
  if (structure || changes.world || !changes.images.empty()) update_images(scene, changes);
  if (structure || changes.world || !changes.material_params.empty()) update_params(scene);
  if (structure || !changes.meshes.empty()) update_tables(scene);
  // Mesh records may have moved whenever the tables were built.
  if (structure || !changes.meshes.empty() || !changes.instance_matrices.empty())
    update_instances(scene, changes);
  if (structure || !changes.meshes.empty()) update_draws(scene);
}

void GpuScene::update_meshes(const scene::Scene& scene, const scene::Changes& changes) {
  for (scene::Id id : changes.meshes) {
    const auto source = scene.meshes().find(id);
    GpuMesh& mesh = meshes_[id];
    if (source == scene.meshes().end()) {
      vertices_.release(mesh.vertices);
      triangles_.release(mesh.triangles);
      normals_.release(mesh.normals);
      for (Range& range : mesh.attributes) attributes_.release(range);
      meshes_.erase(id);
      continue;
    }
    const scene::Mesh& m = source->second;
    vertices_.store(mesh.vertices, uint32_t(m.positions.size()), m.positions.data());
    triangles_.store(mesh.triangles, uint32_t(m.triangles.size()), m.triangles.data());
    normals_.store(mesh.normals, uint32_t(m.corner_normals.size()), m.corner_normals.data());
    while (mesh.attributes.size() > m.attributes.size()) {
      attributes_.release(mesh.attributes.back());
      mesh.attributes.pop_back();
    }
    mesh.attributes.resize(m.attributes.size());
    for (size_t i = 0; i < m.attributes.size(); ++i)
      attributes_.store(mesh.attributes[i], uint32_t(m.attributes[i].values.size() / 2),
                        m.attributes[i].values.data());
  }
}

GpuShading GpuScene::make_shading(const std::string& name, const std::string& code,
                                  const std::vector<scene::TextureUse>& textures) {
  GpuShading shading{name, code, 0, 0, 0, textures};
  const size_t limit = size_t(device_.max_texture_units - kImageUnit);
  if (shading.textures.size() > limit) {
    material_warnings_.push_back(fmt::format(
        "Material '{}' uses {} images and this graphics driver allows {}; the others show magenta: "
        "merge some of its images.",
        name, textures.size(), limit));
    // Extra uses share the last unit, which then shows the colour of a missing image.
    shading.textures.resize(limit);
    shading.textures.back().image = 0;
  }
  return shading;
}

void GpuScene::update_materials(const scene::Scene& scene) {
  materials_.clear();
  material_indices_.clear();
  material_warnings_.clear();
  std::set<scene::Id> used;
  for (const scene::Instance& instance : scene.instances()) {
    const scene::Mesh* mesh = scene.mesh_of(instance);
    if (!mesh) continue;
    for (const scene::MaterialRange& range : mesh->ranges)
      used.insert(scene.material_of(instance, range.slot));
  }
  for (scene::Id id : used) {
    material_indices_[id] = uint32_t(materials_.size());
    GpuMaterial material;
    material.id = id;
    const auto found = scene.materials().find(id);
    if (found == scene.materials().end()) {
      static_cast<GpuShading&>(material) = make_shading("default", kDefaultMaterial, {});
    } else {
      const scene::Material& m = found->second;
      static_cast<GpuShading&>(material) = make_shading(m.name, m.code, m.textures);
      material.facts = m.facts;
    }
    materials_.push_back(std::move(material));
  }
  world_.reset();
  if (!scene.world().black())
    world_ = make_shading("world", scene.world().code, scene.world().textures);
}

void GpuScene::update_images(const scene::Scene& scene, const scene::Changes& changes) {
  image_warnings_.clear();
  std::set<scene::Id> used;
  for (const GpuMaterial& material : materials_)
    for (const scene::TextureUse& use : material.textures) used.insert(use.image);
  if (world_)
    for (const scene::TextureUse& use : world_->textures) used.insert(use.image);
  std::erase_if(images_, [&](const auto& item) {
    return !used.count(item.first) || changes.images.count(item.first);
  });
  for (scene::Id id : used) {
    const auto source = scene.images().find(id);
    if (images_.count(id)) continue;
    if (source == scene.images().end()) {
      need_missing();
      continue;
    }
    try {
      images_[id] = upload_image(source->second, device_.max_texture_size);
    } catch (const Error& error) {
      image_warnings_.push_back(fmt::format("An image shows magenta: {}.", error.what()));
      need_missing();
    }
  }
  const auto shade = [&](GpuShading& shading) {
    shading.srgb_mask = 0;
    for (size_t i = 0; i < shading.textures.size(); ++i) {
      const auto image = images_.find(shading.textures[i].image);
      if (image != images_.end() && image->second.srgb) shading.srgb_mask |= 1u << i;
    }
  };
  for (GpuMaterial& material : materials_) shade(material);
  world_image_width_ = 0;
  if (world_) {
    shade(*world_);
    for (const scene::TextureUse& use : world_->textures)
      if (const auto image = images_.find(use.image); image != images_.end())
        world_image_width_ =
            std::max(world_image_width_, image->second.texture.options().width);
  }
}

std::vector<std::string> GpuScene::warnings() const {
  std::vector<std::string> all = material_warnings_;
  all.insert(all.end(), image_warnings_.begin(), image_warnings_.end());
  return all;
}

void GpuScene::need_missing() {
  if (missing_.texture) return;
  const uint8_t magenta[4] = {255, 0, 255, 255};
  missing_.texture = gl::Texture({GL_TEXTURE_2D, GL_RGBA8, 1, 1, 1, 1});
  missing_.texture.write(GL_RGBA, GL_UNSIGNED_BYTE, 4, magenta);
}

void GpuScene::check_programs(const std::function<void(const GpuMaterial&)>& compile,
                              const std::function<void(const GpuShading&)>& compile_world) {
  for (GpuMaterial& material : materials_) {
    try {
      compile(material);
    } catch (const Error& error) {
      material_warnings_.push_back(fmt::format("Material '{}' shows magenta: {}.", material.name,
                                      error.what()));
      material.code = kBrokenMaterial;
    }
  }
  if (!world_) return;
  try {
    compile_world(*world_);
  } catch (const Error& error) {
    material_warnings_.push_back(fmt::format("The world is shown black: {}.", error.what()));
    world_->code = "vec3 evaluate_world(vec3 direction) { return vec3(0.0); }\n";
  }
}

void GpuScene::update_params(const scene::Scene& scene) {
  std::vector<glm::vec4> params;
  const auto append = [&](GpuShading& shading, const std::vector<glm::vec4>& values) {
    shading.params = uint32_t(params.size());
    params.insert(params.end(), values.begin(), values.end());
  };
  for (GpuMaterial& material : materials_) {
    const auto found = scene.materials().find(material.id);
    append(material,
           found == scene.materials().end() ? std::vector<glm::vec4>{} : found->second.params);
  }
  if (world_) append(*world_, scene.world().params);
  const std::span<const glm::vec4> all(params);
  if (params_buffer_.bytes() == int64_t(std::max<size_t>(all.size_bytes(), 16))) {
    params_buffer_.write(0, int64_t(all.size_bytes()), all.data());
    return;
  }
  params_buffer_ = gl::Buffer(all);
  params_ = gl::Texture(GL_RGBA32F, params_buffer_);
}

void GpuScene::update_tables(const scene::Scene& scene) {
  // Names get indices in the order of the materials that ask for them; 0 and 1 are the defaults.
  std::map<std::string, uint32_t> names;
  for (const GpuMaterial& material : materials_)
    if (const auto found = scene.materials().find(material.id); found != scene.materials().end())
      for (const std::string& name : found->second.attributes)
        names.emplace(name, uint32_t(names.size() + 2));

  std::vector<uint32_t> words;
  for (auto& [id, mesh] : meshes_) {
    const scene::Mesh& source = scene.meshes().at(id);
    mesh.record = uint32_t(words.size());
    words.resize(words.size() + kMeshWords + 2 + names.size(), kNoAttribute);
    uint32_t* record = &words[mesh.record];
    record[0] = mesh.vertices.first;
    record[1] = mesh.triangles.first;
    for (int axis = 0; axis < 3; ++axis) {
      const float low = source.bounds.empty() ? 0 : source.bounds.low[axis];
      const float extent = source.bounds.empty() ? 0 : source.bounds.high[axis] - low;
      const float scale = extent > 0 ? 1 / extent : 0;
      record[2 + axis] = bits(scale);
      record[5 + axis] = bits(scale > 0 ? -low * scale : 0.5f);
    }
    for (size_t i = 0; i < source.attributes.size(); ++i) {
      const scene::Attribute& attribute = source.attributes[i];
      const uint32_t first = mesh.attributes[i].first | (attribute.channels == 4 ? kIsColor : 0);
      if (attribute.channels == 2 && attribute.name == source.default_uv)
        record[kMeshWords] = first;
      if (attribute.channels == 4 && attribute.name == source.default_color)
        record[kMeshWords + 1] = first;
      if (const auto name = names.find(attribute.name); name != names.end())
        record[kMeshWords + name->second] = first;
    }
  }
  for (GpuMaterial& material : materials_) {
    material.attributes = uint32_t(words.size());
    if (const auto found = scene.materials().find(material.id); found != scene.materials().end())
      for (const std::string& name : found->second.attributes) words.push_back(names.at(name));
  }
  tables_buffer_ = gl::Buffer(std::span<const uint32_t>(words));
  tables_ = gl::Texture(GL_R32UI, tables_buffer_);
}

void GpuScene::update_instances(const scene::Scene& scene, const scene::Changes& changes) {
  const auto pack = [&](const scene::Instance& instance, glm::vec4* out) {
    const glm::mat4 rows = glm::transpose(instance.object_to_world);
    const auto mesh = meshes_.find(instance.mesh);
    uint32_t record = mesh == meshes_.end() ? 0 : mesh->second.record;
    for (int r = 0; r < 3; ++r) out[r] = rows[r];
    out[3] = glm::vec4(0);
    std::memcpy(&out[3].x, &record, sizeof record);
    std::memcpy(&out[3].y, &instance.visibility, sizeof instance.visibility);
  };
  const int64_t bytes = int64_t(scene.instances().size()) * 64;
  const bool all = changes.instances || !changes.meshes.empty() || !changes.materials.empty();
  if (!all) {
    for (uint32_t index : changes.instance_matrices) {
      glm::vec4 packed[4];
      pack(scene.instances()[index], packed);
      instances_buffer_.write(int64_t(index) * 64, 64, packed);
    }
    return;
  }
  std::vector<glm::vec4> packed(scene.instances().size() * 4);
  for (size_t i = 0; i < scene.instances().size(); ++i) pack(scene.instances()[i], &packed[i * 4]);
  if (instances_buffer_ && instances_buffer_.bytes() == bytes) {
    instances_buffer_.write(0, bytes, packed.data());
    return;
  }
  instances_buffer_ = gl::Buffer(std::span<const glm::vec4>(packed));
  instances_ = gl::Texture(GL_RGBA32F, instances_buffer_);
}

void GpuScene::update_draws(const scene::Scene& scene) {
  struct Draw {
    shared::DrawRecord record;
    DrawCommand command;
  };
  // By who sees them: the camera alone, both, lamps alone.
  using Lists = std::array<std::vector<Draw>, 3>;
  Lists opaque;
  std::map<uint32_t, Lists> alpha;  // by material
  for (size_t i = 0; i < scene.instances().size(); ++i) {
    const scene::Instance& instance = scene.instances()[i];
    const scene::Mesh* source = scene.mesh_of(instance);
    const bool camera = instance.visibility & shared::SEEN_BY_CAMERA,
               shadow = instance.visibility & shared::SEEN_BY_SHADOW;
    if (!source || !(camera || shadow)) continue;
    const size_t list = camera && shadow ? 1 : camera ? 0 : 2;
    const GpuMesh& mesh = meshes_.at(instance.mesh);
    for (const scene::MaterialRange& range : source->ranges) {
      const uint32_t material = material_index(scene.material_of(instance, range.slot));
      Lists& lists = materials_[material].facts.alpha ? alpha[material] : opaque;
      lists[list].push_back({{uint32_t(i), material, range.first, 0},
                             {range.count * 3, 1, (mesh.triangles.first + range.first) * 3,
                              int32_t(mesh.vertices.first), 0}});
    }
  }

  std::vector<shared::DrawRecord> records;
  std::vector<DrawCommand> commands;
  const auto emit = [&](const Lists& lists) {
    const DrawGroup group{uint32_t(records.size()), uint32_t(lists[0].size()),
                          uint32_t(lists[1].size()), uint32_t(lists[2].size())};
    for (const std::vector<Draw>& list : lists)
      for (Draw draw : list) {
        draw.record.index = draw.command.base_instance = uint32_t(records.size());
        records.push_back(draw.record);
        commands.push_back(draw.command);
      }
    return group;
  };
  opaque_ = emit(opaque);
  alpha_groups_.clear();
  for (const auto& [material, lists] : alpha) alpha_groups_.push_back({material, emit(lists)});
  record_count_ = uint32_t(records.size());
  records_ = gl::Buffer(std::span<const shared::DrawRecord>(records));
  commands_ = gl::Buffer(std::span<const DrawCommand>(commands));
}

uint32_t GpuScene::material_index(scene::Id id) const { return material_indices_.at(id); }

void GpuScene::add_material(const GpuMaterial& material, gl::ProgramSource& source) {
  source.defines.push_back(fmt::format("ALPHA {}", int(material.facts.alpha)));
  source.defines.push_back(fmt::format("IMAGE_COUNT {}", material.textures.size()));
  source.snippets["generated/material.glsl"] = material.code;
}

void GpuScene::add_world(const GpuShading& world, gl::ProgramSource& source) {
  source.defines.push_back(fmt::format("IMAGE_COUNT {}", world.textures.size()));
  source.snippets["generated/world.glsl"] = world.code;
}

void GpuScene::bind_geometry() const {
  vertices_.texture().bind(kVertexUnit);
  triangles_.texture().bind(kTriangleUnit);
  normals_.texture().bind(kNormalUnit);
  attributes_.texture().bind(kAttributeUnit);
  instances_.bind(kInstanceUnit);
  tables_.bind(kTableUnit);
}

void GpuScene::bind_shading(const GpuShading& shading) const {
  params_.bind(kParamUnit);
  for (size_t i = 0; i < shading.textures.size(); ++i) {
    const scene::TextureUse& use = shading.textures[i];
    const auto image = images_.find(use.image);
    const int unit = kImageUnit + int(i);
    (image == images_.end() ? missing_ : image->second).texture.bind(unit);
    samplers_[use.closest][int(use.extension)].bind(unit);
  }
  glUniform3ui(0, shading.params, shading.attributes, shading.srgb_mask);
}

void GpuScene::begin_draw() const {
  const GLuint array = vertex_array_.id();
  glVertexArrayVertexBuffer(array, 0, vertices_.buffer().id(), 0, 12);
  glVertexArrayVertexBuffer(array, 1, records_.id(), 0, sizeof(shared::DrawRecord));
  glVertexArrayBindingDivisor(array, 1, 1);
  glVertexArrayAttribFormat(array, 0, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribIFormat(array, 1, 4, GL_UNSIGNED_INT, 0);
  for (GLuint i = 0; i < 2; ++i) {
    glVertexArrayAttribBinding(array, i, i);
    glEnableVertexArrayAttrib(array, i);
  }
  glVertexArrayElementBuffer(array, triangles_.buffer().id());
  glBindVertexArray(array);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands_.id());
  bind_geometry();
}

void GpuScene::draw_range(uint32_t first, uint32_t count) const {
  glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT,
                              reinterpret_cast<const void*>(size_t(first) * sizeof(DrawCommand)),
                              GLsizei(count), 0);
}

}  // namespace panoptes::gpu_scene
