#include "python/mesh_pointers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace panoptes::python {

namespace {

using namespace blender34;

template <class T>
const T* at(uintptr_t address) {
  return reinterpret_cast<const T*>(address);
}

// As Blender's getter of byte colours decodes them.
const std::array<float, 256>& srgb_table() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> result;
    for (int i = 0; i < 256; ++i) {
      const float c = float(i) * (1.0f / 255.0f);
      result[size_t(i)] = c < 0.04045f ? c * (1.0f / 12.92f)
                                       : std::pow((c + 0.055f) * (1.0f / 1.055f), 2.4f);
    }
    return result;
  }();
  return table;
}

enum class Kind { kUV, kFloat, kInt, kInt8, kBool, kVector, kVector2, kColor, kByteColor, kUnknown };

Kind kind_of(const AttributePointer& a) {
  static const std::map<std::string, Kind> kinds{
      {"UV", Kind::kUV},           {"FLOAT", Kind::kFloat},         {"INT", Kind::kInt},
      {"INT8", Kind::kInt8},       {"BOOLEAN", Kind::kBool},        {"FLOAT_VECTOR", Kind::kVector},
      {"FLOAT2", Kind::kVector2},  {"FLOAT_COLOR", Kind::kColor},   {"BYTE_COLOR", Kind::kByteColor}};
  const auto found = kinds.find(a.type);
  return found == kinds.end() ? Kind::kUnknown : found->second;
}

// Stores one element: numbers as grey, vectors as colours, both opaque.
template <Kind kind>
void store(uintptr_t address, size_t i, float* out) {
  const auto grey = [&](float v) { out[0] = out[1] = out[2] = v, out[3] = 1.0f; };
  if constexpr (kind == Kind::kUV) {
    std::memcpy(out, at<UV>(address)[i].uv, 8);
  } else if constexpr (kind == Kind::kFloat) {
    grey(at<float>(address)[i]);
  } else if constexpr (kind == Kind::kInt) {
    grey(float(at<int32_t>(address)[i]));
  } else if constexpr (kind == Kind::kInt8) {
    grey(float(at<int8_t>(address)[i]));
  } else if constexpr (kind == Kind::kBool) {
    grey(at<uint8_t>(address)[i] ? 1.0f : 0.0f);
  } else if constexpr (kind == Kind::kVector) {
    std::memcpy(out, at<float>(address) + i * 3, 12);
    out[3] = 1.0f;
  } else if constexpr (kind == Kind::kVector2) {
    std::memcpy(out, at<float>(address) + i * 2, 8);
    out[2] = 0.0f, out[3] = 1.0f;
  } else if constexpr (kind == Kind::kColor) {
    std::memcpy(out, at<float>(address) + i * 4, 16);
  } else if constexpr (kind == Kind::kByteColor) {
    const uint8_t* color = at<uint8_t>(address) + i * 4;
    for (int c = 0; c < 3; ++c) out[c] = srgb_table()[color[c]];
    out[3] = float(color[3]) * (1.0f / 255.0f);
  }
}

// Normals whose components are not finite count as zero there, as on the way through numpy.
std::vector<uint32_t> pack(uintptr_t normals, size_t count) {
  std::vector<uint32_t> packed(count);
  for (size_t i = 0; i < count; ++i) {
    glm::vec3 n;
    std::memcpy(&n, at<float>(normals) + i * 3, 12);
    if (!scene::finite(n))
      for (int c = 0; c < 3; ++c)
        if (!std::isfinite(n[c])) n[c] = 0.0f;
    packed[i] = scene::pack_unit(n);
  }
  return packed;
}

// The arrays as build_mesh() wants them.
struct Source : MeshPointers {
  explicit Source(const MeshPointers& p) : MeshPointers(p) {
    if (loop_normals) {
      packed = pack(loop_normals, loop_count);
    } else {
      const auto* first = at<Polygon>(polygons);
      const auto smooth = size_t(std::count_if(first, first + polygon_count,
                                               [](const Polygon& p) { return p.smooth(); }));
      if (smooth > 0) packed = pack(vertex_normals, vertex_count);
      if (smooth < polygon_count) packed_polygons = pack(polygon_normals, polygon_count);
    }
  }
  const Triangle& triangle(size_t t) const { return at<Triangle>(MeshPointers::triangles)[t]; }
  uint32_t vertex(uint32_t loop) const { return at<Loop>(loops)[loop].vertex; }

  size_t vertices() const { return vertex_count; }
  size_t triangles() const { return triangle_count; }
  glm::vec3 position(size_t v) const {
    const float* p = at<Vertex>(MeshPointers::vertices)[v].position;
    return {p[0], p[1], p[2]};
  }
  glm::uvec3 corners(size_t t) const {
    const Triangle& tri = triangle(t);
    return {vertex(tri.loops[0]), vertex(tri.loops[1]), vertex(tri.loops[2])};
  }
  int slot(size_t t) const {
    if (!slots) return 0;
    return std::clamp(at<int32_t>(slots)[triangle(t).polygon], 0, slot_count - 1);
  }
  glm::uvec3 normals(size_t t) const {
    const Triangle& tri = triangle(t);
    if (loop_normals) return {packed[tri.loops[0]], packed[tri.loops[1]], packed[tri.loops[2]]};
    if (!at<Polygon>(polygons)[tri.polygon].smooth()) return glm::uvec3(packed_polygons[tri.polygon]);
    const glm::uvec3 v = corners(t);
    return {packed[v.x], packed[v.y], packed[v.z]};
  }

