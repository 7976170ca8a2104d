#include "path_tracer/light_records.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace panoptes::path_tracer {

namespace {

constexpr float kPi = 3.14159265358979f;

// Smaller areas (m2) and brighter lights than these would leave the range of floats in what follows.
constexpr double kLeastArea = 1e-30;
constexpr float kBrightest = 1e30f;

// Farther away, squares of distances are no floats.
constexpr double kFarthest = 1e15;

float bits(uint32_t word) { return std::bit_cast<float>(word); }

bool within(const glm::dvec3& p, double most) {
  return std::abs(p.x) <= most && std::abs(p.y) <= most && std::abs(p.z) <= most;
}

// How much a light weighs: of negative ones as of positive.
float brightness(const glm::vec3& c) {
  return 0.2126f * std::abs(c.x) + 0.7152f * std::abs(c.y) + 0.0722f * std::abs(c.z);
}

// False for what is not a number, too.
bool shines(const glm::vec3& c) {
  const float b = brightness(c);
  return b > 0 && b <= kBrightest;
}

struct Areas {
  glm::dvec3 x, y;  // whole sides or diameters, world space, metres
  bool round;
  double area;      // m2
  bool square;      // the sides are square to each other
};

Areas areas_of(const scene::Light& lamp) {
  using scene::AreaShape;
  const bool same = lamp.shape == AreaShape::kSquare || lamp.shape == AreaShape::kDisk;
  Areas a;
  a.round = lamp.shape == AreaShape::kDisk || lamp.shape == AreaShape::kEllipse;
  a.x = glm::dvec3(lamp.object_to_world[0]) * double(lamp.size_x);
  a.y = glm::dvec3(lamp.object_to_world[1]) * double(same ? lamp.size_x : lamp.size_y);
  a.square = !a.round && std::abs(glm::dot(a.x, a.y)) <= 1e-5 * glm::length(a.x) * glm::length(a.y);
  a.area = glm::length(glm::cross(a.x, a.y)) * (a.round ? kPi / 4 : 1.0);
  return a;
}

void describe_sun(const scene::Light& lamp, DescribedLight& d) {
  const float half = 0.5f * std::min(lamp.angle, 3.0f);
  d.record.axis.w = std::tan(half);
  d.seen = d.record.axis.w > 0;
  d.bounds.infinite = true;
  d.bounds.box = {lamp.direction(), lamp.direction()};
  d.bounds.cosine_o = std::cos(half);
}

void describe_disk(const scene::Light& lamp, const glm::dvec3& center, DescribedLight& d) {
  const bool spot = lamp.type == scene::LightType::kSpot;
  d.seen = double(lamp.radius) * lamp.radius > kLeastArea;
  d.record.axis.w = d.seen ? lamp.radius : 0.0f;
  d.bounds.box = {glm::vec3(center - double(lamp.radius)), glm::vec3(center + double(lamp.radius))};
  d.bounds.cosine_o = spot ? 1.0f : -1.0f;
  if (!spot) return;
  const float outer = std::cos(0.5f * lamp.spot_size), width = (1.0f - outer) * lamp.spot_blend;
  d.record.front.w = outer;
  d.record.back.w = width > 0 ? 1.0f / width : 1e30f;
  d.bounds.cosine_e = outer;
}

void describe_area(const scene::Light& lamp, const glm::dvec3& center, DescribedLight& d) {
  const Areas a = areas_of(lamp);
  d.record.edge_x = glm::vec4(glm::vec3(a.x), 0);
  d.record.edge_y = glm::vec4(glm::vec3(a.y), 0);
  for (int x : {-1, 1})
    for (int y : {-1, 1})
      d.bounds.box.add(glm::vec3(center + 0.5 * x * a.x + 0.5 * y * a.y));
  const float half = 0.5f * lamp.spread;
  const bool spread = lamp.spread < 3.14159f;
  d.record.front.w = spread ? std::tan(half) : -1.0f;
  d.record.back.w = spread ? 1.0f / std::max(std::tan(half) - half, 1e-12f) : 1.0f;
  if (spread) {
    d.bounds.cosine_e = std::cos(half);
    d.bounds.intensity *= std::max(d.record.front.w, 0.0f) * d.record.back.w;
  }
  const glm::vec3 radiance = lamp.power() / float(a.area);
  d.seen = a.area > kLeastArea && shines(radiance);
  if (!d.seen) return;
  d.record.front = glm::vec4(radiance, d.record.front.w);
  // Out of the plane on the side that the lamp's axis is on, wherever a sheared matrix sends that.
  const glm::vec3 normal = glm::vec3(glm::normalize(glm::cross(a.x, a.y)));
  d.bounds.axis = glm::dot(normal, lamp.direction()) < 0 ? -normal : normal;
  d.record.axis = glm::vec4(d.bounds.axis, float(a.area));
}

}  // namespace

