#include "rasterize/shadow_maps.h"

#include <algorithm>
#include <cmath>

namespace panoptes::rasterize {

namespace {

// Wider cones become cubes: their texels would grow too large towards the rim.
constexpr double kWidestFlatSpot = 2.1;  // rad, 120 degrees

// llvmpipe cuts an invocation off after 65 535 loop iterations; each lamp takes up to five.
constexpr uint32_t kLightsPerBatch = 4096;

struct Frame {
  glm::dvec3 x, y, axis;
};

Frame frame_along(const glm::dvec3& axis) {
  const glm::dvec3 up = std::abs(axis.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(axis, up));
  return {x, glm::cross(x, axis), axis};
}

std::vector<glm::dvec3> corners(const scene::Bounds& b) {
  std::vector<glm::dvec3> result;
  for (int i = 0; i < 8; ++i)
    result.push_back({i & 1 ? b.high.x : b.low.x, i & 2 ? b.high.y : b.low.y,
                      i & 4 ? b.high.z : b.low.z});
  return result;
}

// An orthographic view along `direction` around everything that can cast or catch a shadow.
gpu_scene::LightView sun_view(const glm::dvec3& direction, const scene::Bounds& bounds,
                              const glm::dvec2& texel_shift, int resolution) {
  const Frame frame = frame_along(direction);
  const glm::dvec3 center = 0.5 * (glm::dvec3(bounds.low) + glm::dvec3(bounds.high));
  glm::dvec3 half(0.0);
  for (const glm::dvec3& corner : corners(bounds)) {
    const glm::dvec3 p = corner - center;
    half = glm::max(half, glm::abs(glm::dvec3(glm::dot(p, frame.x), glm::dot(p, frame.y),
                                              glm::dot(p, frame.axis))));
  }
  // A little more than the scene, relative to it, so that flat scenes have a depth too.
  const double margin = std::max({half.x, half.y, half.z, 1e-30}) * 1e-3;
  half += margin;
  // Two texels of border for the grid's shift and the filter.
  half.x *= 1.0 + 4.0 / resolution;
  half.y *= 1.0 + 4.0 / resolution;
  const glm::dvec2 shift = texel_shift * 2.0 * glm::dvec2(half.x, half.y) / double(resolution);
  return {center, frame.x, frame.y, frame.axis, half.x, half.y, -half.z, half.z, false, shift};
}

// Depth range from a lamp at `position` to the scene. Depth is reversed and in float, so that the
// near plane can be very near.
glm::dvec2 depth_range(const glm::dvec3& position, const scene::Bounds& bounds) {
  double farthest = 0;
  for (const glm::dvec3& corner : corners(bounds))
    farthest = std::max(farthest, glm::length(corner - position));
  farthest = std::max(farthest, 1e-30) * 1.001;
  return {farthest * 1e-5, farthest};
}

void add_cube(std::vector<gpu_scene::LightView>& faces, const glm::dvec3& position,
              const scene::Bounds& bounds, int resolution) {
  const glm::dvec3 axes[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const glm::dvec2 range = depth_range(position, bounds);
  const double half = 1.0 + 4.0 / resolution;  // a border for the filter
  for (const glm::dvec3& axis : axes) {
    const Frame f = frame_along(axis);
    faces.push_back({position, f.x, f.y, f.axis, half, half, range.x, range.y, true, {0, 0}});
  }
}

shared::Light describe(const scene::Light& lamp, const scene::LightSample& sample, bool centre,
                       const glm::dvec3& camera_origin) {
  shared::Light light{};
  const glm::dvec3 relative = glm::dvec3(sample.position) - camera_origin;
  const bool disk = lamp.type == scene::LightType::kPoint || lamp.type == scene::LightType::kSpot;
  light.position = glm::vec4(glm::vec3(relative), disk && centre ? lamp.radius : 0.0f);
  light.center = glm::vec4(glm::vec3(glm::dvec3(lamp.position()) - camera_origin), 0.0f);
  light.axis = glm::vec4(sample.direction, 0.0f);
  light.power = glm::vec4(lamp.power(), 0.0f);
  light.type = lamp.type == scene::LightType::kPoint  ? shared::LIGHT_POINT
               : lamp.type == scene::LightType::kSun  ? shared::LIGHT_SUN
               : lamp.type == scene::LightType::kSpot ? shared::LIGHT_SPOT
                                                      : shared::LIGHT_AREA;
  light.shadow = shared::NO_SHADOW;
  light.faces = 1;
  if (lamp.type == scene::LightType::kSpot) {
    const float outer = std::cos(0.5f * lamp.spot_size);
    const float width = (1.0f - outer) * lamp.spot_blend;
    light.cone = {outer, width > 0 ? 1.0f / width : 1e30f, 0, 0};
  }
  if (lamp.type == scene::LightType::kArea) {
    const float half = 0.5f * lamp.spread;
    const bool spread = lamp.spread < 3.14159f;
    light.cone = {spread ? std::tan(half) : -1.0f,
                  spread ? 1.0f / std::max(std::tan(half) - half, 1e-12f) : 1.0f, 0, 0};
  }
  return light;
}

shared::ShadowFace describe(const gpu_scene::LightView& face, const glm::dvec3& camera_origin,
                            int resolution) {
  const auto vec = [](const glm::dvec3& v, double w) {
    return glm::vec4(glm::vec3(v), float(w));
  };
  const double texel = 2.0 * std::max(face.half_x, face.half_y) / resolution;
  const double range = face.far_depth - face.near_depth;
  shared::ShadowFace f{};
  f.origin = vec(face.origin - camera_origin, texel);
  f.x = vec(face.x / face.half_x, face.shift.x / face.half_x);
  f.y = vec(face.y / face.half_y, face.shift.y / face.half_y);
  f.axis = vec(face.axis, face.perspective ? 1.0 : 0.0);
  f.half_extent = {float(face.half_x), float(face.half_y), 0, 0};
  f.depth = face.perspective
                ? glm::vec4(float(face.near_depth * face.far_depth / range),
                            float(-face.near_depth / range), float(face.near_depth), 0)
                : glm::vec4(float(-1.0 / range), float(face.far_depth / range),
                            float(face.near_depth), 0);
  return f;
}

}  // namespace

LightSet place_lights(const std::vector<scene::Light>& lamps, bool shadows,
                      const std::vector<LightSamplePoint>& points, const scene::Bounds& bounds,
                      const glm::dvec3& camera_origin, int resolution, int layers) {
  LightSet set;
  const glm::vec3 target = bounds.empty() ? glm::vec3(0) : 0.5f * (bounds.low + bounds.high);
  for (size_t i = 0; i < lamps.size(); ++i) {
    const scene::Light& lamp = lamps[i];
    const LightSamplePoint point = points.empty() ? LightSamplePoint{} : points[i];
    const scene::LightSample sample = points.empty()
                                          ? scene::light_center(lamp)
                                          : scene::sample_light(lamp, point.u, point.v, target);
    PlacedLight placed{describe(lamp, sample, points.empty(), camera_origin), lamp.type, {}};
    if (shadows && lamp.cast_shadow && !bounds.empty()) {
      const glm::dvec3 position(sample.position), direction(sample.direction);
      if (lamp.type == scene::LightType::kSun) {
        placed.faces.push_back(
            sun_view(direction, bounds, glm::dvec2(point.texel_shift), resolution));
      } else if (lamp.type == scene::LightType::kSpot && lamp.spot_size <= kWidestFlatSpot) {
        const Frame f = frame_along(direction);
        const glm::dvec2 range = depth_range(position, bounds);
        const double half = std::tan(0.5 * lamp.spot_size) * (1.0 + 4.0 / resolution) + 1e-6;
        placed.faces.push_back(
            {position, f.x, f.y, f.axis, half, half, range.x, range.y, true, {0, 0}});
      } else {
        add_cube(placed.faces, position, bounds, resolution);
      }
    }

    // A batch is closed when it has lamps enough or this lamp's faces would not fit.
    if (set.batches.empty() || set.batches.back().light_count == kLightsPerBatch ||
        set.batches.back().face_count + placed.faces.size() > size_t(layers))
      set.batches.push_back({uint32_t(i), 0, uint32_t(set.faces.size()), 0});
    LightBatch& batch = set.batches.back();
    ++batch.light_count;
    batch.face_count += uint32_t(placed.faces.size());
    if (!placed.faces.empty()) {
      placed.light.shadow = uint32_t(set.faces.size());
      placed.light.faces = uint32_t(placed.faces.size());
    }
    for (const gpu_scene::LightView& face : placed.faces) {
      set.faces.push_back(describe(face, camera_origin, resolution));
    }
    set.lights.push_back(std::move(placed));
  }
  return set;
}

}  // namespace panoptes::rasterize
