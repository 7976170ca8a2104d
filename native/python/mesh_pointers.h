// Meshes straight from the memory of Blender 3.4.
//
// That version keeps a mesh in arrays of structs, and Python's foreach_get visits their elements one
// by one: half a second for a million triangles. Here they are read where they lie, in some tens of
// milliseconds. Whoever calls knows the version, has compared the distance of elements with the sizes
// below and their values with what Blender says, and holds the mesh still; nothing is kept.
//
// Source of the layouts: the DNA block of a file written by 3.4.1.
#pragma once

#include "scene/mesh_builder.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace panoptes::python {

// Elements of Blender 3.4's arrays.
namespace blender34 {
struct Vertex {
  float position[3];
  uint8_t flags[4];
};
struct Loop {
  uint32_t vertex, edge;
};
struct Polygon {
  int32_t first_loop, loops;
  int16_t former_slot;
  uint8_t flags, padding;
  bool smooth() const { return flags & 1; }
};
struct Triangle {
  uint32_t loops[3], polygon;
};
struct UV {
  float uv[2];
  int32_t flags;
};
static_assert(sizeof(Vertex) == 16 && sizeof(Loop) == 8 && sizeof(Polygon) == 12 &&
              sizeof(Triangle) == 16 && sizeof(UV) == 12);
}  // namespace blender34

// An attribute's array; what it means follows from the domain and the type, by their RNA names.
struct AttributePointer {
  std::string name, domain, type;
  uintptr_t address = 0;
  size_t count = 0;
};

// Where the arrays of one mesh begin, and how long they are. Normals are either split (a loop) or,
// on meshes without auto smooth, those of vertices and of polygons.
struct MeshPointers {
  std::string name, default_uv, default_color;
  uintptr_t vertices = 0, loops = 0, polygons = 0, triangles = 0;
  size_t vertex_count = 0, loop_count = 0, polygon_count = 0, triangle_count = 0;
  uintptr_t loop_normals = 0, vertex_normals = 0, polygon_normals = 0;
  uintptr_t slots = 0;  // int32 a polygon; 0 when all are slot 0
  int slot_count = 1;   // polygons beyond it use the last one
  scene::Bounds texture_space;
  std::vector<AttributePointer> attributes;
};

// Copies a mesh. Nothing when an index leads out of an array or an attribute is of an unknown kind:
// then this is not the memory that it was taken for.
std::optional<scene::BuiltMesh> read_mesh(const MeshPointers& pointers);

// The address of the split normals of the Mesh at `mesh`, float[3] a loop; 0 when it has none or is
// not what it was taken for. `loops` is where its loops begin.
uintptr_t find_loop_normals(uintptr_t mesh, uintptr_t loops, size_t loop_count);

}  // namespace panoptes::python
