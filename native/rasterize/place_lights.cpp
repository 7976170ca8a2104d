#include "rasterize/shadow_face.h"
#include "rasterize/shadow_maps.h"

#include <algorithm>
#include <cmath>

namespace panoptes::rasterize {

namespace {

// Wider cones become cubes: their texels would grow too large towards the rim.
constexpr double kWidestFlatSpot = 2.1;  // rad, 120 degrees

// A point of a glowing surface is one of very many, whose shadows blur each other's edges: its maps
// need a quarter of the texels along a side.
constexpr int kMeshShare = 4;

// llvmpipe cuts an invocation off after 65 535 loop iterations; each lamp takes up to five.
constexpr uint32_t kLightsPerBatch = 4096;

// The radius of a lamp that its penumbrae follow, metres; of suns the tangent of half their angle.
float penumbra_size(const scene::Light& lamp) {
  switch (lamp.type) {
    case scene::LightType::kSun: return std::tan(0.5f * std::min(lamp.angle, 3.0f));
    case scene::LightType::kArea: {
      // Of the disk with the same area.
      const bool same = lamp.shape == scene::AreaShape::kSquare || lamp.shape == scene::AreaShape::kDisk;
      const bool round = lamp.shape == scene::AreaShape::kDisk || lamp.shape == scene::AreaShape::kEllipse;
      const float x = lamp.size_x * glm::length(glm::vec3(lamp.object_to_world[0]));
      const float y = (same ? lamp.size_x : lamp.size_y) *
                      glm::length(glm::vec3(lamp.object_to_world[1]));
      return std::sqrt(x * y * (round ? 0.25f : 0.318310f));
    }
    default: return lamp.radius;
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
  light.cone.z = penumbra_size(lamp);
  return light;
}

shared::Light describe(const MeshLight& light, const glm::dvec3& camera_origin) {
  shared::Light l{};
  l.position = glm::vec4(glm::vec3(light.position - camera_origin), light.reach);
  l.axis = glm::vec4(light.normal, 0.0f);
  l.power = glm::vec4(light.front, 0.0f);
  l.center = glm::vec4(light.back, 0.0f);
  l.type = shared::LIGHT_MESH;
  l.shadow = shared::NO_SHADOW;
  l.faces = 1;
  // One of several points: each fills its part of the emitter.
  l.cone.z = light.reach;
  return l;
}

// The views of a lamp's shadow map while it stands at `sample`.
ShadowViews shadow_views(const scene::Light& lamp, const scene::LightSample& sample,
                         const glm::vec2& texel_shift, const Placement& placement) {
  const glm::dvec3 position(sample.position), direction(sample.direction);
  const int resolution = placement.resolution;
  switch (lamp.type) {
    case scene::LightType::kSun: {
      std::vector<scene::Bounds> regions = placement.sun_cascades;
      if (regions.empty()) regions.push_back(placement.bounds);
      ShadowViews views;
      for (const scene::Bounds& region : regions)
        views.push_back(sun_view(direction, region, placement.bounds, glm::dvec2(texel_shift),
                                 resolution));
      return views;
    }
    case scene::LightType::kSpot:
      if (lamp.spot_size <= kWidestFlatSpot)
        return {cone_view(position, direction, 0.5 * lamp.spot_size, placement.bounds, resolution)};
      return surrounding_views(position, std::nullopt, placement.bounds, resolution);
    case scene::LightType::kArea:
      return surrounding_views(position, direction, placement.bounds, resolution);
    default: return surrounding_views(position, std::nullopt, placement.bounds, resolution);
  }
}

// Half of space in which a glowing surface gives light, where it is not all of it.
std::optional<glm::dvec3> side_of(const MeshLight& light) {
  const bool front = light.front != glm::vec3(0), back = light.back != glm::vec3(0);
  if (front && back) return std::nullopt;
  return back ? -glm::dvec3(light.normal) : glm::dvec3(light.normal);
}

// Appends a lamp and the faces of its maps; a lamp whose faces would not fit opens a batch.
void append(LightSet& set, PlacedLight placed, const Placement& placement) {
  const auto drawn = uint32_t(std::count_if(placed.views.begin(), placed.views.end(),
                                            [](const auto& view) { return view.has_value(); }));
  if (set.batches.empty() || set.batches.back().light_count == kLightsPerBatch ||
      set.batches.back().layers + drawn > uint32_t(placement.layers))
    set.batches.push_back({uint32_t(set.lights.size()), 0, 0});
  LightBatch& batch = set.batches.back();
  ++batch.light_count;
  if (!placed.views.empty()) {
    placed.light.shadow = uint32_t(set.faces.size());
    placed.light.faces = uint32_t(placed.views.size());
    // Seen as parallel light from far away, the lamp's radius counts as an angle.
    const auto& view = placed.views.front();
    if (view && !view->perspective && placed.kind != ShadowKind::kSun)
      placed.light.cone.z /=
          float(glm::length(view->origin - placement.camera_origin -
                            glm::dvec3(placed.light.position)));
  }
  for (const auto& view : placed.views) {
    shared::ShadowFace face{};
    if (view)
      face = shadow_face(*view, placement.camera_origin, glm::ivec2(placed.resolution));
    face.half_extent.z = view ? float(batch.layers++) : -1.0f;
    set.faces.push_back(face);
  }
  set.lights.push_back(std::move(placed));
}

}  // namespace

LightSet place_lights(const std::vector<scene::Light>& lamps,
                      const std::vector<LightSamplePoint>& points,
                      const std::vector<MeshLight>& mesh_lights, const Placement& placement) {
  LightSet set;
  const scene::Bounds& bounds = placement.bounds;
  const bool shadows = placement.shadows && !bounds.empty();
  const glm::vec3 target = bounds.empty() ? glm::vec3(0) : 0.5f * (bounds.low + bounds.high);
  for (size_t i = 0; i < lamps.size(); ++i) {
    const scene::Light& lamp = lamps[i];
    const LightSamplePoint point = points.empty() ? LightSamplePoint{} : points[i];
    const scene::LightSample sample = points.empty()
                                          ? scene::light_center(lamp)
                                          : scene::sample_light(lamp, point.u, point.v, target);
    PlacedLight placed{describe(lamp, sample, points.empty(), placement.camera_origin),
                       ShadowKind(lamp.type), placement.resolution, {}};
    if (shadows && lamp.cast_shadow)
      placed.views = shadow_views(lamp, sample, point.texel_shift, placement);
    append(set, std::move(placed), placement);
  }
  for (const MeshLight& light : mesh_lights) {
    const int resolution = std::max(placement.resolution / kMeshShare, 16);
    PlacedLight placed{describe(light, placement.camera_origin), ShadowKind::kMesh, resolution, {}};
    if (shadows)
      placed.views = surrounding_views(light.position, side_of(light), bounds, resolution);
    append(set, std::move(placed), placement);
  }
  return set;
}

}  // namespace panoptes::rasterize
