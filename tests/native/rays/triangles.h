// Lists of triangles as tracers take them, and the pieces that test scenes are made of. Metres, z
// up.
#pragma once

#include "scene/scene.h"
#include "tracing/rays_shared.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace panoptes::test {

using shared::TracedTriangle;
using Triangles = std::vector<TracedTriangle>;

TracedTriangle make_triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                             uint32_t flags = shared::SEEN_BY_ALL);
// Vertex k of a triangle, k < 3.
glm::vec3 corner(const TracedTriangle& triangle, int k);
inline bool seen(const TracedTriangle& t) { return (t.flags & shared::TRIANGLE_SEEN_BY) != 0; }
// Of the triangles that somebody sees.
scene::Bounds bounds_of(const Triangles& triangles);

// Two triangles; corners in order around the quadrilateral.
void add_quad(Triangles& to, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
              const glm::vec3& d);
void add_box(Triangles& to, const glm::vec3& low, const glm::vec3& high);
// columns x rows quadrilaterals of the surface (u, v) -> position, u and v in 0..1.
void add_surface(Triangles& to, int columns, int rows,
                 const std::function<glm::vec3(float u, float v)>& position);

// Numbers that are the same on every machine (SplitMix64).
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}
  uint64_t bits();
  uint32_t below(uint32_t count) { return uint32_t((bits() >> 32) * count >> 32); }
  float uniform() { return float(bits() >> 40) * 0x1p-24f; }  // in [0, 1)
  float between(float low, float high) { return low + (high - low) * uniform(); }
  glm::vec3 in_box(const glm::vec3& low, const glm::vec3& high);
  glm::vec3 on_sphere();  // unit

 private:
  uint64_t state_;
};

}  // namespace panoptes::test
