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

// What rays have to know of materials.
std::vector<std::pair<scene::Id, bool>> alphas_by_index(const std::vector<GpuMaterial>& materials) {
  std::vector<std::pair<scene::Id, bool>> list;
  for (const GpuMaterial& material : materials) list.emplace_back(material.id, material.facts.alpha);
  return list;
}

// What a material shows whose program does not compile.
constexpr const char* kBrokenMaterial =
    "void evaluate_material(const Hit hit, inout Surface surface) {\n"
    "  closure_diffuse(surface, vec3(1.0), vec3(1.0, 0.0, 1.0), 0.0, hit.normal);\n"
    "}\n";

}  // namespace

GpuScene::GpuScene(const gl::DeviceInfo& device)
    : device_(device), meshes_(device), instances_(device),
      params_("material values", GL_RGBA32F, 16, device.max_texture_buffer_texels) {
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
  if (!changes.any()) return;
  const bool structure = changes.instances || !changes.materials.empty();
  const bool shapes = structure || !changes.meshes.empty() || !changes.instance_matrices.empty() ||
                      !changes.images.empty();
  const auto values_of_any = [&](bool scene::MaterialFacts::*fact) {
    return std::any_of(changes.material_params.begin(), changes.material_params.end(),
                       [&](scene::Id id) {
                         const auto found = scene.materials().find(id);
                         return found != scene.materials().end() && found->second.facts.*fact;
                       });
  };
  if (shapes || changes.lights || values_of_any(&scene::MaterialFacts::alpha)) ++shadow_revision_;
  if (shapes || values_of_any(&scene::MaterialFacts::emission)) ++emission_revision_;
  if (shapes || !changes.material_params.empty()) ++surface_revision_;
  const bool resized = std::any_of(changes.meshes.begin(), changes.meshes.end(),
                                   [](const auto& item) { return item.second.resized(); });
  const bool reshaped = std::any_of(changes.meshes.begin(), changes.meshes.end(),
                                    [](const auto& item) { return item.second.reshaped(); });
  meshes_.update(scene, changes);
  const auto alphas = alphas_by_index(materials_);
  if (structure) update_materials(scene, changes);
  if (changes.world) update_world(scene);
  if (structure || changes.world || !changes.images.empty()) update_images(scene, changes);
  if (structure || changes.world || !changes.material_params.empty()) update_params(scene);
  const bool records_moved = structure && update_attributes(scene);
  if (changes.instances || records_moved || reshaped || !changes.instance_matrices.empty() ||
      (structure && alphas != alphas_by_index(materials_)))
    ++geometry_revision_;
  if (changes.instances || records_moved)
    instances_.place_all(scene, meshes_);
  else
    for (const auto* some : {&changes.instance_matrices, &changes.instance_scales})
      instances_.place(scene, meshes_, *some);
  if (structure || resized) update_draws(scene);
  meshes_.flush();
  params_.flush();
  instances_.flush();
  draws_.flush();
}

void GpuScene::set_shading(GpuShading& shading, const std::string& name, const std::string& code,
                           const std::vector<scene::TextureUse>& textures) const {
  shading.name = name;
  shading.code = code;
  shading.textures = textures;
  shading.warnings.clear();
  const size_t limit = size_t(device_.max_texture_units - kImageUnit);
  if (textures.size() <= limit) return;
  shading.warnings.push_back(fmt::format(
      "Material '{}' uses {} images and this graphics driver allows {}; the others show magenta: "
      "merge some of its images.",
      name, textures.size(), limit));
  // Extra uses share the last unit, which then shows the colour of a missing image.
  shading.textures.resize(limit);
  shading.textures.back().image = 0;
}

void GpuScene::release(GpuShading& shading) {
  params_.release(shading.params);
  meshes_.tables().release(shading.attributes);
}

