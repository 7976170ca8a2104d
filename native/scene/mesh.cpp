#include "base/error.h"
#include "scene/mesh_builder.h"

#include <algorithm>

namespace panoptes::scene {

namespace {

void check(const MeshInput& in) {
  const size_t count = in.triangle_vertices.size();
  if (in.triangle_loops.size() != count || in.triangle_slots.size() != count)
    fail("mesh '{}' was handed over with arrays of different lengths: please report it", in.name);
  const int vertices = int(in.positions.size()), loops = int(in.loop_normals.size());
  for (size_t t = 0; t < count; ++t)
    for (int k = 0; k < 3; ++k) {
      const int v = in.triangle_vertices[t][k], l = in.triangle_loops[t][k];
      if (v < 0 || v >= vertices || l < 0 || l >= loops)
        fail("mesh '{}' has a triangle with an index out of range: run Mesh > Clean Up on it, or "
             "validate the mesh",
             in.name);
    }
  for (const MeshInput::LoopAttribute& a : in.attributes)
    if (a.values.size() != in.loop_normals.size() * size_t(a.channels))
      fail("attribute '{}' of mesh '{}' has the wrong length: please report it", a.name, in.name);
}

// A MeshInput for build_mesh(), with its normals packed once a loop.
struct Arrays : MeshInput {
  explicit Arrays(const MeshInput& input) : MeshInput(input), packed(loop_normals.size()) {
    for (size_t l = 0; l < packed.size(); ++l) packed[l] = pack_unit(loop_normals[l]);
  }
  size_t vertices() const { return positions.size(); }
  size_t triangles() const { return triangle_vertices.size(); }
  glm::vec3 position(size_t v) const { return positions[v]; }
  glm::uvec3 corners(size_t t) const { return glm::uvec3(triangle_vertices[t]); }
  int slot(size_t t) const { return triangle_slots[t]; }
  glm::uvec3 normals(size_t t) const {
    const glm::ivec3 l = triangle_loops[t];
    return {packed[size_t(l.x)], packed[size_t(l.y)], packed[size_t(l.z)]};
  }
  template <class Add>
  void attributes(const Add& add) const {
    for (const LoopAttribute& a : MeshInput::attributes)
      add(a.name, a.channels, [this, &a](size_t t, int k, float* out) {
        const float* value = &a.values[size_t(triangle_loops[t][k]) * size_t(a.channels)];
        std::copy(value, value + a.channels, out);
      });
  }
  std::vector<uint32_t> packed;
};

}  // namespace

Mesh make_mesh(const MeshInput& input) {
  check(input);
  return build_mesh(Arrays(input)).mesh;
}

}  // namespace panoptes::scene
