#include "python/mesh.h"

#include "base/error.h"
#include "python/mesh_pointers.h"
#include "python/post.h"

#include <bit>
#include <cstring>
#include <optional>

namespace panoptes::python {

namespace {

using engine::Engine;
using scene::Id;

// 64 bits of a block of memory, to tell contents apart. Four chains keep a processor's multipliers
// busy, so that this runs about as fast as memory is read.
uint64_t digest(const void* data, size_t size) {
  constexpr uint64_t kOdd = 0x9e3779b97f4a7c15u;  // 2^64 over the golden ratio
  uint64_t chains[4] = {size, ~size, size ^ kOdd, size + kOdd};
  const auto* bytes = static_cast<const unsigned char*>(data);
  const auto mix = [](uint64_t& chain, uint64_t word) {
    chain = (chain ^ word) * kOdd;
    chain ^= chain >> 29;
  };
  for (; size >= 32; bytes += 32, size -= 32)
    for (int i = 0; i < 4; ++i) {
      uint64_t word;
      std::memcpy(&word, bytes + i * 8, 8);
      mix(chains[i], word);
    }
  for (; size > 0; ++bytes, --size) mix(chains[0], *bytes);
  uint64_t result = 0;
  for (const uint64_t chain : chains) mix(result, std::rotl(chain, 32));
  return result;
}

template <class T>
uint64_t digest(const std::vector<T>& values) {
  return digest(values.data(), values.size() * sizeof(T));
}

// A mesh on its way into an engine.
struct MeshHandle {
  std::optional<scene::Mesh> mesh;  // gone once an engine has it
  size_t triangles = 0, broken_vertices = 0;
  py::dict fingerprint;

