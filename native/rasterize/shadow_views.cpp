#include "rasterize/shadow_views.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace panoptes::rasterize {

namespace {

// Wider than this, the texels of one flat map differ too much in size between centre and rim; a
// cube then takes fewer of them for the same detail.
constexpr double kWidestFit = 0.9;  // rad, half angle

struct Frame {
  glm::dvec3 x, y, axis;
};

Frame frame_along(const glm::dvec3& axis) {
  const glm::dvec3 up = std::abs(axis.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(axis, up));
  return {x, glm::cross(x, axis), axis};
}

std::array<glm::dvec3, 8> corners(const scene::Bounds& b) {
  std::array<glm::dvec3, 8> result;
  for (int i = 0; i < 8; ++i)
    result[size_t(i)] = {i & 1 ? b.high.x : b.low.x, i & 2 ? b.high.y : b.low.y,
                         i & 4 ? b.high.z : b.low.z};
  return result;
}

// Two texels of border for the filter.
double border(int resolution) { return 1.0 + 4.0 / resolution; }

// Depth range of a view that may start anywhere between the lamp and the scene. Depth is reversed
// and in float, so that the near plane can be very near.
glm::dvec2 depth_range(const glm::dvec3& position, const scene::Bounds& bounds) {
  double farthest = 0;
  for (const glm::dvec3& corner : corners(bounds))
    farthest = std::max(farthest, glm::length(corner - position));
  farthest = std::max(farthest, 1e-30) * 1.001;
  return {farthest * 1e-5, farthest};
}

// Farther than so many times the scene's size, a lamp's rays differ in direction by less than a texel
// of shadow, while a perspective depth would lose the scene in a float's last bits.
constexpr double kParallel = 1000;

// The frustum that just holds `bounds`, where the lamp is so far outside that one will do.
std::optional<gpu_scene::LightView> fitted_view(const glm::dvec3& position,
                                                const scene::Bounds& bounds, int resolution) {
  const glm::dvec3 center = 0.5 * (glm::dvec3(bounds.low) + glm::dvec3(bounds.high));
  const double distance = glm::length(center - position);
  if (!(distance > 0)) return std::nullopt;
  const double size = glm::length(glm::dvec3(bounds.high) - glm::dvec3(bounds.low));
  const Frame f = frame_along((center - position) / distance);
  if (distance > kParallel * size) return sun_view(f.axis, bounds, bounds, {0, 0}, resolution);
  glm::dvec2 half(0);
  double nearest = std::numeric_limits<double>::max(), farthest = 0;
  for (const glm::dvec3& corner : corners(bounds)) {
    const glm::dvec3 p = corner - position;
    const double depth = glm::dot(p, f.axis);
    if (!(depth > std::cos(kWidestFit) * glm::length(p))) return std::nullopt;
    half = glm::max(half, glm::abs(glm::dvec2(glm::dot(p, f.x), glm::dot(p, f.y))) / depth);
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  // A margin relative to the scene, so that a flat one seen edge-on has a width and a depth too.
  const double margin = 1e-3 * size;
  half = (half + margin / distance) * border(resolution);
  nearest = std::max(nearest - margin, farthest * 1e-5);
  return gpu_scene::LightView{position, f.x,     f.y,      f.axis, half.x, half.y,
                              nearest,  farthest + margin, true,   {0, 0}};
}

// False only where no part of `bounds` lies in the pyramid of a cube's face.
bool may_hold(const gpu_scene::LightView& face, const scene::Bounds& bounds) {
  // Each plane of the pyramid, and the one through its tip: is the whole box outside?
  const glm::dvec3 planes[5] = {face.axis * face.half_x - face.x, face.axis * face.half_x + face.x,
                                face.axis * face.half_y - face.y, face.axis * face.half_y + face.y,
                                face.axis};
  return std::all_of(std::begin(planes), std::end(planes), [&](const glm::dvec3& plane) {
    const auto box = corners(bounds);
    return std::any_of(box.begin(), box.end(), [&](const glm::dvec3& corner) {
      return glm::dot(corner - face.origin, plane) > 0;
    });
  });
}

// Whether some direction of the face leaves into the half space of `axis`.
bool receives(const gpu_scene::LightView& face, const glm::dvec3& axis) {
  return glm::dot(face.axis, axis) + face.half_x * std::abs(glm::dot(face.x, axis)) +
             face.half_y * std::abs(glm::dot(face.y, axis)) > 0;
}

}  // namespace

gpu_scene::LightView sun_view(const glm::dvec3& direction, const scene::Bounds& region,
                              const scene::Bounds& casters, const glm::dvec2& texel_shift,
                              int resolution) {
  const Frame frame = frame_along(direction);
  const glm::dvec3 center = 0.5 * (glm::dvec3(region.low) + glm::dvec3(region.high));
  glm::dvec3 half(0.0);
  for (const glm::dvec3& corner : corners(region)) {
    const glm::dvec3 p = corner - center;
    half = glm::max(half, glm::abs(glm::dvec3(glm::dot(p, frame.x), glm::dot(p, frame.y),
                                              glm::dot(p, frame.axis))));
  }
  double first = -half.z;
  for (const glm::dvec3& corner : corners(casters))
    first = std::min(first, glm::dot(corner - center, frame.axis));
  // A little more than the region, relative to it, so that flat scenes have a depth too.
  const double margin = std::max({half.x, half.y, half.z, -first, 1e-30}) * 1e-3;
  half += margin;
  half.x *= border(resolution);
  half.y *= border(resolution);
  const glm::dvec2 shift = texel_shift * 2.0 * glm::dvec2(half.x, half.y) / double(resolution);
  return {center, frame.x, frame.y, frame.axis, half.x, half.y, first - margin, half.z, false,
          shift};
}

gpu_scene::LightView cone_view(const glm::dvec3& position, const glm::dvec3& axis,
                               double half_angle, const scene::Bounds& bounds, int resolution) {
  const Frame f = frame_along(axis);
  const glm::dvec2 range = depth_range(position, bounds);
  const double half = std::tan(half_angle) * border(resolution) + 1e-6;
  return {position, f.x, f.y, f.axis, half, half, range.x, range.y, true, {0, 0}};
}

ShadowViews surrounding_views(const glm::dvec3& position, const std::optional<glm::dvec3>& axis,
                              const scene::Bounds& bounds, int resolution) {
  if (const auto fitted = fitted_view(position, bounds, resolution)) return {fitted};
  const glm::dvec3 axes[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const glm::dvec2 range = depth_range(position, bounds);
  const double half = border(resolution);
  ShadowViews views;
  for (const glm::dvec3& direction : axes) {
    const Frame f = frame_along(direction);
    const gpu_scene::LightView view{position, f.x,     f.y,     f.axis, half,
                                    half,     range.x, range.y, true,   {0, 0}};
    const bool wanted = may_hold(view, bounds) && (!axis || receives(view, *axis));
    views.push_back(wanted ? std::optional(view) : std::nullopt);
  }
  return views;
}

}  // namespace panoptes::rasterize