void GpuScene::update_materials(const scene::Scene& scene, const scene::Changes& changes) {
  std::set<scene::Id> used;
  for (const scene::Instance& instance : scene.instances()) {
    const scene::Mesh* mesh = scene.mesh_of(instance);
    if (!mesh) continue;
    for (const scene::MaterialRange& range : mesh->ranges)
      used.insert(scene.material_of(instance, range.slot));
  }
  // Draws know materials by index: the last one takes the place of one that goes, the others stay.
  for (size_t i = materials_.size(); i-- > 0;) {
    if (used.count(materials_[i].id)) continue;
    release(materials_[i]);
    material_indices_.erase(materials_[i].id);
    if (i + 1 < materials_.size()) {
      materials_[i] = std::move(materials_.back());
      material_indices_[materials_[i].id] = uint32_t(i);
    }
    materials_.pop_back();
  }
  for (const scene::Id id : used) {
    const auto [index, fresh] = material_indices_.try_emplace(id, uint32_t(materials_.size()));
    if (fresh) materials_.emplace_back().id = id;
    if (!fresh && !changes.materials.count(id)) continue;
    GpuMaterial& material = materials_[index->second];
    if (const auto found = scene.materials().find(id); found != scene.materials().end()) {
      set_shading(material, found->second.name, found->second.code, found->second.textures);
      material.facts = found->second.facts;
    } else {
      set_shading(material, "default", kDefaultMaterial, {});
    }
  }
}

void GpuScene::update_world(const scene::Scene& scene) {
  ++world_revision_;
  if (scene.world().black()) {
    if (world_) release(*world_);
    world_.reset();
    return;
  }
  if (!world_) world_.emplace();
  set_shading(*world_, "world", scene.world().code, scene.world().textures);
}

