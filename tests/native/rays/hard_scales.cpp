// Sizes from a millimetre to thousands of kilometres, places far away, and scenes without depth.
#include "rays/hard_cases.h"

#include <cmath>

namespace panoptes::test {

namespace {

constexpr uint32_t kRays = 100;  // of each kind

void transform(Triangles& triangles, float scale, const glm::vec3& offset) {
  for (TracedTriangle& t : triangles) {
    const auto put = [&](int k) { return scale * corner(t, k) + offset; };
    t = make_triangle(put(0), put(1), put(2), t.flags);
  }
}

HardCase scaled_room(float scale) {
  HardCase c{box_room().triangles, {}, {}};
  transform(c.triangles, scale, glm::vec3(0));
  add_rays_of_all_kinds(c, kRays);
  return c;
}

HardCase millimetres_and_kilometres() {
  HardCase c{box_room().triangles, {}, {}};
  transform(c.triangles, 1e-3f, {0.125f, 0.25f, 0.5f});
  const scene::Bounds small = bounds_of(c.triangles);
  add_surface(c.triangles, 20, 20, [](float u, float v) {
    return 2000.0f * glm::vec3(u - 0.5f, v - 0.5f, 0.02f * std::sin(20 * u) * std::sin(20 * v));
  });
  add_rays_of_all_kinds(c, kRays);
  // Within the small room, from there to the hills, and from the hills into the room.
  Random random(41);
  for (uint32_t i = 0; i < kRays; ++i) {
    const glm::vec3 a = random.in_box(small.low, small.high),
                    b = random.in_box(small.low, small.high);
    const glm::vec3 far(random.between(-900, 900), random.between(-900, 900), 60);
    c.add(make_ray(a, b - a));
    c.add(make_ray(a, far - a));
    c.add(make_ray(far, a - far));
  }
  return c;
}

// 2^20 m away, where neighbouring floats are 1/8 m apart; every vertex lies on that grid.
HardCase far_from_the_origin() {
  HardCase c;
  const glm::vec3 place(1048576.0f, -1048576.0f, 1048576.0f);
  add_box(c.triangles, place + glm::vec3(-2.0f, -1.5f, -1.0f), place + glm::vec3(2.0f, 1.5f, 1.0f));
  add_box(c.triangles, place + glm::vec3(-0.5f, -0.25f, -1.0f),
          place + glm::vec3(0.125f, 0.5f, 0.25f));
  add_rays_of_all_kinds(c, kRays);
  // From between the boxes outwards: the outer one is closed.
  Random random(42);
  for (uint32_t i = 0; i < kRays; ++i)
    c.add(make_ray(place + glm::vec3(1.0f, 1.0f, 0.5f), random.on_sphere()), kSomething);
  return c;
}

// A checkered square in a plane across `axis`, met from both sides, along the plane and past it.
HardCase flat_scene(int axis) {
  HardCase c;
  const auto turned = [axis](float u, float v, float w) {
    glm::vec3 p;
    p[axis] = w;
    p[(axis + 1) % 3] = u;
    p[(axis + 2) % 3] = v;
    return p;
  };
  add_surface(c.triangles, 8, 8, [&](float u, float v) { return turned(8 * u - 4, 8 * v - 4, 0); });
  Random random(43);
  for (uint32_t i = 0; i < kRays; ++i) {
    const float u = random.between(-3.9f, 3.9f), v = random.between(-3.9f, 3.9f);
    const float side = i % 2 ? 1.0f : -1.0f;
    c.add(make_ray(turned(u, v, 2 * side), turned(0, 0, -side)), kSomething);
    c.add(make_ray(turned(u, v, 2 * side), turned(0, 0, side)), shared::NO_PRIMITIVE);
    const glm::vec3 from = turned(random.between(-9, 9), random.between(-9, 9), 3 * side);
    c.add(make_ray(from, turned(u, v, 0) - from), kSomething);
    // Beside the edge and within the plane: a surface has no thickness.
    c.add(make_ray(turned(u + 8, v, 2 * side), turned(0, 0, -side)), shared::NO_PRIMITIVE);
    c.add(make_ray(turned(u, v, 0), turned(side, 0, 0)), shared::NO_PRIMITIVE);
    c.add(make_ray(turned(-9, v, 0), turned(1, 0.25f * u, 0)), shared::NO_PRIMITIVE);
  }
  return c;
}

HardCase huge_triangle() {
  HardCase c{box_room().triangles, {}, {}};
  c.triangles.push_back(
      make_triangle({-1e6f, -2e6f, -1.5e6f}, {2e6f, 1e6f, 0.5e6f}, {-1e6f, 1.5e6f, 1e6f}));
  add_rays_of_all_kinds(c, kRays);
  Random random(44);
  for (uint32_t i = 0; i < 2 * kRays; ++i) {
    const glm::vec3 a = random.in_box(glm::vec3(-1), glm::vec3(1));
    c.add(make_ray(a, random.on_sphere()));
  }
  return c;
}

HardCase one_triangle() {
  HardCase c{{make_triangle({-1, -1, 0.5f}, {1, -1, 0.25f}, {0, 1, -0.5f})}, {}, {}};
  add_rays_of_all_kinds(c, kRays);
  c.add(make_ray({0, 0, 3}, {0, 0, -1}), 0);
  c.add(make_ray({0, 0, 3}, {0, 0, 1}), shared::NO_PRIMITIVE);
  c.add(make_ray({3, 3, 3}, {0, 0, -1}), shared::NO_PRIMITIVE);
  return c;
}

HardCase empty_scene() {
  HardCase c;
  Random random(45);
  for (uint32_t i = 0; i < kRays; ++i)
    c.add(make_ray(random.in_box(glm::vec3(-1), glm::vec3(1)), random.on_sphere()),
          shared::NO_PRIMITIVE);
  return c;
}

// Starts up to a million times the scene's size away.
HardCase distant_starts() {
  HardCase c;
  add_box(c.triangles, glm::vec3(-1), glm::vec3(1));
  Random random(46);
  for (float distance : {1e2f, 1e4f, 1e6f})
    for (uint32_t i = 0; i < kRays; ++i) {
      const glm::vec3 away = distance * random.on_sphere();
      c.add(make_ray(away, 0.5f * random.on_sphere() - away));
      c.add(make_ray(away, away), shared::NO_PRIMITIVE);
    }
  return c;
}

}  // namespace

std::vector<HardCaseMaker> hard_scales() {
  return {{"Millimetres", [] { return scaled_room(1e-3f); }},
          {"Micrometres", [] { return scaled_room(1e-6f); }},
          {"Kilometres", [] { return scaled_room(1e3f); }},
          {"ThousandsOfKilometres", [] { return scaled_room(1e6f); }},
          {"MillimetresAndKilometres", millimetres_and_kilometres},
          {"FarFromTheOrigin", far_from_the_origin},
          {"FlatAcrossX", [] { return flat_scene(0); }},
          {"FlatAcrossY", [] { return flat_scene(1); }},
          {"FlatAcrossZ", [] { return flat_scene(2); }},
          {"HugeTriangle", huge_triangle},
          {"OneTriangle", one_triangle},
          {"EmptyScene", empty_scene},
          {"DistantStarts", distant_starts}};
}

}  // namespace panoptes::test
