#include "rays/ray_sets.h"

#include <bit>
#include <cmath>
#include <functional>

namespace panoptes::test {

namespace {

constexpr float kTurn = 6.2831853f;

struct SurfacePoint {
  glm::vec3 position;  // off the surface, on the side that the ray came from
  glm::vec3 normal;    // unit, on that side
  glm::vec3 incoming;  // direction of the ray that met it, unit
};

std::vector<SurfacePoint> visible_points(const RayScene& scene, const EmbreeScene& reference,
                                         uint32_t count) {
  const RaySet primary = primary_rays(scene, count);
  const std::vector<TracedHit> hits = reference.trace(primary.rays);
  std::vector<SurfacePoint> points;
  for (size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].primitive == shared::NO_PRIMITIVE) continue;
    const TracedTriangle& t = scene.triangles[hits[i].primitive];
    const glm::vec3 a = corner(t, 0), ab = corner(t, 1) - a, ac = corner(t, 2) - a;
    const glm::vec3 incoming = glm::normalize(direction_of(primary.rays[i]));
    glm::vec3 normal = glm::normalize(glm::cross(ab, ac));
    if (glm::dot(normal, incoming) > 0) normal = -normal;
    if (!std::isfinite(normal.x)) continue;  // a sliver too thin for a normal
    const glm::vec3 position = a + hits[i].u * ab + hits[i].v * ac;
    points.push_back({offset_origin(position, normal), normal, incoming});
  }
  return points;
}

// A frame whose third axis is `axis`.
glm::mat3 frame_around(const glm::vec3& axis) {
  const glm::vec3 other = std::abs(axis.x) > 0.5f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  const glm::vec3 tangent = glm::normalize(glm::cross(axis, other));
  return {tangent, glm::cross(axis, tangent), axis};
}

// A direction around `axis` with density proportional to cosine^exponent.
glm::vec3 lobe(Random& random, const glm::vec3& axis, float exponent) {
  const float angle = kTurn * random.uniform();
  const float z = std::pow(1.0f - random.uniform(), 1.0f / (exponent + 1.0f));
  const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
  return frame_around(axis) * glm::vec3(r * std::cos(angle), r * std::sin(angle), z);
}

// `count` rays made from the points, each used about equally often, neighbours in order.
RaySet from_points(const std::string& name, const std::vector<SurfacePoint>& points, uint32_t count,
                   uint64_t seed,
                   const std::function<TracedRay(Random&, const SurfacePoint&)>& make) {
  RaySet set{name};
  Random random(seed);
  if (points.empty()) return set;
  set.rays.reserve(count);
  for (uint64_t i = 0; i < count; ++i)
    set.rays.push_back(make(random, points[size_t(i * points.size() / count)]));
  return set;
}

}  // namespace

TracedRay make_ray(const glm::vec3& origin, const glm::vec3& direction, float t_min, float t_max) {
  return {origin.x,
          origin.y,
          origin.z,
          t_min,
          direction.x,
          direction.y,
          direction.z,
          t_max,
          shared::NO_PRIMITIVE,
          shared::SEEN_BY_ALL,
          0,
          0};
}

glm::vec3 offset_origin(const glm::vec3& position, const glm::vec3& normal) {
  // Far from zero by 256 units in the last place; near it, where those vanish, by a fixed length.
  constexpr float kNearZero = 1.0f / 32, kFixed = 1.0f / 65536;
  glm::vec3 moved;
  for (int k = 0; k < 3; ++k) {
    const float p = position[k];
    const int32_t steps = int32_t(256.0f * normal[k]);
    const float far = std::bit_cast<float>(std::bit_cast<int32_t>(p) + (p < 0 ? -steps : steps));
    moved[k] = std::abs(p) < kNearZero ? p + kFixed * normal[k] : far;
  }
  return moved;
}