void GpuScene::update_images(scene::Scene& scene, const scene::Changes& changes) {
  image_warnings_.clear();
  std::map<scene::Id, bool> used;  // true: clipped by some sampler
  const auto use = [&](const GpuShading& shading) {
    for (const scene::TextureUse& texture : shading.textures)
      used[texture.image] |= texture.extension == scene::TextureUse::Extension::kClip;
  };
  for (const GpuMaterial& material : materials_) use(material);
  if (world_) {
    use(*world_);
    for (const scene::TextureUse& texture : world_->textures)
      if (changes.images.count(texture.image)) ++world_revision_;
  }
  std::erase_if(images_, [&](const auto& item) {
    const auto found = used.find(item.first);
    if (found == used.end() || (found->second && !item.second.bordered)) return true;
    const auto image = scene.images().find(item.first);
    return image == scene.images().end() || image->second.serial != item.second.serial;
  });
  for (const auto& [id, clipped] : used) {
    if (!images_.count(id)) {
      try {
        const scene::Image* image = scene.image_with_pixels(id);
        if (!image) {
          need_missing();
          continue;
        }
        images_[id] = upload_image(*image, device_.max_texture_size, clipped);
        scene.release_pixels(id);
      } catch (const Error& error) {
        image_warnings_.push_back(fmt::format("An image shows magenta: {}.", error.what()));
        need_missing();
        continue;
      }
    }
    if (const std::string& warning = images_[id].warning; !warning.empty())
      image_warnings_.push_back(warning);
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

bool GpuScene::upload_ahead(scene::Scene& scene) {
  for (const auto& [id, image] : scene.images()) {
    // How grey is laid out depends on the materials, which are not known yet.
    if (image.levels.empty() || image.channels == 1) continue;
    const auto held = images_.find(id);
    if (held != images_.end() && held->second.serial == image.serial) continue;
    images_[id] = upload_image(image, device_.max_texture_size, true);
    scene.release_pixels(id);
    return true;
  }
  return false;
}

std::vector<std::string> GpuScene::warnings() const {
  std::vector<std::string> all;
  const auto add = [&](const std::vector<std::string>& list) {
    all.insert(all.end(), list.begin(), list.end());
  };
  for (const GpuMaterial& material : materials_) add(material.warnings);
  if (world_) add(world_->warnings);
  add(image_warnings_);
  return all;
}

void GpuScene::need_missing() {
  if (missing_.texture) return;
  const uint8_t magenta[4] = {255, 0, 255, 255};
  missing_.texture = gl::Texture({GL_TEXTURE_2D, GL_RGBA8, 1, 1, 1, 1});
  missing_.texture.write(GL_RGBA, GL_UNSIGNED_BYTE, magenta);
}

void GpuScene::check_programs(const std::function<void(const GpuMaterial&)>& compile,
                              const std::function<void(const GpuShading&)>& compile_world) {
  for (GpuMaterial& material : materials_) {
    try {
      compile(material);
    } catch (const Error& error) {
      material.warnings.push_back(
          fmt::format("Material '{}' shows magenta: {}.", material.name, error.what()));
      material.code = kBrokenMaterial;
    }
  }
  if (!world_) return;
  try {
    compile_world(*world_);
  } catch (const Error& error) {
    world_->warnings.push_back(fmt::format("The world is shown black: {}.", error.what()));
    world_->code = "vec3 evaluate_world(vec3 direction) { return vec3(0.0); }\n";
  }
}

void GpuScene::update_params(const scene::Scene& scene) {
  for (GpuMaterial& material : materials_)
    if (const auto found = scene.materials().find(material.id); found != scene.materials().end())
      params_.store(material.params, std::span<const glm::vec4>(found->second.params));
  if (world_) params_.store(world_->params, std::span<const glm::vec4>(scene.world().params));
}

bool GpuScene::update_attributes(const scene::Scene& scene) {
  std::set<std::string> names;
  for (const GpuMaterial& material : materials_)
    if (const auto found = scene.materials().find(material.id); found != scene.materials().end())
      names.insert(found->second.attributes.begin(), found->second.attributes.end());
  const bool moved = meshes_.set_names(scene, names);
  for (GpuMaterial& material : materials_) {
    const auto found = scene.materials().find(material.id);
    if (found == scene.materials().end()) continue;
    std::vector<uint32_t> words;
    for (const std::string& name : found->second.attributes)
      words.push_back(meshes_.name_index(name));
    meshes_.tables().store(material.attributes, std::span<const uint32_t>(words));
  }
  return moved;
}

void GpuScene::update_draws(const scene::Scene& scene) {
  std::map<uint32_t, DrawLists::Audience> lists;
  for (size_t i = 0; i < scene.instances().size(); ++i) {
    const scene::Instance& instance = scene.instances()[i];
    const scene::Mesh* source = scene.mesh_of(instance);
    const bool camera = instance.visibility & shared::SEEN_BY_CAMERA,
               shadow = instance.visibility & shared::SEEN_BY_SHADOW;
    if (!source || !(camera || shadow)) continue;
    const size_t audience = camera && shadow ? 1 : camera ? 0 : 2;
    const GpuMesh& mesh = meshes_.mesh(instance.mesh);
    for (const scene::MaterialRange& range : source->ranges) {
      const uint32_t material = material_indices_.at(scene.material_of(instance, range.slot));
      const uint32_t list = materials_[material].facts.alpha ? material : DrawLists::kOpaque;
      lists[list][audience].push_back({instances_.place_of(i), material, range.first,
                                       range.count * 3, (mesh.triangles.first + range.first) * 3,
                                       mesh.vertices.first});
    }
  }
  draws_.update(lists);
}

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
  meshes_.bind();
  instances_.bind();
}

void GpuScene::bind_shading(const GpuShading& shading) const {
  params_.texture().bind(kParamUnit);
  for (size_t i = 0; i < shading.textures.size(); ++i) {
    const scene::TextureUse& use = shading.textures[i];
    const auto image = images_.find(use.image);
    const int unit = kImageUnit + int(i);
    (image == images_.end() ? missing_ : image->second).texture.bind(unit);
    samplers_[use.closest][int(use.extension)].bind(unit);
  }
  glUniform3ui(0, shading.params.first, shading.attributes.first, shading.srgb_mask);
}

void GpuScene::begin_draw() const {
  const GLuint array = vertex_array_.id();
  glVertexArrayVertexBuffer(array, 0, meshes_.vertices().id(), 0, 12);
  glVertexArrayAttribFormat(array, 0, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(array, 0, 0);
  glEnableVertexArrayAttrib(array, 0);
  glVertexArrayElementBuffer(array, meshes_.triangles().id());
  draws_.bind(vertex_array_);
  glBindVertexArray(array);
  bind_geometry();
}

}  // namespace panoptes::gpu_scene
