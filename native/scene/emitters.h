// Glowing surfaces as lamps: which parts of the scene emit, and points on them. No GL.
//
// An emitter is what one instance shows of one material that emits. Its points are uniform over its
// area in world space, so that a point stands for area() square metres.
#pragma once

#include "scene/scene.h"

#include <array>
#include <memory>

namespace panoptes::scene {

struct EmitterPoint {
  glm::dvec3 position;    // world space, metres
  glm::vec3 normal;       // unit, geometric, out of the side that fetch_hit() calls the front
  uint32_t instance = 0;
  uint32_t triangle = 0;  // in the mesh
  glm::vec2 barycentrics; // of the triangle's second and third vertex
};

// Triangles of one material range and their cumulative areas, ordered along a curve that fills space:
// strata of the sum are patches of the surface, whatever the order of a mesh's faces. Instances that
// are placed by similarities share one, since only the ratios of areas count.
struct EmitterShape {
  struct Triangle {
    uint32_t index;                      // in the mesh
    std::array<glm::vec3, 3> positions;  // object space
  };
  std::vector<Triangle> triangles;
  std::vector<double> cumulative;  // areas under the transform that it was made for

  EmitterShape(const Mesh& mesh, const MaterialRange& range, const glm::dmat3& linear);
  double area() const { return cumulative.empty() ? 0.0 : cumulative.back(); }
};

class Emitter {
 public:
  // `shape` as instance number `instance` places it; `area` in world space.
  Emitter(std::shared_ptr<const EmitterShape> shape, const glm::mat4& object_to_world, double area,
          uint32_t instance, Id material)
      : shape_(std::move(shape)), object_to_world_(object_to_world), area_(area),
        instance_(instance), material_(material) {}

  Id material() const { return material_; }
  double area() const { return area_; }  // m2, world space
  // The point that (u, v) in [0,1)^2 stands for. Only where area() is positive.
  EmitterPoint sample(float u, float v) const;

 private:
  std::shared_ptr<const EmitterShape> shape_;  // a copy: points are drawn while the scene is edited
  glm::mat4 object_to_world_;
  double area_;
  uint32_t instance_;
  Id material_;
};

// All emitters of a scene that have an area and that scattered rays meet; materials are asked for
// their facts, so some of these may turn out black.
std::vector<Emitter> find_emitters(const Scene& scene);

}  // namespace panoptes::scene
