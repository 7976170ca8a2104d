#include "scene/light.h"

#include <algorithm>
#include <cmath>

namespace panoptes::scene {

namespace {

constexpr float kPi = 3.14159265358979f;

glm::vec3 unit(const glm::vec3& v, const glm::vec3& otherwise) {
  const float length = glm::length(v);
  return length > 0 && std::isfinite(length) ? v / length : otherwise;
}

// Two unit vectors square to the unit `n` and to each other (Duff et al. 2017).
void frame(const glm::vec3& n, glm::vec3& x, glm::vec3& y) {
  const float sign = std::copysign(1.0f, n.z);
  const float a = -1.0f / (sign + n.z), b = n.x * n.y * a;
  x = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
  y = {b, sign + n.y * n.y * a, -n.y};
}

// Concentric map of the square to the unit disk (Shirley and Chiu 1997): keeps strata together.
glm::vec2 disk(float u, float v) {
  const float a = 2 * u - 1, b = 2 * v - 1;
  if (a == 0 && b == 0) return {0, 0};
  const bool wide = std::abs(a) > std::abs(b);
  const float r = wide ? a : b;
  const float phi = wide ? kPi / 4 * (b / a) : kPi / 2 - kPi / 4 * (a / b);
  return {r * std::cos(phi), r * std::sin(phi)};
}

bool round(AreaShape shape) { return shape == AreaShape::kDisk || shape == AreaShape::kEllipse; }

}  // namespace

glm::vec3 Light::direction() const {
  return unit(-glm::vec3(object_to_world[2]), {0, 0, -1});
}

glm::vec3 Light::power() const {
  const glm::vec3 watts = color * energy;
  switch (type) {
    case LightType::kSun: return watts;
    case LightType::kArea: return watts * 0.25f;  // radiance P / (4 A)
    default: return watts / (4 * kPi);
  }
}

bool Light::extended() const {
  switch (type) {
    case LightType::kSun: return angle > 0;
    case LightType::kArea: return size_x > 0 || size_y > 0;
    default: return radius > 0;
  }
}

void make_finite(Light& light) {
  const auto within = [](float& value, float low, float high) {
    value = std::isfinite(value) ? std::clamp(value, low, high) : low;
  };
  constexpr float kLargest = 1e15f;  // its square is still a float
  within(light.radius, 0, kLargest);
  within(light.angle, 0, kPi);
  within(light.spot_size, 0, kPi);
  within(light.spot_blend, 0, 1);
  within(light.size_x, 0, kLargest);
  within(light.size_y, 0, kLargest);
  if (!std::isfinite(light.spread)) light.spread = kPi;
  within(light.spread, 0, kPi);
}

LightSample light_center(const Light& light) { return {light.position(), light.direction()}; }

LightSample sample_light(const Light& light, float u, float v, const glm::vec3& target) {
  LightSample sample = light_center(light);
  glm::vec3 x, y;
  const glm::vec2 d = disk(u, v);
  if (light.type == LightType::kSun) {
    frame(sample.direction, x, y);
    const float r = std::tan(0.5f * std::min(light.angle, 3.0f));
    sample.direction = glm::normalize(sample.direction + r * (d.x * x + d.y * y));
  } else if (light.type == LightType::kArea) {
    const bool same = light.shape == AreaShape::kSquare || light.shape == AreaShape::kDisk;
    const glm::vec2 size{light.size_x, same ? light.size_x : light.size_y};
    const glm::vec2 p = round(light.shape) ? 0.5f * d : glm::vec2(u - 0.5f, v - 0.5f);
    sample.position += p.x * size.x * glm::vec3(light.object_to_world[0]) +
                       p.y * size.y * glm::vec3(light.object_to_world[1]);
  } else if (light.radius > 0) {
    const bool spot = light.type == LightType::kSpot;
    frame(spot ? sample.direction : unit(target - sample.position, {0, 0, -1}), x, y);
    sample.position += light.radius * (d.x * x + d.y * y);
  }
  return sample;
}

}  // namespace panoptes::scene
