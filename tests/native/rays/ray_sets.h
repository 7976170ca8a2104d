// Sets of rays through a scene, the same on every run.
#pragma once

#include "rays/embree_scene.h"
#include "rays/scenes.h"

#include <string>
#include <vector>

namespace panoptes::test {

struct RaySet {
  std::string name;
  bool any_hit = false;
  // Aimed at edges, vertices and planes of the structures: float rounding decides many of them, so
  // that two right tracers differ; only the oracle can judge.
  bool aimed = false;
  std::vector<TracedRay> rays = {};
};

inline glm::vec3 origin_of(const TracedRay& r) { return {r.origin_x, r.origin_y, r.origin_z}; }
inline glm::vec3 direction_of(const TracedRay& r) {
  return {r.direction_x, r.direction_y, r.direction_z};
}

constexpr float kFarAway = 1e30f;  // t_max of rays without an end
TracedRay make_ray(const glm::vec3& origin, const glm::vec3& direction, float t_min = 0,
                   float t_max = kFarAway);

// From the camera, in blocks of 8 x 8 pixels, as renderers order them.
RaySet primary_rays(const RayScene& scene, uint32_t count);
// What starts at surfaces that the camera sees: specular, glossy (Phong lobe of exponent 100),
// diffuse (cosine), shadow (to points on a square lamp; any hit), visibility (to one point outside
// the scene; any hit). A scene that the camera does not see gives empty sets.
std::vector<RaySet> secondary_rays(const RayScene& scene, const EmbreeScene& reference,
                                   uint32_t count);
// Through the scene's middle, at and along edges and vertices, along edges, corners and diagonals
// of cubes around the middle, and along the axes.
std::vector<RaySet> aimed_rays(const RayScene& scene, uint32_t count);
// All of the above.
std::vector<RaySet> all_rays(const RayScene& scene, const EmbreeScene& reference, uint32_t count);

// `position` moved off its surface along `normal`, so far that rounding cannot put it behind
// (Waechter and Binder, A Fast and Robust Method for Avoiding Self-Intersection, 2019).
glm::vec3 offset_origin(const glm::vec3& position, const glm::vec3& normal);

}  // namespace panoptes::test
