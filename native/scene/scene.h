// The scene as plain data: what Blender delivered, in the form that rendering wants. Knows no GL.
//
// Every setter validates its input, throws Error on nonsense, and records what changed, so that the
// image on the GPU uploads just that. Lengths are metres, matrices map object to world space and
// colours are scene-linear Rec.709. Ids are chosen by the caller and positive.
#pragma once

#include "base/runs.h"
#include "scene/image.h"
#include "scene/light.h"
#include "scene/packing.h"
#include "scene/visibility_shared.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace panoptes::scene {

using Id = int64_t;

struct Bounds {
  glm::vec3 low{std::numeric_limits<float>::max()};
  glm::vec3 high{-std::numeric_limits<float>::max()};
  bool empty() const { return low.x > high.x; }
  bool operator==(const Bounds&) const = default;
  void add(const glm::vec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
};

// Triangles of one material slot; they lie together.
struct MaterialRange {
  int slot = 0;
  uint32_t first = 0;
  uint32_t count = 0;
};

// Per triangle corner: two floats (UV map) or four (colour).
struct Attribute {
  std::string name;
  int channels = 2;
  std::vector<float> values;
};

struct Mesh {
  std::string name;
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;       // ordered by material slot
  std::vector<glm::uvec3> corner_normals;  // three packed units a triangle (base/packing.glsl)
  std::vector<MaterialRange> ranges;
  std::vector<Attribute> attributes;
  std::string default_uv, default_color;
  Bounds bounds;
  Bounds texture_space;  // mapped to 0..1 by generated coordinates
  std::string warning;  // what had to be left out; empty when nothing
};

// What a caller hands in for a mesh: Blender's own arrays.
struct MeshInput {
  std::string name;
  std::span<const glm::vec3> positions;           // a vertex
  std::span<const glm::ivec3> triangle_vertices;  // a triangle
  std::span<const glm::ivec3> triangle_loops;     // a triangle; index into loop arrays
  std::span<const int> triangle_slots;            // a triangle
  std::span<const glm::vec3> loop_normals;        // a loop
  struct LoopAttribute {
    std::string name;
    int channels;
    std::span<const float> values;  // channels a loop
  };
  std::vector<LoopAttribute> attributes;
  std::string default_uv, default_color;
  Bounds texture_space;  // empty: the bounds
};

// Orders triangles by slot, gathers loops to corners and leaves out triangles with a vertex that is
// not finite (said in Mesh::warning). Throws Error on an index out of range.
Mesh make_mesh(const MeshInput& input);

// The largest number of half precision, which scales have on the GPU.
constexpr float kMostIndirectScale = 65504;

struct Instance {
  Id mesh = 0;
  glm::mat4 object_to_world{1.0f};  // column-major, as GLM has it; not finite: draws nothing
  int material_offset = 0;          // in Scene::material_table, one entry a slot
  uint32_t visibility = shared::SEEN_BY_ALL;  // SEEN_BY_... bits
  // What its indirect light is multiplied by in Real-time: luminance and chrominance, each from 0 to
  // kMostIndirectScale.
  glm::vec2 indirect_scale{1.0f};
};

struct TextureUse {
  Id image = 0;
  bool closest = false;
  enum class Extension { kRepeat, kExtend, kClip } extension = Extension::kRepeat;
};

// Conservative: false only where the material certainly never has the property.
struct MaterialFacts {
  bool alpha = false;
  bool emission = false;
  bool emission_varies = true;  // over the surface or by its side; false: one radiance everywhere
  bool normal_map = false;
  bool glossy = true;
  bool transmission = false;
  bool layers = false;  // a coat or a sheen over the rest
  float least_roughness = 0;  // of all that reflects; refraction is not counted
};

struct Material {
  std::string name;
  std::string code;  // defines evaluate_material
  std::vector<glm::vec4> params;
  std::vector<TextureUse> textures;
  std::vector<std::string> attributes;
  MaterialFacts facts;
};

struct World {
  std::string code;  // defines evaluate_world
  std::vector<glm::vec4> params;
  std::vector<TextureUse> textures;
  std::optional<glm::vec3> constant = glm::vec3(0.0f);  // set when the direction does not matter
  bool black() const { return constant && *constant == glm::vec3(0.0f); }
};

// Everything that techniques decide on, without a look at a single vertex.
struct Facts {
  int64_t triangles = 0;
  int64_t instances = 0;
  int lamps[4] = {0, 0, 0, 0};  // by LightType
  int shadow_lamps[4] = {0, 0, 0, 0};
  bool extended_lamps = false;  // some lamp has an extent, so it casts penumbrae
  bool alpha = false, emission = false, normal_map = false, glossy = false, transmission = false;
  bool layers = false;
  float least_roughness = 1;    // of all glossy surfaces, conservative
  bool world = false;           // the world is not black
  int lamp_count() const { return lamps[0] + lamps[1] + lamps[2] + lamps[3]; }
  int shadow_lamp_count() const {
    return shadow_lamps[0] + shadow_lamps[1] + shadow_lamps[2] + shadow_lamps[3];
  }
};

// What of an array has changed: all of it, or runs of elements while their number stayed.
struct ArrayChange {
  bool all = true;
  std::vector<Run> runs;
};

struct MeshChange {
  ArrayChange positions, triangles, corner_normals;
  std::vector<ArrayChange> attributes;  // as in Mesh; those beyond its end have changed throughout
  // True when the mesh may have to lie elsewhere in memory.
  bool resized() const { return positions.all || triangles.all; }
  // True when triangles may have other corners.
  bool reshaped() const { return resized() || !positions.runs.empty() || !triangles.runs.empty(); }
};

// What has changed since the last take_changes().
struct Changes {
  std::map<Id, MeshChange> meshes;                   // set or removed
  std::set<Id> materials, material_params, images;  // set or removed
  std::set<uint32_t> instance_matrices, instance_scales;
  bool instances = false, lights = false, world = false;
  bool any() const {
    return instances || lights || world || !meshes.empty() || !materials.empty() ||
           !material_params.empty() || !images.empty() || !instance_matrices.empty() || !instance_scales.empty();
  }
};

class Scene {
 public:
  void set_mesh(Id id, Mesh mesh);
  void remove_mesh(Id id);
  // Instances whose matrix is not finite are left out (a warning) until they get another. Throws
  // Error on visibility bits that there are not, and on scales out of range.
  void set_instances(std::vector<Instance> instances, std::vector<Id> material_table);
  void set_instance_matrices(std::span<const int> indices, std::span<const glm::mat4> matrices);
  void set_instance_scales(std::span<const int> indices, std::span<const glm::vec2> scales);
  void set_material(Id id, Material material);
  // Values that differ; with them goes the fact that they decide on.
  void set_material_params(Id id, std::vector<glm::vec4> params, float least_roughness = 0);
  void remove_material(Id id);
  void set_image(Id id, Image image);
  void remove_image(Id id);
  // The image with its pixels, made again if they were released; null when there is none. Throws
  // Error when their source is gone.
  const Image* image_with_pixels(Id id);
  // Frees the pixels of an image that can be made again, which is no change of the scene.
  void release_pixels(Id id);
  void set_lights(std::vector<Light> lights);
  void set_world(World world);