  template <class Add>
  void attributes(const Add& add) const {
    for (const AttributePointer& a : MeshPointers::attributes) {
      switch (kind_of(a)) {
        case Kind::kUV: write<Kind::kUV>(a, add); break;
        case Kind::kFloat: write<Kind::kFloat>(a, add); break;
        case Kind::kInt: write<Kind::kInt>(a, add); break;
        case Kind::kInt8: write<Kind::kInt8>(a, add); break;
        case Kind::kBool: write<Kind::kBool>(a, add); break;
        case Kind::kVector: write<Kind::kVector>(a, add); break;
        case Kind::kVector2: write<Kind::kVector2>(a, add); break;
        case Kind::kColor: write<Kind::kColor>(a, add); break;
        case Kind::kByteColor: write<Kind::kByteColor>(a, add); break;
        case Kind::kUnknown: break;
      }
    }
  }
  template <Kind kind, class Add>
  void write(const AttributePointer& a, const Add& add) const {
    const int channels = kind == Kind::kUV ? 2 : 4;
    const uintptr_t from = a.address;
    if (a.domain == "CORNER")
      add(a.name, channels, [this, from](size_t t, int k, float* out) {
        store<kind>(from, triangle(t).loops[k], out);
      });
    else if (a.domain == "POINT")
      add(a.name, channels, [this, from](size_t t, int k, float* out) {
        store<kind>(from, vertex(triangle(t).loops[k]), out);
      });
    else
      add(a.name, channels,
          [this, from](size_t t, int, float* out) { store<kind>(from, triangle(t).polygon, out); });
  }

  std::vector<uint32_t> packed, packed_polygons;
};

// Whether every index stays within its array, and every attribute is as long as its domain.
bool plausible(const MeshPointers& p) {
  // Maxima, not early returns: the compiler turns these loops into a few wide instructions.
  uint32_t vertex = 0, loop = 0, polygon = 0;
  const auto* loops = at<Loop>(p.loops);
  for (size_t l = 0; l < p.loop_count; ++l) vertex = std::max(vertex, loops[l].vertex);
  const auto* triangles = at<Triangle>(p.triangles);
  for (size_t t = 0; t < p.triangle_count; ++t) {
    for (const uint32_t l : triangles[t].loops) loop = std::max(loop, l);
    polygon = std::max(polygon, triangles[t].polygon);
  }
  if (vertex >= p.vertex_count || loop >= p.loop_count || polygon >= p.polygon_count) return false;
  for (const AttributePointer& a : p.attributes) {
    const size_t count = a.domain == "CORNER" ? p.loop_count
                         : a.domain == "POINT" ? p.vertex_count
                         : a.domain == "FACE"  ? p.polygon_count
                                               : 0;
    if (a.count != count || kind_of(a) == Kind::kUnknown) return false;
  }
  return p.slot_count >= 1;
}

}  // namespace

std::optional<scene::BuiltMesh> read_mesh(const MeshPointers& pointers) {
  if (!plausible(pointers)) return std::nullopt;
  scene::BuiltMesh built = scene::build_mesh(Source(pointers));
  built.mesh.warning.clear();  // the caller tells, from the count
  return built;
}

uintptr_t find_loop_normals(uintptr_t mesh, uintptr_t loops, size_t loop_count) {
  // Offsets within Mesh, CustomData and CustomDataLayer; types of layers.
  constexpr size_t kTotalLoops = 236, kLoopData = 984, kLayerCount = 220;
  constexpr size_t kLayerSize = 112, kLayerType = 0, kLayerData = 96;
  constexpr int32_t kNormal = 8, kLoop = 26, kTypes = 52;
  const auto number = [](uintptr_t address) { return *at<int32_t>(address); };

  // The count tells whether this is such a Mesh at all, before any pointer in it is followed.
  if (size_t(number(mesh + kTotalLoops)) != loop_count) return 0;
  const uintptr_t layers = *at<uintptr_t>(mesh + kLoopData);
  const int32_t count = number(mesh + kLoopData + kLayerCount);
  if (!layers || count < 0 || count > 1024) return 0;
  uintptr_t normals = 0;
  bool known = false;
  for (int32_t i = 0; i < count; ++i) {
    const uintptr_t layer = layers + size_t(i) * kLayerSize;
    const int32_t type = number(layer + kLayerType);
    if (type < 0 || type >= kTypes) return 0;
    const uintptr_t data = *at<uintptr_t>(layer + kLayerData);
    known |= type == kLoop && data == loops;
    if (type == kNormal) normals = data;
  }
  return known ? normals : 0;
}

}  // namespace panoptes::python