uint32_t DescribedLight::flags() const { return std::bit_cast<uint32_t>(record.place.w); }

std::optional<DescribedLight> describe(const scene::Light& lamp, const glm::dvec3& origin) {
  using scene::LightType;
  const glm::dvec3 center = glm::dvec3(lamp.position()) - origin;
  const glm::vec3 power = lamp.power();
  if (!shines(power)) return {};
  if (lamp.type != LightType::kSun && !within(center, kFarthest)) return {};
  DescribedLight d;
  d.record = {};
  d.record.axis = glm::vec4(lamp.direction(), 0);
  d.record.front = glm::vec4(power, 0);
  d.bounds.axis = lamp.direction();
  d.bounds.intensity = brightness(power);
  uint32_t flags = lamp.cast_shadow ? 0 : shared::RECORD_SHADOWLESS;
  switch (lamp.type) {
    case LightType::kSun:
      flags |= shared::KIND_SUN;
      describe_sun(lamp, d);
      break;
    case LightType::kArea:
      flags |= areas_of(lamp).round ? shared::KIND_ELLIPSE : shared::KIND_RECTANGLE;
      describe_area(lamp, center, d);
      break;
    default:
      flags |= lamp.type == LightType::kSpot ? shared::KIND_SPOT : shared::KIND_POINT;
      describe_disk(lamp, center, d);
  }
  if (!d.seen) flags |= shared::RECORD_SINGULAR;
  else if (lamp.type == LightType::kArea && areas_of(lamp).square) flags |= shared::RECORD_SQUARE;
  if (!shines(glm::vec3(d.bounds.intensity)) || !within(glm::dvec3(d.bounds.box.low), kFarthest) ||
      !within(glm::dvec3(d.bounds.box.high), kFarthest))
    return {};
  d.record.place = glm::vec4(glm::vec3(center), bits(flags));
  return d;
}

std::optional<DescribedLight> describe(const GlowingTriangle& triangle) {
  const auto& [a, b, c] = triangle.corners;
  if (!within(a, kFarthest) || !within(b, kFarthest) || !within(c, kFarthest)) return {};
  const glm::dvec3 across = glm::cross(b - a, c - a) * (triangle.mirrored ? -1.0 : 1.0);
  const double area = 0.5 * glm::length(across);
  const glm::vec3 brighter = brightness(triangle.front) >= brightness(triangle.back)
                                 ? triangle.front : triangle.back;
  if (!(area > kLeastArea) || !shines(brighter)) return {};
  DescribedLight d;
  LightBounds& bounds = d.bounds;
  bounds.axis = glm::vec3(glm::normalize(across));
  bounds.intensity = float(brightness(brighter) * area);
  if (!shines(glm::vec3(bounds.intensity))) return {};
  for (const glm::dvec3& corner : triangle.corners) bounds.box.add(glm::vec3(corner));
  const bool front = triangle.varies || brightness(triangle.front) > 0;
  const bool back = triangle.varies || brightness(triangle.back) > 0;
  bounds.two_sided = front && back;
  const uint32_t flags = shared::KIND_TRIANGLE | (triangle.varies ? shared::RECORD_VARIES : 0) |
                         triangle.seen_by << shared::RECORD_SEEN_BY_SHIFT;
  d.record.place = glm::vec4(glm::vec3(a), bits(flags));
  d.record.edge_x = glm::vec4(glm::vec3(b - a), 0);
  d.record.edge_y = glm::vec4(glm::vec3(c - a), bits(triangle.primitive));
  d.record.axis = glm::vec4(bounds.axis, float(area));
  d.record.front = glm::vec4(triangle.front, 0);
  d.record.back = glm::vec4(triangle.back, 0);
  if (!front) bounds.axis = -bounds.axis;
  return d;
}

}  // namespace panoptes::path_tracer