  const std::map<Id, Mesh>& meshes() const { return meshes_; }
  const std::vector<Instance>& instances() const { return instances_; }
  const std::vector<Id>& material_table() const { return material_table_; }
  const std::map<Id, Material>& materials() const { return materials_; }
  const std::map<Id, Image>& images() const { return images_; }
  const std::vector<Light>& lights() const { return lights_; }
  const World& world() const { return world_; }

  // The mesh that an instance shows; null when there is none, no ray may meet it, or its place is
  // not finite.
  const Mesh* mesh_of(const Instance& instance) const;
  // The material of a slot of an instance; 0 (the default grey) where none is set.
  Id material_of(const Instance& instance, int slot) const;
  Facts facts() const;
  Bounds bounds() const;  // world space
  std::vector<std::string> warnings() const;
  Changes take_changes();

 private:
  void note_change(Id id, MeshChange change);
  // Throws Error unless there is an instance for each of `values` values.
  void check_indices(std::span<const int> indices, size_t values, const char* what) const;
  // The list of instances is read anew: changes of some of them say no more.
  void forget_single_instances();

  std::map<Id, Mesh> meshes_;
  std::vector<Instance> instances_;
  std::vector<Id> material_table_;
  std::map<Id, Material> materials_;
  std::map<Id, Image> images_;
  int64_t image_serial_ = 0;
  std::vector<Light> lights_;
  World world_;
  Changes changes_;
};

// The world bounds of one placed mesh.
Bounds placed_bounds(const Bounds& bounds, const glm::mat4& object_to_world);

}  // namespace panoptes::scene