  MeshHandle(scene::Mesh made, size_t broken)
      : mesh(std::move(made)), triangles(mesh->triangles.size()), broken_vertices(broken) {
    // The name is no part of what is drawn.
    fingerprint["positions"] = digest(mesh->positions);
    fingerprint["triangles"] = digest(mesh->triangles);
    fingerprint["normals"] = digest(mesh->corner_normals);
    fingerprint["slots"] = digest(mesh->ranges);
    fingerprint["texture_space"] = digest(&mesh->texture_space, sizeof(mesh->texture_space));
    fingerprint["default_uv"] = mesh->default_uv;
    fingerprint["default_color"] = mesh->default_color;
    py::dict attributes;
    for (const scene::Attribute& a : mesh->attributes)
      attributes[py::str(a.name)] = py::make_tuple(a.channels, digest(a.values));
    fingerprint["attributes"] = attributes;
  }
};

// (low, high) in object space; none: what the triangles take up.
using Box = std::optional<std::pair<std::array<float, 3>, std::array<float, 3>>>;

scene::Bounds bounds_of(const Box& box) {
  if (!box) return {};
  const auto& [low, high] = *box;
  return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

scene::Mesh mesh_of_arrays(const std::string& name, const Array<float>& positions,
                           const Array<int>& triangle_vertices, const Array<int>& triangle_loops,
                           const Array<int>& triangle_slots, const Array<float>& loop_normals,
                           const py::dict& attributes, const std::string& default_uv,
                           const std::string& default_color, const Box& texture_space) {
  scene::MeshInput input;
  input.name = name;
  input.positions = rows<glm::vec3>(positions, "positions", 3);
  input.triangle_vertices = rows<glm::ivec3>(triangle_vertices, "triangle_vertices", 3);
  input.triangle_loops = rows<glm::ivec3>(triangle_loops, "triangle_loops", 3);
  input.triangle_slots = rows<int>(triangle_slots, "triangle_slots", 1);
  input.loop_normals = rows<glm::vec3>(loop_normals, "loop_normals", 3);
  input.default_uv = default_uv;
  input.default_color = default_color;
  input.texture_space = bounds_of(texture_space);
  std::vector<Array<float>> keep;  // the arrays that the spans below point into
  for (const auto& [key, value] : attributes) {
    keep.push_back(value.cast<Array<float>>());
    const Array<float>& array = keep.back();
    const int channels = array.ndim() == 2 ? int(array.shape(1)) : 0;
    if (channels != 2 && channels != 4)
      fail("attribute '{}' of mesh '{}' must have two or four values a loop: please report it",
           key.cast<std::string>(), name);
    input.attributes.push_back(
        {key.cast<std::string>(), channels, {array.data(), size_t(array.size())}});
  }
  py::gil_scoped_release release;
  return scene::make_mesh(input);
}

// (address, length) of an array in Blender's memory; address 0 where there is none.
using Block = std::pair<uintptr_t, size_t>;

std::optional<MeshHandle> mesh_of_memory(
    const std::string& name, Block vertices, Block loops, Block polygons, Block triangles,
    uintptr_t loop_normals, uintptr_t vertex_normals, uintptr_t polygon_normals, uintptr_t slots,
    int slot_count,
    const std::vector<std::tuple<std::string, std::string, std::string, uintptr_t, size_t>>&
        attributes,
    const std::string& default_uv, const std::string& default_color, const Box& texture_space) {
  MeshPointers p{name, default_uv, default_color,
                 vertices.first, loops.first, polygons.first, triangles.first,
                 vertices.second, loops.second, polygons.second, triangles.second,
                 loop_normals, vertex_normals, polygon_normals, slots, slot_count,
                 bounds_of(texture_space), {}};
  for (const auto& [attribute, domain, type, address, count] : attributes)
    p.attributes.push_back({attribute, domain, type, address, count});
  // The GIL is held: nobody may touch the mesh meanwhile.
  std::optional<scene::BuiltMesh> found = read_mesh(p);
  if (!found) return std::nullopt;
  return MeshHandle(std::move(found->mesh), found->broken_vertices);
}

void put(Engine& engine, Id id, scene::Mesh mesh) {
  py::gil_scoped_release release;
  post(engine, [id, mesh = std::move(mesh)](scene::Scene& scene) mutable { scene.set_mesh(id, std::move(mesh)); });
}

}  // namespace

void bind_meshes(py::module_& m, py::class_<Engine>& engine) {
  py::class_<MeshHandle>(m, "Mesh", "A mesh ready for an engine, which takes it as it is.")
      .def_readonly("triangles", &MeshHandle::triangles, "Triangles that are drawn.")
      .def_readonly("broken_vertices", &MeshHandle::broken_vertices,
                    "Vertices that are not finite; their triangles are left out.")
      .def_readonly("fingerprint", &MeshHandle::fingerprint,
                    "A dictionary of digests of the parts: equal for meshes of the same bits.");
  m.def("make_mesh",
        [](const std::string& name, const Array<float>& positions,
           const Array<int>& triangle_vertices, const Array<int>& triangle_loops,
           const Array<int>& triangle_slots, const Array<float>& loop_normals,
           const py::dict& attributes, const std::string& default_uv,
           const std::string& default_color, const Box& texture_space) {
          return MeshHandle(mesh_of_arrays(name, positions, triangle_vertices, triangle_loops,
                                           triangle_slots, loop_normals, attributes, default_uv,
                                           default_color, texture_space),
                            0);
        },
        py::arg("name"), py::arg("positions"), py::arg("triangle_vertices"),
        py::arg("triangle_loops"), py::arg("triangle_slots"), py::arg("loop_normals"),
        py::arg("attributes"), py::arg("default_uv") = "", py::arg("default_color") = "",
        py::arg("texture_space") = py::none(), "A Mesh from plain arrays.");
  m.def("read_mesh", &mesh_of_memory, py::kw_only(), py::arg("name"), py::arg("vertices"),
        py::arg("loops"), py::arg("polygons"), py::arg("triangles"), py::arg("loop_normals"),
        py::arg("vertex_normals"), py::arg("polygon_normals"), py::arg("slots"),
        py::arg("slot_count"), py::arg("attributes"), py::arg("default_uv"),
        py::arg("default_color"), py::arg("texture_space"),
        "A Mesh from the memory of Blender 3.4, or None where it does not look like a mesh.");
  m.def("find_loop_normals", &find_loop_normals, py::arg("mesh"), py::arg("loops"),
        py::arg("loop_count"),
        "The address of a mesh's split normals in Blender 3.4, or 0.");
  engine
      .def("set_mesh",
           [](Engine& e, Id id, const std::string& name, const Array<float>& positions,
              const Array<int>& triangle_vertices, const Array<int>& triangle_loops,
              const Array<int>& triangle_slots, const Array<float>& loop_normals,
              const py::dict& attributes, const std::string& default_uv,
              const std::string& default_color, const Box& texture_space) {
             put(e, id,
                 mesh_of_arrays(name, positions, triangle_vertices, triangle_loops, triangle_slots,
                                loop_normals, attributes, default_uv, default_color,
                                texture_space));
           },
           py::arg("id"), py::arg("name"), py::arg("positions"), py::arg("triangle_vertices"),
           py::arg("triangle_loops"), py::arg("triangle_slots"), py::arg("loop_normals"),
           py::arg("attributes"), py::arg("default_uv") = "", py::arg("default_color") = "",
           py::arg("texture_space") = py::none())
      .def("set_mesh",
           [](Engine& e, Id id, MeshHandle& handle) {
             if (!handle.mesh) fail("a mesh was handed over twice: please report it");
             scene::Mesh mesh = *std::exchange(handle.mesh, std::nullopt);
             put(e, id, std::move(mesh));
           },
           py::arg("id"), py::arg("mesh"));
}

}  // namespace panoptes::python
