// Rays that meet edges, vertices and the planes that structures divide space by.
#include "rays/ray_sets.h"

#include <cmath>

namespace panoptes::test {

namespace {

// A point of the box, a little inside.
glm::vec3 within(Random& random, const scene::Bounds& box) {
  const glm::vec3 inset = 0.02f * (box.high - box.low);
  return random.in_box(box.low + inset, box.high - inset);
}

// From anywhere to the scene's middle and beyond. Half of them have directions of full length.
RaySet through_the_middle(const RayScene& scene, uint32_t count) {
  RaySet set{"centre", false, true, {}};
  Random random(21);
  const glm::vec3 middle = 0.5f * (scene.bounds.low + scene.bounds.high);
  for (uint32_t i = 0; i < count; ++i) {
    const glm::vec3 from = within(random, scene.bounds), to = middle - from;
    set.rays.push_back(make_ray(from, i % 2 ? to : glm::normalize(to)));
  }
  return set;
}

// At vertices and points on edges, from anywhere and from other vertices; from vertices and edges
// to anywhere; and along edges.
RaySet at_edges(const RayScene& scene, uint32_t count) {
  RaySet set{"edges", false, true, {}};
  Random random(22);
  const auto triangle = [&] {
    return scene.triangles[random.below(uint32_t(scene.triangles.size()))];
  };
  for (uint32_t i = 0; i < count; ++i) {
    const TracedTriangle t = triangle();
    const int k = int(random.below(3));
    const glm::vec3 a = corner(t, k), b = corner(t, (k + 1) % 3);
    const glm::vec3 on_edge = 0.5f * (a + b), anywhere = within(random, scene.bounds);
    const auto between = [](const glm::vec3& from, const glm::vec3& to) {
      return make_ray(from, to - from);
    };
    switch (i % 6) {
      case 0: set.rays.push_back(between(anywhere, a)); break;
      case 1: set.rays.push_back(between(anywhere, on_edge)); break;
      case 2: set.rays.push_back(between(corner(triangle(), 0), a)); break;
      case 3: set.rays.push_back(between(a, anywhere)); break;
      case 4: set.rays.push_back(between(on_edge, anywhere)); break;
      default: set.rays.push_back(between(a - 0.5f * (b - a), b));
    }
    if (direction_of(set.rays.back()) == glm::vec3(0)) set.rays.back().direction_x = 1;
  }
  return set;
}

// From the middle and from points on the cube's planes, along edges, corners and diagonals of a
// cube around the middle, exactly or one unit in the last place beside.
RaySet along_cubes(const RayScene& scene, uint32_t count) {
  RaySet set{"cube edges", false, true, {}};
  Random random(23);
  const glm::vec3 middle = 0.5f * (scene.bounds.low + scene.bounds.high);
  const float reach = 0.45f * glm::length(scene.bounds.high - scene.bounds.low);
  const auto sign = [&] { return random.below(2) ? 1.0f : -1.0f; };
  // Two components of equal size, in the diagonal plane between two faces; three in a corner.
  const auto diagonal = [&] {
    const uint32_t odd = random.below(4);
    glm::vec3 d(sign(), sign(), sign());
    if (odd < 3) d[int(odd)] = random.between(-1, 1);
    return d;
  };
  for (uint32_t i = 0; i < count; ++i) {
    glm::vec3 direction = diagonal();
    if (i % 2) {
      const int k = int(random.below(3));
      direction[k] = std::nextafter(direction[k], sign() * 2);
    }
    const glm::vec3 aside = i % 3 ? glm::vec3(0) : reach * random.uniform() * diagonal();
    set.rays.push_back(make_ray(middle + aside, direction));
  }
  return set;
}

// Along the axes, from anywhere and from vertices; zeros of both signs.
RaySet along_axes(const RayScene& scene, uint32_t count) {
  RaySet set{"axes", false, true, {}};
  Random random(24);
  for (uint32_t i = 0; i < count; ++i) {
    glm::vec3 direction(random.below(2) ? 0.0f : -0.0f);
    direction[int(random.below(3))] = random.below(2) ? 1.0f : -1.0f;
    const glm::vec3 vertex = corner(scene.triangles[random.below(uint32_t(scene.triangles.size()))],
                                    int(random.below(3)));
    glm::vec3 from = within(random, scene.bounds);
    if (i % 2) from = vertex - 0.25f * glm::length(from - vertex) * direction;
    set.rays.push_back(make_ray(from, direction));
  }
  return set;
}

}  // namespace

std::vector<RaySet> aimed_rays(const RayScene& scene, uint32_t count) {
  return {through_the_middle(scene, count), at_edges(scene, count), along_cubes(scene, count),
          along_axes(scene, count)};
}

}  // namespace panoptes::test
