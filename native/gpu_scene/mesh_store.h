// All meshes on the GPU: vertices, triangles, normals and attributes in one heap each, and a record
// a mesh that says where its own begin (geometry.glsl has the layout).
#pragma once

#include "gl/context.h"
#include "gpu_scene/mirrored_buffer.h"
#include "scene/scene.h"

#include <map>
#include <set>
#include <string>

namespace panoptes::gpu_scene {

struct GpuMesh {
  Range vertices, triangles, normals;
  std::vector<Range> attributes;  // as in scene::Mesh
  Range record;                   // words in the tables
};

class MeshStore {
 public:
  explicit MeshStore(const gl::DeviceInfo& device);

  // Sends what differs of the changed meshes.
  void update(const scene::Scene& scene, const scene::Changes& changes);
  // Attributes that materials ask for by name; every mesh record has a word for each. True when
  // records have moved.
  bool set_names(const scene::Scene& scene, const std::set<std::string>& names);
  // The word of a name that set_names() was told of, counted from MESH_ATTRIBUTES.
  uint32_t name_index(const std::string& name) const { return names_.at(name); }
  void flush() { tables_.flush(); }

  const GpuMesh& mesh(scene::Id id) const { return meshes_.at(id); }
  // The words that records and whoever else needs a table share.
  MirroredHeap<uint32_t>& tables() { return tables_; }
  const gl::Buffer& vertices() const { return vertices_.buffer(); }
  const gl::Buffer& triangles() const { return triangles_.buffer(); }
  void bind() const;

 private:
  void update_arrays(GpuMesh& mesh, const scene::Mesh& source, const scene::MeshChange& change);
  void update_record(GpuMesh& mesh, const scene::Mesh& source);
  void remove(GpuMesh& mesh);

  Heap vertices_, triangles_, normals_, attributes_;
  MirroredHeap<uint32_t> tables_;
  std::map<scene::Id, GpuMesh> meshes_;
  std::map<std::string, uint32_t> names_;
  uint32_t name_words_ = 8;  // in each record
};

}  // namespace panoptes::gpu_scene
