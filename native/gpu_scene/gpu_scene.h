// The scene's image on the GPU: geometry heaps, instances, materials, textures, and the lists by
// which any view is drawn. update() uploads what changed and nothing else.
#pragma once

#include "gl/context.h"
#include "gl/program.h"
#include "gpu_scene/heap.h"
#include "gpu_scene/view_shared.h"
#include "scene/scene.h"

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace panoptes::gpu_scene {

// Texture units that the geometry and the materials are bound to (gpu_scene/*.glsl).
constexpr int kVertexUnit = 0, kTriangleUnit = 1, kNormalUnit = 2, kAttributeUnit = 3,
              kInstanceUnit = 4, kTableUnit = 5, kParamUnit = 6, kFreeUnit = 7, kImageUnit = 8;

struct GpuImage {
  gl::Texture texture;
  bool srgb = false;  // sampling gives sRGB codes
};

// Uploads with all levels; averaged as light, not as codes, where the driver allows. Throws Error
// when a side exceeds `max_size`.
GpuImage upload_image(const scene::Image& image, int max_size);

// A program's generated part and what must be bound for it.
struct GpuShading {
  std::string name;
  std::string code;
  uint32_t params = 0;      // first vec4
  uint32_t attributes = 0;  // first word in the tables
  uint32_t srgb_mask = 0;
  std::vector<scene::TextureUse> textures;
};

struct GpuMaterial : GpuShading {
  scene::Id id = 0;
  scene::MaterialFacts facts;
};

// Whose view is drawn: instances may be hidden from the camera or from lamps.
enum class ViewKind { kCamera, kShadow };

// Draw commands that lie together, ordered by who sees them: the camera alone, both, lamps alone.
struct DrawGroup {
  uint32_t first = 0;
  uint32_t camera_only = 0, both = 0, shadow_only = 0;

  uint32_t first_of(ViewKind kind) const {
    return kind == ViewKind::kCamera ? first : first + camera_only;
  }
  uint32_t count_of(ViewKind kind) const {
    return both + (kind == ViewKind::kCamera ? camera_only : shadow_only);
  }
};

// Those of one material that may discard fragments.
struct AlphaGroup {
  uint32_t material = 0;
  DrawGroup draws;
};

class GpuScene {
 public:
  explicit GpuScene(const gl::DeviceInfo& device);

  // Brings the GPU up to date with what changed in `scene` since the last call.
  void update(scene::Scene& scene);

  // Calls `compile` for every material's program; one that throws is replaced by a material that
  // always compiles, with a warning. The same for the world.
  void check_programs(const std::function<void(const GpuMaterial&)>& compile,
                      const std::function<void(const GpuShading&)>& compile_world);

  const std::vector<GpuMaterial>& materials() const { return materials_; }
  const std::optional<GpuShading>& world() const { return world_; }
  int world_image_width() const { return world_image_width_; }
  const gl::Buffer& records() const { return records_; }
  bool empty() const { return record_count_ == 0; }
  // Grows with every change, so that what was derived from the scene can be kept until then.
  int64_t revision() const { return revision_; }
  // The same for the world alone.
  int64_t world_revision() const { return world_revision_; }

  // The defines and snippets that the generated code of a material (or the world) needs.
  static void add_material(const GpuMaterial& material, gl::ProgramSource& source);
  static void add_world(const GpuShading& world, gl::ProgramSource& source);

  // Binds what every program that includes gpu_scene/geometry.glsl reads.
  void bind_geometry() const;
  // Binds parameters and images and sets the uniform `material_block` of the program in use.
  void bind_shading(const GpuShading& shading) const;

  // Draws all opaque records that such a view sees, then the groups with alpha; `before_group` puts
  // the right program in use and is called with null for the opaque records.
  template <class BeforeGroup>
  void draw(ViewKind kind, BeforeGroup before_group) const {
    begin_draw();
    if (opaque_.count_of(kind) > 0) {
      before_group(static_cast<const GpuMaterial*>(nullptr));
      draw_range(opaque_.first_of(kind), opaque_.count_of(kind));
    }
    for (const AlphaGroup& group : alpha_groups_) {
      if (group.draws.count_of(kind) == 0) continue;
      before_group(&materials_[group.material]);
      draw_range(group.draws.first_of(kind), group.draws.count_of(kind));
    }
  }

  // What could not be done as asked, for the artist.
  std::vector<std::string> warnings() const;

 private:
  struct GpuMesh {
    Range vertices, triangles, normals;
    std::vector<Range> attributes;  // as in scene::Mesh
    uint32_t record = 0;            // first word in the tables
  };

  void update_meshes(const scene::Scene& scene, const scene::Changes& changes);
  void update_materials(const scene::Scene& scene);
  void update_images(const scene::Scene& scene, const scene::Changes& changes);
  void need_missing();
  void update_params(const scene::Scene& scene);
  void update_tables(const scene::Scene& scene);
  void update_instances(const scene::Scene& scene, const scene::Changes& changes);
  void update_draws(const scene::Scene& scene);
  uint32_t material_index(scene::Id id) const;
  GpuShading make_shading(const std::string& name, const std::string& code,
                          const std::vector<scene::TextureUse>& textures);

  void begin_draw() const;
  void draw_range(uint32_t first, uint32_t count) const;

  gl::DeviceInfo device_;
  int64_t revision_ = 0, world_revision_ = 0;
  Heap vertices_, triangles_, normals_, attributes_;
  std::map<scene::Id, GpuMesh> meshes_;
  std::map<scene::Id, GpuImage> images_;
  GpuImage missing_;
  std::vector<GpuMaterial> materials_;
  std::map<scene::Id, uint32_t> material_indices_;
  std::optional<GpuShading> world_;
  int world_image_width_ = 0;
  gl::Buffer instances_buffer_, tables_buffer_, params_buffer_, records_, commands_;
  gl::Texture instances_, tables_, params_;
  gl::VertexArray vertex_array_;
  std::vector<AlphaGroup> alpha_groups_;
  DrawGroup opaque_;
  uint32_t record_count_ = 0;
  gl::Sampler samplers_[2][3];  // [linear, closest][repeat, extend, clip]
  std::vector<std::string> material_warnings_, image_warnings_;
};

}  // namespace panoptes::gpu_scene
