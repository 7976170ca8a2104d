// Lamps with Blender's values, and what they emit by Cycles' conventions (measured in 3.4; tests/
// compare each of them).
#pragma once

#include <glm/glm.hpp>

namespace panoptes::scene {

enum class LightType { kPoint = 0, kSun = 1, kSpot = 2, kArea = 3 };
enum class AreaShape { kSquare, kRectangle, kDisk, kEllipse };

struct Light {
  LightType type = LightType::kPoint;
  glm::mat4 object_to_world{1.0f};
  glm::vec3 color{1.0f};
  float energy = 0;       // W; for suns W/m2
  float radius = 0;       // m, points and spots
  float angle = 0;        // rad, the sun's diameter as seen
  float spot_size = 0.8f;  // rad, the whole cone
  float spot_blend = 0;   // 0..1
  AreaShape shape = AreaShape::kSquare;
  float size_x = 1, size_y = 1;  // m, before the object's scale
  float spread = 3.14159265f;    // rad, areas
  bool cast_shadow = true;

  glm::vec3 position() const { return glm::vec3(object_to_world[3]); }
  // Unit, where the lamp shines; -Z of the object. Downwards when the matrix is singular.
  glm::vec3 direction() const;
  // Irradiance at normal incidence (suns, W/m2) or radiant intensity along the axis (W/sr).
  glm::vec3 power() const;
  bool operator==(const Light&) const = default;
  // True when the lamp is more than a point, so that its shadows have penumbrae.
  bool extended() const;
};

// Replaces sizes and angles that are not finite or out of range by the nearest that make sense.
void make_finite(Light& light);

// One point of a lamp's extent.
struct LightSample {
  glm::vec3 position;  // world space, metres; unused for suns
  glm::vec3 direction; // unit, where the light goes; for points and spots the lamp's own axis
};

// The point of the lamp that (u, v) in [0,1)^2 stands for; uniform over the sun's disk, the disk of a
// point that faces `target`, the disk of a spot square to its axis, an area's shape.
LightSample sample_light(const Light& light, float u, float v, const glm::vec3& target);
// Its centre.
LightSample light_center(const Light& light);

}  // namespace panoptes::scene
