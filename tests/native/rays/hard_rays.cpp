// Rays at their limits: where they start and end, how long their directions are, what they may see,
// and where they meet edges.
#include "rays/hard_cases.h"

#include <cmath>

namespace panoptes::test {

namespace {

constexpr uint32_t kRays = 100;

// A closed ball; the ray sets of at_edges() and along_cubes() start in it or outside.
void add_ball(Triangles& to, float radius, int segments) {
  constexpr float kTurn = 6.2831853f;
  add_surface(to, segments, segments / 2, [&](float u, float v) {
    const float a = u < 1 ? u * kTurn : 0, b = 0.5f * v * kTurn;
    if (v == 0 || v == 1) return glm::vec3(0, 0, v == 0 ? radius : -radius);
    return radius * glm::vec3(std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), std::cos(b));
  });
}

// From inside a closed surface at its vertices and the middles of its edges: none slips through.
HardCase watertight() {
  HardCase c;
  add_ball(c.triangles, 1, 24);
  Random random(61);
  for (const TracedTriangle& t : c.triangles)
    for (int k = 0; k < 3; ++k) {
      const glm::vec3 a = corner(t, k), b = corner(t, (k + 1) % 3);
      const glm::vec3 from = random.in_box(glm::vec3(-0.4f), glm::vec3(0.4f));
      c.add(make_ray(from, a - from), kSomething);
      c.add(make_ray(from, 0.5f * (a + b) - from), kSomething);
      c.add(make_ray(glm::vec3(0), a), kSomething);
    }
  return c;
}

// The vertices lie on planes that structures divide space by: halves, quarters, eighths ...
HardCase regular_grid() {
  HardCase c;
  for (int axis = 0; axis < 3; ++axis)
    for (float side : {-4.0f, 0.0f, 4.0f})
      add_surface(c.triangles, 8, 8, [&](float u, float v) {
        glm::vec3 p(side);
        p[(axis + 1) % 3] = 8 * u - 4;
        p[(axis + 2) % 3] = 8 * v - 4;
        return p;
      });
  add_rays_of_all_kinds(c, 2 * kRays);
  // Along the axes through the grid's own lines, from inside: the outermost squares close the box.
  for (int x = -3; x <= 3; ++x)
    for (int y = -3; y <= 3; ++y)
      for (int axis = 0; axis < 3; ++axis) {
        glm::vec3 from(0.5f), direction(-0.0f);
        from[(axis + 1) % 3] = float(x);
        from[(axis + 2) % 3] = float(y);
        direction[axis] = (x + y) % 2 ? 1.0f : -1.0f;
        c.add(make_ray(from, direction), kSomething);
      }
  return c;
}

// Ever flatter over a floor that ends at a wall; in the floor's very plane only the wall is met.
HardCase grazing() {
  HardCase c;
  add_quad(c.triangles, {-8, -8, 0}, {8, -8, 0}, {8, 8, 0}, {-8, 8, 0});
  add_quad(c.triangles, {8, -8, -1}, {8, 8, -1}, {8, 8, 1}, {8, -8, 1});
  Random random(62);
  for (uint32_t i = 0; i < 4 * kRays; ++i) {
    const float slope = std::pow(10.0f, random.between(-8, -1));
    const glm::vec3 from(random.between(-7, 0), random.between(-7, 7),
                         random.between(0, 4) * slope);
    c.add(make_ray(from, {1, random.between(-0.1f, 0.1f), -slope}), kSomething);
  }
  for (uint32_t i = 0; i < kRays; ++i) {
    const glm::vec3 from(random.between(-7, 0), random.between(-7, 7), 0);
    c.add(make_ray(from, {1, 0, 0}), kSomething);
  }
  return c;
}

// On faces, edges and vertices, in all directions.
HardCase starts_on_geometry() {
  HardCase c;
  add_ball(c.triangles, 1, 24);
  add_box(c.triangles, {-0.25f, -0.25f, -0.25f}, {0.25f, 0.5f, 0.125f});
  Random random(63);
  for (uint32_t i = 0; i < 4 * kRays; ++i) {
    const TracedTriangle& t = c.triangles[random.below(uint32_t(c.triangles.size()))];
    const float u = random.uniform(), v = i % 2 ? 0 : (1 - u) * random.uniform();
    const glm::vec3 from = corner(t, 0) * (1 - u - v) + corner(t, 1) * u + corner(t, 2) * v;
    c.add(make_ray(i % 4 == 3 ? corner(t, 2) : from, random.on_sphere()));
  }
  return c;
}

// Squares at z = 0, -1, -2 ... whose t is exact: t_min is out, t_max is in.
HardCase limits() {
  HardCase c;
  for (int i = 0; i < 4; ++i)
    c.triangles.push_back(
        make_triangle({-4, -4, float(-i)}, {4, -4, float(-i)}, {0, 4, float(-i)}));
  // Twice: t counts in the direction's length, and a factor of 4 rounds nothing.
  const auto add = [&](float t_min, float t_max, uint32_t what) {
    c.add(make_ray({0, 0, 1}, {0, 0, -1}, t_min, t_max), what);
    c.add(make_ray({0, 0, 1}, {0, 0, -4}, 0.25f * t_min, 0.25f * t_max), what);
  };
  const uint32_t none = shared::NO_PRIMITIVE;
  add(0, 1, 0);
  add(0, std::nextafter(1.0f, 0.0f), none);
  add(1, 9, 1);
  add(std::nextafter(1.0f, 0.0f), 9, 0);
  add(1, 2, 1);
  add(1, 1.5f, none);
  add(2.5f, kFarAway, 2);
  add(3, kFarAway, 3);
  add(4, kFarAway, none);
  add(2, 1, none);
  add(1, 1, none);
  add(0, 0, none);
  add(1e20f, kFarAway, none);
  return c;
}

// Directions of lengths from 1e-20 to 1e20: t counts in them.
HardCase direction_lengths() {
  HardCase c;
  for (int i = 0; i < 3; ++i)
    add_quad(c.triangles, {-4, -4, float(-i)}, {4, -4, float(-i)}, {4, 4, float(-i)},
             {-4, 4, float(-i)});
  Random random(64);
  for (float length : {1e-20f, 1e-10f, 1e-3f, 1e3f, 1e10f, 1e20f})
    for (uint32_t i = 0; i < kRays / 4; ++i) {
      const glm::vec3 from(random.between(-1, 1), random.between(-1, 1), 1);
      const glm::vec3 way(random.between(-1, 1), random.between(-1, 1), -1);
      c.add(make_ray(from, length * way), kSomething);
      c.add(make_ray(from, -length * way), shared::NO_PRIMITIVE);
      c.add(make_ray(from, length * way, 0, 0.5f / length), shared::NO_PRIMITIVE);
      c.add(make_ray(from, {0, 0, -length}, 1.5f / length), from.y <= from.x ? 2 : 3);
    }
  return c;
}

// One layer for each kind of ray: a ray meets the first that it may see.
HardCase visibility() {
  HardCase c;
  for (uint32_t bit = 0; bit < 6; ++bit)
    c.triangles.push_back(
        make_triangle({-1, -1, -float(bit)}, {1, -1, -float(bit)}, {0, 1, -float(bit)}, 1u << bit));
  for (uint32_t seen_by = 0; seen_by < 64; ++seen_by) {
    TracedRay ray = make_ray({0, 0, 1}, {0, 0, -1});
    ray.seen_by = seen_by;
    uint32_t first = shared::NO_PRIMITIVE;
    for (uint32_t bit = 6; bit-- > 0;)
      if (seen_by & (1u << bit)) first = bit;
    c.add(ray, first);
  }
  return c;
}

}  // namespace

std::vector<HardCaseMaker> hard_rays() {
  return {{"Watertight", watertight}, {"RegularGrid", regular_grid},
          {"Grazing", grazing},       {"StartsOnGeometry", starts_on_geometry},
          {"Limits", limits},         {"DirectionLengths", direction_lengths},
          {"Visibility", visibility}};
}

}  // namespace panoptes::test
