// The scene's image on the GPU: geometry heaps, instances, materials, textures, and the lists by
// which any view is drawn. update() uploads what changed and nothing else.
#pragma once

#include "gl/context.h"
#include "gl/program.h"
#include "gpu_scene/draw_lists.h"
#include "gpu_scene/image_upload.h"
#include "gpu_scene/instance_list.h"
#include "gpu_scene/mesh_store.h"
#include "gpu_scene/units.h"
#include "gpu_scene/view_shared.h"
#include "scene/scene.h"

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace panoptes::gpu_scene {

// A program's generated part and what must be bound for it.
struct GpuShading {
  std::string name;
  std::string code;
  Range params;      // vec4s
  Range attributes;  // words in the tables
  uint32_t srgb_mask = 0;
  std::vector<scene::TextureUse> textures;
  std::vector<std::string> warnings;  // what of it could not be shown as asked
};

struct GpuMaterial : GpuShading {
  scene::Id id = 0;
  scene::MaterialFacts facts;
};

class GpuScene {
 public:
  explicit GpuScene(const gl::DeviceInfo& device);

  // Brings the GPU up to date with what changed in `scene` since the last call.
  void update(scene::Scene& scene);

  // Uploads one image that has pixels and is not there yet, so that frames find it there; false when
  // there is none.
  bool upload_ahead(scene::Scene& scene);

  // Calls `compile` for every material's program; one that throws is replaced by a material that
  // always compiles, with a warning. The same for the world.
  void check_programs(const std::function<void(const GpuMaterial&)>& compile,
                      const std::function<void(const GpuShading&)>& compile_world);

  const std::vector<GpuMaterial>& materials() const { return materials_; }
  const std::optional<GpuShading>& world() const { return world_; }
  int world_image_width() const { return world_image_width_; }
  const gl::Buffer& records() const { return draws_.records(); }
  bool empty() const { return draws_.empty(); }
  // These grow with every change of what can be derived from the scene, to keep it until then: shadow
  // maps (geometry, lamps, materials with an alpha) and the light of glowing surfaces.
  int64_t shadow_revision() const { return shadow_revision_; }
  int64_t emission_revision() const { return emission_revision_; }
  // The same for the world alone.
  int64_t world_revision() const { return world_revision_; }
  // The same for what rays meet: shapes, places and visibility of instances, which material each
  // triangle has, and which of these have an alpha.
  int64_t geometry_revision() const { return geometry_revision_; }

  // The same for how surfaces look at all: materials and their values, images, shapes and places.
  int64_t surface_revision() const { return surface_revision_; }

  // Where the GPU holds the scene's instance number `index`, which has to be one that is drawn.
  uint32_t place_of(size_t index) const { return instances_.place_of(index); }
  // Where materials() holds a material that some drawn instance shows; 0: the one of empty slots.
  uint32_t material_index(scene::Id id) const { return material_indices_.at(id); }

  // The defines and snippets that the generated code of a material (or the world) needs.
  static void add_material(const GpuMaterial& material, gl::ProgramSource& source);
  static void add_world(const GpuShading& world, gl::ProgramSource& source);

  // Binds what every program that includes gpu_scene/geometry.glsl reads.
  void bind_geometry() const;
  // Its instances alone, for another unit.
  void bind_instances(int unit) const { instances_.bind(unit); }
  // Binds parameters and images and sets the uniform `material_block` of the program in use.
  void bind_shading(const GpuShading& shading) const;

  // Draws all opaque records that such a view sees, then the groups with alpha; `before_group` puts
  // the right program in use and is called with null for the opaque records.
  template <class BeforeGroup>
  void draw(ViewKind kind, BeforeGroup before_group) const {
    begin_draw();
    draws_.draw(kind, [&](uint32_t material) {
      before_group(material == DrawLists::kOpaque ? static_cast<const GpuMaterial*>(nullptr)
                                                  : &materials_[material]);
    });
  }

  // What could not be done as asked, for the artist.
  std::vector<std::string> warnings() const;

 private:
  void update_materials(const scene::Scene& scene, const scene::Changes& changes);
  void update_world(const scene::Scene& scene);
  void update_images(scene::Scene& scene, const scene::Changes& changes);
  void need_missing();
  void update_params(const scene::Scene& scene);
  // True when mesh records have moved.
  bool update_attributes(const scene::Scene& scene);
  void update_draws(const scene::Scene& scene);
  // Everything of `shading` but what lies in shared buffers.
  void set_shading(GpuShading& shading, const std::string& name, const std::string& code,
                   const std::vector<scene::TextureUse>& textures) const;
  void release(GpuShading& shading);

  void begin_draw() const;

  gl::DeviceInfo device_;
  int64_t shadow_revision_ = 0, emission_revision_ = 0, world_revision_ = 0,
          geometry_revision_ = 0, surface_revision_ = 0;
  MeshStore meshes_;
  InstanceList instances_;
  DrawLists draws_;
  MirroredHeap<glm::vec4> params_;
  std::map<scene::Id, GpuImage> images_;
  GpuImage missing_;
  std::vector<GpuMaterial> materials_;
  std::map<scene::Id, uint32_t> material_indices_;
  std::optional<GpuShading> world_;
  int world_image_width_ = 0;
  gl::VertexArray vertex_array_;
  gl::Sampler samplers_[2][3];  // [linear, closest][repeat, extend, clip]
  std::vector<std::string> image_warnings_;
};

}  // namespace panoptes::gpu_scene
