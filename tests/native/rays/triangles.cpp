#include "rays/triangles.h"

#include <cmath>

namespace panoptes::test {

TracedTriangle make_triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                             uint32_t flags) {
  return {a.x, a.y, a.z, 0, b.x, b.y, b.z, 0, c.x, c.y, c.z, flags};
}

glm::vec3 corner(const TracedTriangle& t, int k) {
  return k == 0   ? glm::vec3(t.x0, t.y0, t.z0)
         : k == 1 ? glm::vec3(t.x1, t.y1, t.z1)
                  : glm::vec3(t.x2, t.y2, t.z2);
}

scene::Bounds bounds_of(const Triangles& triangles) {
  scene::Bounds bounds;
  for (const TracedTriangle& t : triangles)
    for (int k = 0; seen(t) && k < 3; ++k) bounds.add(corner(t, k));
  return bounds;
}

void add_quad(Triangles& to, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
              const glm::vec3& d) {
  to.push_back(make_triangle(a, b, c));
  to.push_back(make_triangle(a, c, d));
}

void add_box(Triangles& to, const glm::vec3& low, const glm::vec3& high) {
  const auto at = [&](int corner) {
    return glm::vec3(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                     corner & 4 ? high.z : low.z);
  };
  constexpr int kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& face : kFaces) add_quad(to, at(face[0]), at(face[1]), at(face[2]), at(face[3]));
}

void add_surface(Triangles& to, int columns, int rows,
                 const std::function<glm::vec3(float u, float v)>& position) {
  const auto at = [&](int i, int j) { return position(float(i) / columns, float(j) / rows); };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      add_quad(to, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
}

uint64_t Random::bits() {
  uint64_t z = state_ += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

glm::vec3 Random::in_box(const glm::vec3& low, const glm::vec3& high) {
  const float x = between(low.x, high.x), y = between(low.y, high.y), z = between(low.z, high.z);
  return {x, y, z};
}

glm::vec3 Random::on_sphere() {
  const float z = between(-1.0f, 1.0f), angle = between(0.0f, 6.2831853f);
  const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
  return {r * std::cos(angle), r * std::sin(angle), z};
}

}  // namespace panoptes::test
