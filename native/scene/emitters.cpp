#include "scene/emitters.h"

#include <algorithm>
#include <cmath>

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

}  // namespace

EmitterShape::EmitterShape(const Mesh& mesh, const MaterialRange& range,
                           const glm::dmat3& linear)
    : first(range.first) {
  triangles.reserve(range.count);
  cumulative.reserve(range.count);
  double sum = 0;
  for (uint32_t t = range.first; t < range.first + range.count; ++t) {
    const glm::uvec3& v = mesh.triangles[t];
    triangles.push_back({mesh.positions[v.x], mesh.positions[v.y], mesh.positions[v.z]});
    const auto& [a, b, c] = triangles.back();
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
  point.triangle = shape_->first + uint32_t(t);
  const double root = std::sqrt(rest);
  point.barycentrics = {float(root * (1.0 - double(v))), float(root * double(v))};
  const auto& [a, b, c] = shape_->triangles[t];
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
    if (!mesh) continue;
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
  return found;
}

}  // namespace panoptes::scene
