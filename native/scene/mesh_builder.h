// Makes a Mesh out of arrays that lie in memory however their owner likes: the one place where
// triangles are ordered by slot, corners gathered and broken vertices left out.
//
// A source says where things are. It is a template parameter, so that a gather compiles to a load:
//
//   std::string name, default_uv, default_color;
//   Bounds texture_space;         empty: the bounds
//   size_t vertices(), triangles();
//   glm::vec3 position(v);        object space; may be NaN
//   glm::uvec3 corners(t);        the vertices of a triangle, all below vertices()
//   int slot(t);                  material slot; negative counts as 0
//   glm::uvec3 normals(t);        three packed units, one a corner
//   void attributes(add);         calls add(attribute's name, channels, write) for each attribute,
//                                 where write(t, k, out) stores the channels of corner k
#pragma once

#include "scene/scene.h"

#include "base/error.h"

#include <cmath>
#include <future>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace panoptes::scene {

inline bool finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Makes `list` as long as `count`. Large lists ask for large pages before they are touched: taking
// memory in small pages costs more than filling it.
template <class T>
void resize_large(std::vector<T>& list, size_t count) {
#ifdef __linux__
  constexpr uintptr_t kLargePage = uintptr_t(2) << 20;
  list.reserve(count);
  const uintptr_t begin = reinterpret_cast<uintptr_t>(list.data()), end = begin + count * sizeof(T);
  const uintptr_t first = (begin + kLargePage - 1) / kLargePage * kLargePage,
                  last = end / kLargePage * kLargePage;
  // A wish: without it everything works all the same.
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
#endif
  list.resize(count);
}

// Triangles up to which a thread costs more than it saves.
constexpr uint32_t kSmall = 20'000;

// Ranges of equal slots, and in which order triangles go there.
struct SlotOrder {
  std::vector<MaterialRange> ranges;
  std::vector<uint32_t> order;  // empty when the order stays as it is
  uint32_t count = 0;           // triangles that are kept
  size_t dropped = 0;
  uint32_t operator[](uint32_t i) const { return order.empty() ? i : order[i]; }
};

// `keep(t)` says which triangles stay. A counting sort keeps the order within a slot.
template <class Slot, class Keep>
SlotOrder order_by_slot(size_t triangles, const Slot& slot_of, const Keep& keep) {
  std::map<int, uint32_t> slots;
  // Neighbours mostly share a slot, so the map is asked once a run.
  const auto each_kept = [&](const auto& visit) {
    int slot = -1;
    uint32_t* entry = nullptr;
    for (size_t t = 0; t < triangles; ++t) {
      if (!keep(t)) continue;
      if (const int s = std::max(slot_of(t), 0); s != slot) entry = &slots[slot = s];
      visit(t, *entry);
    }
  };
  SlotOrder result;
  each_kept([&](size_t, uint32_t& count) {
    ++count;
    ++result.count;
  });
  result.dropped = triangles - result.count;
  uint32_t first = 0;
  for (auto& [slot, count] : slots) {
    result.ranges.push_back({slot, first, count});
    first += std::exchange(count, first);  // from here on: where the next one goes
  }
  if (slots.size() == 1 && result.dropped == 0) return result;
  result.order.resize(result.count);
  each_kept([&](size_t t, uint32_t& next) { result.order[next++] = uint32_t(t); });
  return result;
}

// `write(t, k, out)` stores the channels of a corner. Values that are not finite become 0.
template <class Write>
Attribute gather_attribute(const std::string& name, int channels, const SlotOrder& order,
                           const Write& write) {
  Attribute attribute{name, channels, {}};
  resize_large(attribute.values, size_t(order.count) * 3 * size_t(channels));
  float* out = attribute.values.data();
  for (uint32_t i = 0; i < order.count; ++i)
    for (int k = 0; k < 3; ++k, out += channels) {
      write(order[i], k, out);
      for (int c = 0; c < channels; ++c)
        if (!std::isfinite(out[c])) out[c] = 0.0f;
    }
  return attribute;
}

struct BuiltMesh {
  Mesh mesh;
  size_t broken_vertices = 0;  // not finite; their triangles are left out
};

template <class Source>
BuiltMesh build_mesh(const Source& in) {
  BuiltMesh result;
  Mesh& mesh = result.mesh;
  mesh.name = in.name;
  mesh.default_uv = in.default_uv;
  mesh.default_color = in.default_color;

  // Broken vertices take their triangles with them; the positions left must be finite for bounds.
  std::vector<uint8_t> broken;
  resize_large(mesh.positions, in.vertices());
  for (size_t v = 0; v < mesh.positions.size(); ++v) {
    mesh.positions[v] = in.position(v);
    if (finite(mesh.positions[v])) continue;
    broken.resize(mesh.positions.size(), 0);
    broken[v] = 1;
    ++result.broken_vertices;
    mesh.positions[v] = glm::vec3(0);
  }
  SlotOrder order = order_by_slot(
      in.triangles(), [&](size_t t) { return in.slot(t); },
      [&](size_t t) {
        if (broken.empty()) return true;
        const glm::uvec3 v = in.corners(t);
        return !broken[v.x] && !broken[v.y] && !broken[v.z];
      });
  mesh.ranges = std::move(order.ranges);
  if (order.dropped)
    mesh.warning = fmt::format(
        "Mesh '{}' has vertices that are not finite; {} of its triangles are left out: check its "
        "modifiers and shape keys.",
        mesh.name, order.dropped);

  // Each attribute is a gather of its own, and most of its time goes into fresh memory: on large
  // meshes they run beside the rest.
  const auto policy = order.count < kSmall ? std::launch::deferred : std::launch::async;
  std::vector<std::future<Attribute>> attributes;
  in.attributes([&](const std::string& name, int channels, const auto& write) {
    attributes.push_back(std::async(policy, [&order, name, channels, write] {
      return gather_attribute(name, channels, order, write);
    }));
  });

  resize_large(mesh.triangles, order.count);
  resize_large(mesh.corner_normals, order.count);
  for (uint32_t i = 0; i < order.count; ++i) {
    const size_t t = order[i];
    const glm::uvec3 v = in.corners(t);
    mesh.triangles[i] = v;
    mesh.corner_normals[i] = in.normals(t);
    for (int k = 0; k < 3; ++k) mesh.bounds.add(mesh.positions[v[k]]);
  }
  mesh.texture_space = in.texture_space.empty() ? mesh.bounds : in.texture_space;
  for (std::future<Attribute>& attribute : attributes)
    mesh.attributes.push_back(attribute.get());
  return result;
}

}  // namespace panoptes::scene
