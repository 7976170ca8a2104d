#include "scene/emitters.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace panoptes::scene {

namespace {

// The scale of a transform that keeps angles; 0 for any other.
double similarity_scale(const glm::dmat3& m) {
  constexpr double kSame = 1e-4;  // of the squared scale
  const double squared = glm::dot(m[0], m[0]);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j)
      if (!(std::abs(glm::dot(m[i], m[j]) - (i == j ? squared : 0.0)) <= kSame * squared)) return 0;
  return std::sqrt(squared);
}

// The bits of x, 10 of them, with two zeros between each.
uint32_t spread_bits(uint32_t x) {
  x = (x | x << 16) & 0x030000ffu;
  x = (x | x << 8) & 0x0300f00fu;
  x = (x | x << 4) & 0x030c30c3u;
  return (x | x << 2) & 0x09249249u;
}

// The place of `p` on a curve through `bounds` (Morton 1966), in 1024 steps an axis.
uint32_t morton_code(const glm::vec3& p, const Bounds& bounds) {
  uint32_t code = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float extent = bounds.high[axis] - bounds.low[axis];
    const float place = extent > 0 ? (p[axis] - bounds.low[axis]) / extent : 0.0f;
    code |= spread_bits(uint32_t(std::clamp(place, 0.0f, 1.0f) * 1023.0f)) << axis;
  }
  return code;
}

}  // namespace

EmitterShape::EmitterShape(const Mesh& mesh, const MaterialRange& range,
                           const glm::dmat3& linear) {
  Bounds bounds;
  triangles.reserve(range.count);
  for (uint32_t t = range.first; t < range.first + range.count; ++t) {
    const glm::uvec3& v = mesh.triangles[t];
    triangles.push_back({t, {mesh.positions[v.x], mesh.positions[v.y], mesh.positions[v.z]}});
    for (const glm::vec3& p : triangles.back().positions) bounds.add(p);
  }
  std::vector<std::pair<uint32_t, uint32_t>> order;  // code, place in `triangles`
  for (const Triangle& t : triangles) {
    const glm::vec3 center = (t.positions[0] + t.positions[1] + t.positions[2]) / 3.0f;
    order.emplace_back(morton_code(center, bounds), uint32_t(order.size()));
  }
  std::sort(order.begin(), order.end());
  std::vector<Triangle> sorted;
  sorted.reserve(triangles.size());
  for (const auto& [code, place] : order) sorted.push_back(triangles[place]);
  triangles = std::move(sorted);

  double sum = 0;
  cumulative.reserve(range.count);
  for (const Triangle& triangle : triangles) {
    const auto& [a, b, c] = triangle.positions;
    const double twice = glm::length(glm::cross(linear * (glm::dvec3(b) - glm::dvec3(a)),
                                                linear * (glm::dvec3(c) - glm::dvec3(a))));
    if (std::isfinite(twice)) sum += 0.5 * twice;
    cumulative.push_back(sum);
  }
}

EmitterPoint Emitter::sample(float u, float v) const {
  // The triangle whose share of the area u falls into; what is left of u is a number of its own.
  const std::vector<double>& sums = shape_->cumulative;
  const double target = double(u) * shape_->area();
  size_t t = size_t(std::upper_bound(sums.begin(), sums.end(), target) - sums.begin());
  t = std::min(t, sums.size() - 1);
  while (t > 0 && sums[t] == sums[t - 1]) --t;  // the last one may have no area
  const double low = t > 0 ? sums[t - 1] : 0.0;
  const double rest = std::clamp((target - low) / (sums[t] - low), 0.0, 1.0);

  EmitterPoint point;
  point.instance = instance_;
  point.triangle = shape_->triangles[t].index;
  const double root = std::sqrt(rest);
  point.barycentrics = {float(root * (1.0 - double(v))), float(root * double(v))};
  const auto& [a, b, c] = shape_->triangles[t].positions;
  const glm::dmat4 place(object_to_world_);
  const glm::dvec3 e1 = glm::dmat3(place) * (glm::dvec3(b) - glm::dvec3(a));
  const glm::dvec3 e2 = glm::dmat3(place) * (glm::dvec3(c) - glm::dvec3(a));
  point.position = glm::dvec3(place * glm::dvec4(a, 1.0)) +
                   double(point.barycentrics.x) * e1 + double(point.barycentrics.y) * e2;
  const double mirrored = glm::determinant(glm::dmat3(place)) < 0 ? -1.0 : 1.0;
  point.normal = glm::vec3(mirrored * glm::normalize(glm::cross(e1, e2)));
  return point;
}

std::vector<Emitter> find_emitters(const Scene& scene) {
  std::vector<Emitter> found;
  std::map<std::pair<Id, uint32_t>, std::shared_ptr<const EmitterShape>> shared;
  for (size_t i = 0; i < scene.instances().size(); ++i) {
    const Instance& instance = scene.instances()[i];
    const Mesh* mesh = scene.mesh_of(instance);
    if (!mesh || !(instance.visibility & shared::SEEN_BY_SCATTERED)) continue;
    const glm::dmat3 linear(instance.object_to_world);
    const double scale = similarity_scale(linear);
    for (const MaterialRange& range : mesh->ranges) {
      const Id id = scene.material_of(instance, range.slot);
      const auto material = scene.materials().find(id);
      if (material == scene.materials().end() || !material->second.facts.emission) continue;
      std::shared_ptr<const EmitterShape> shape;
      double area;
      if (scale > 0) {
        auto& common = shared[{instance.mesh, range.first}];
        if (!common) common = std::make_shared<EmitterShape>(*mesh, range, glm::dmat3(1.0));
        shape = common;
        area = shape->area() * scale * scale;
      } else {
        shape = std::make_shared<EmitterShape>(*mesh, range, linear);
        area = shape->area();
      }
      if (area > 0 && std::isfinite(area))
        found.emplace_back(shape, instance.object_to_world, area, uint32_t(i), id);
    }
  }
  // Blender's order of instances may differ from run to run; the sample sequence must not.
  std::stable_sort(found.begin(), found.end(), [](const Emitter& a, const Emitter& b) {
    const auto key = [](const Emitter& e) {
      const glm::dvec3 p = e.sample(0.5f, 0.5f).position;
      return std::make_tuple(p.x, p.y, p.z, e.area());
    };
    return key(a) < key(b);
  });
  return found;
}

}  // namespace panoptes::scene
