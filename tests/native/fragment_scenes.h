// Scenes and rays that the tests of fragments share.
#pragma once

#include "fragment_tracer/fragment_tracer.h"
#include "rays/ray_sets.h"
#include "rays/shared_device.h"

#include <vector>

namespace panoptes::test {

inline std::vector<TracedHit> hits_of(tracing::Tracer& tracer, const std::vector<TracedRay>& rays) {
  tracing_device().build(tracer);
  return tracing_device().trace(tracer, rays).hits;
}

inline TracedRay ray_between(const glm::vec3& from, const glm::vec3& to) {
  const glm::vec3 d = to - from;
  return {from.x, from.y, from.z, 0, d.x, d.y, d.z, 1, shared::NO_PRIMITIVE, shared::TRIANGLE_SEEN_BY, 0, 0};
}

// Triangles that fill the face of the cube along +x, square to it, at these distances from the eye.
inline Triangles layers(const std::vector<float>& depths) {
  Triangles triangles;
  for (float depth : depths)
    triangles.push_back(make_triangle({depth, -10 * depth, -10 * depth}, {depth, 30 * depth, -10 * depth},
                                      {depth, -10 * depth, 30 * depth}));
  return triangles;
}

// The thesis' own test of a fragment, without thickness.
inline fragment_tracer::Settings by_depth() {
  fragment_tracer::Settings settings;
  settings.views = fragment_tracer::Views::kCube;
  settings.side = 64;
  settings.by_plane = false;
  settings.thickness = 0;
  settings.buckets = 4;
  return settings;
}

// A closed room with things in it: a ray that meets nothing has been lost.
struct Room {
  Triangles triangles;
  glm::vec3 eye{0.1f, -0.2f, 0.15f};
  Room() {
    add_box(triangles, glm::vec3(-4, -3, -2), glm::vec3(4, 3, 2));
    add_box(triangles, {1, -1, -2}, {2, 1, -0.5f});
    add_box(triangles, {-3, 1, -2}, {-2, 2, 1});
    add_surface(triangles, 24, 24, [](float u, float v) {
      return glm::vec3(-2 + 3 * u, -2.5f + 2 * v, 0.4f * std::sin(5 * u) * std::cos(4 * v) - 1);
    });
  }
};

inline std::vector<TracedRay> rays_in_room(uint32_t count) {
  Random random(11);
  std::vector<TracedRay> rays;
  for (uint32_t i = 0; i < count; ++i)
    rays.push_back(make_ray(random.in_box(glm::vec3(-3.9f, -2.9f, -1.9f), glm::vec3(3.9f, 2.9f, 1.9f)),
                            random.in_box(glm::vec3(-1), glm::vec3(1))));
  return rays;
}

}  // namespace panoptes::test
