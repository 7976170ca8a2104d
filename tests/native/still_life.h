// A small scene with something of everything, at any scale and place.
#pragma once

#include "support.h"

namespace panoptes::test {

struct StillLife {
  TestScene scene;
  gpu_scene::Camera camera;
};

// A floor, a box and a smooth sphere under a sun, a point and a spot lamp. All lengths are
// multiples of `scale`; `origin` moves the world. Coordinates lie on a grid of 1/8 for a scale
// of 1.
inline StillLife still_life(float scale = 1, const glm::dvec3& origin = {0, 0, 0}, int size = 48) {
  StillLife life;
  TestScene& s = life.scene;
  const glm::vec3 o(origin);
  glm::mat4 place(1.0f);
  place[3] = glm::vec4(o, 1);
  const Id grey = s.add_material(lambert(glm::vec3(0.75f))),
           red = s.add_material(lambert({0.75f, 0.25f, 0.125f}));
  s.add_object(floor_at(0, 4 * scale), {grey}, place);
  s.add_object(box(scale * glm::vec3(-1, 0.5f, 0.5f), glm::vec3(0.5f * scale)), {red}, place);
  s.add_object(sphere(scale * glm::vec3(1, 0, 0.75f), 0.75f * scale, 48), {grey}, place);
  const float area = scale * scale;
  s.lights = {sun({0.5f, 0.25f, -1}, 2), point(o + scale * glm::vec3(-2, -1.5f, 2), 60 * area),
              spot(o + scale * glm::vec3(0, -2, 3), {0.125f, 0.5f, -1}, 200 * area, 1, 0.5f)};
  const glm::dvec3 eye = origin + double(scale) * glm::dvec3(0.5, -5, 3);
  life.camera = perspective(eye, origin + double(scale) * glm::dvec3(0, 0, 0.5), 0.75, size, size,
                            0.01 * scale, 100.0 * scale);
  return life;
}

}  // namespace panoptes::test