RaySet primary_rays(const RayScene& scene, uint32_t count) {
  RaySet set{"primary"};
  const glm::dmat4 scene_from_image = glm::inverse(scene.projection * scene.camera_from_scene);
  const auto unproject = [&](double x, double y, double depth) {
    const glm::dvec4 p = scene_from_image * glm::dvec4(x, y, depth, 1);
    return glm::dvec3(p) / p.w;
  };
  const glm::dvec3 eye(glm::inverse(scene.camera_from_scene)[3]);
  constexpr uint32_t kBlock = 8;
  const uint32_t blocks = uint32_t(std::ceil(std::sqrt(double(count)) / kBlock));
  const double side = blocks * kBlock;
  set.rays.reserve(count);
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t block = i / (kBlock * kBlock), pixel = i % (kBlock * kBlock);
    const uint32_t column = block % blocks * kBlock + pixel % kBlock;
    const uint32_t row = block / blocks * kBlock + pixel / kBlock;
    const double x = 2 * (column + 0.5) / side - 1, y = 2 * (row + 0.5) / side - 1;
    const glm::dvec3 near = unproject(x, y, -1), far = unproject(x, y, 1);
    const bool perspective = scene.projection[3][3] == 0;
    set.rays.push_back(
        make_ray(glm::vec3(perspective ? eye : near), glm::vec3(glm::normalize(far - near))));
  }
  return set;
}

std::vector<RaySet> secondary_rays(const RayScene& scene, const EmbreeScene& reference,
                                   uint32_t count) {
  const std::vector<SurfacePoint> points = visible_points(scene, reference, count);
  const glm::vec3 extent = scene.bounds.high - scene.bounds.low;
  const glm::vec3 middle = 0.5f * (scene.bounds.low + scene.bounds.high);
  const auto mirrored = [](const SurfacePoint& p) { return glm::reflect(p.incoming, p.normal); };
  std::vector<RaySet> sets;
  sets.push_back(from_points("specular", points, count, 1, [&](Random&, const SurfacePoint& p) {
    return make_ray(p.position, mirrored(p));
  }));
  sets.push_back(
      from_points("glossy", points, count, 2, [&](Random& random, const SurfacePoint& p) {
        glm::vec3 direction = lobe(random, mirrored(p), 100.0f);
        if (glm::dot(direction, p.normal) < 0) direction = glm::reflect(direction, p.normal);
        return make_ray(p.position, direction);
      }));
  sets.push_back(
      from_points("diffuse", points, count, 3, [&](Random& random, const SurfacePoint& p) {
        return make_ray(p.position, lobe(random, p.normal, 1.0f));
      }));
  // A lamp below the scene's top, a fifth of the scene wide. The end stays before the lamp's plane.
  const glm::vec3 lamp = middle + glm::vec3(0, 0, 0.45f * extent.z);
  sets.push_back(
      from_points("shadow", points, count, 4, [&](Random& random, const SurfacePoint& p) {
        const glm::vec3 across(random.between(-0.1f, 0.1f), random.between(-0.1f, 0.1f), 0);
        return make_ray(p.position, lamp + across * extent - p.position, 0, 0.999f);
      }));
  sets.back().any_hit = true;
  const glm::vec3 outside = middle + extent * glm::vec3(0.7f, -0.9f, 1.7f);
  sets.push_back(from_points("visibility", points, count, 5, [&](Random&, const SurfacePoint& p) {
    return make_ray(p.position, outside - p.position, 0, 1);
  }));
  sets.back().any_hit = true;
  return sets;
}

std::vector<RaySet> all_rays(const RayScene& scene, const EmbreeScene& reference, uint32_t count) {
  std::vector<RaySet> sets{primary_rays(scene, count)};
  for (RaySet& set : secondary_rays(scene, reference, count)) sets.push_back(std::move(set));
  for (RaySet& set : aimed_rays(scene, count)) sets.push_back(std::move(set));
  return sets;
}

}  // namespace panoptes::test
