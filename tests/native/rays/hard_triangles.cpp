// Broken, degenerate, coinciding and crowded triangles.
#include "rays/hard_cases.h"

#include <cmath>
#include <limits>

namespace panoptes::test {

namespace {

constexpr uint32_t kRays = 100;

// The square |x|, |y| <= half at height z.
void add_square(Triangles& to, float z, float half) {
  add_quad(to, {-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z});
}

// Rays down onto the square |x|, |y| <= half from height z, meeting `what`.
void look_down(HardCase& c, float z, float half, uint32_t what, uint32_t count = kRays) {
  Random random(51);
  for (uint32_t i = 0; i < count; ++i)
    c.add(make_ray({random.between(-half, half), random.between(-half, half), z}, {0, 0, -1}),
          what);
}

HardCase slivers() {
  HardCase c;
  Random random(52);
  for (int i = 0; i < 500; ++i) {
    const glm::vec3 a = random.in_box(glm::vec3(-1), glm::vec3(1)), along = random.on_sphere();
    const float width = std::pow(10.0f, random.between(-7, -3));
    c.triangles.push_back(make_triangle(a, a + along, a + along + width * random.on_sphere()));
  }
  add_rays_of_all_kinds(c, kRays);
  return c;
}

// Points, lines, and triangles folded onto a line: none of them can be met, the floor below can.
HardCase zero_area() {
  HardCase c;
  Random random(53);
  for (int i = 0; i < 64; ++i) {
    const float x = random.between(-1, 1), y = random.between(-1, 1);
    c.triangles.push_back(make_triangle({x, y, 1}, {x, y, 1}, {x, y, 1}));
    c.triangles.push_back(make_triangle({x, y, 1}, {x, -y, 1}, {x, -y, 1}));
    c.triangles.push_back(make_triangle({x, -1, 1}, {x, 1, 1}, {x, 0, 1}));
  }
  const uint32_t floor = uint32_t(c.triangles.size());
  add_square(c.triangles, 0, 2);
  for (uint32_t i = 0; i < 3 * 64; ++i) {
    const glm::vec3 at = corner(c.triangles[i], int(i % 2));
    c.add(make_ray({at.x, at.y, 3}, {0, 0, -1}), at.y <= at.x ? floor : floor + 1);
  }
  add_rays_of_all_kinds(c, kRays);
  return c;
}

HardCase only_points() {
  HardCase c;
  for (int i = 0; i < 3; ++i) c.triangles.push_back(make_triangle({1, 2, 3}, {1, 2, 3}, {1, 2, 3}));
  Random random(54);
  for (uint32_t i = 0; i < kRays; ++i) {
    const glm::vec3 way = random.on_sphere();
    c.add(make_ray(glm::vec3(1, 2, 3) - 2.0f * way, way), shared::NO_PRIMITIVE);
  }
  return c;
}

// Of several in one place the first is met; behind it (`after`) each of the others once.
HardCase duplicates() {
  HardCase c;
  for (int i = 0; i < 7; ++i)
    c.triangles.push_back(make_triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0}));
  look_down(c, 2, 0.25f, 0);
  for (uint32_t i = 0; i < 7; ++i) {
    TracedRay ray = make_ray({0, 0, 2}, {0, 0, -1}, 2);
    ray.after = i;
    c.add(ray, i + 1 < 7 ? i + 1 : shared::NO_PRIMITIVE);
  }
  return c;
}

HardCase coplanar_layers() {
  HardCase c;
  for (float half : {1.0f, 2.0f, 0.7f, 1.3f, 3.0f, 0.1f}) add_square(c.triangles, 0.3f, half);
  add_surface(c.triangles, 7, 7,
              [](float u, float v) { return glm::vec3(3 * u - 1.5f, 3 * v - 1.5f, 0.3f); });
  add_rays_of_all_kinds(c, kRays, 1.0f);
  Random random(55);
  for (uint32_t i = 0; i < kRays; ++i) {
    const glm::vec3 from = 5.0f * random.on_sphere();
    c.add(make_ray(from, random.in_box({-1, -1, 0.3f}, {1, 1, 0.3f}) - from), kSomething);
  }
  return c;
}

HardCase stacked_layers() {
  HardCase c;
  for (int i = 0; i < 200; ++i) add_square(c.triangles, float(i) * 0x1p-10f, 1);
  add_rays_of_all_kinds(c, kRays);
  look_down(c, 1, 0.9f, kSomething);
  return c;
}

HardCase broken_vertices() {
  HardCase c;
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  for (float bad : {nan, infinity, -infinity})
    for (int k = 0; k < 9; ++k) {
      float p[9] = {-1, -1, 1, 1, -1, 1, 0, 1, 1};
      p[k] = bad;
      c.triangles.push_back(
          make_triangle({p[0], p[1], p[2]}, {p[3], p[4], p[5]}, {p[6], p[7], p[8]}, 0));
    }
  const uint32_t floor = uint32_t(c.triangles.size());
  c.triangles.push_back(make_triangle({-4, -4, 0}, {4, -4, 0}, {0, 4, 0}));
  c.triangles.push_back(make_triangle({-1, -1, 1}, {1, -1, 1}, {0, 1, 1}, 0));
  look_down(c, 2, 0.5f, floor);
  return c;
}

HardCase seen_by_nobody() {
  HardCase c{{make_triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, 0)}, {}, {}};
  look_down(c, 2, 0.25f, shared::NO_PRIMITIVE);
  return c;
}

// The middle of the scene's bounds lies in a face, on an edge and at a corner.
HardCase geometry_at_the_middle() {
  HardCase c;
  add_box(c.triangles, glm::vec3(-2), glm::vec3(2));
  c.triangles.push_back(make_triangle({0, 0, 0}, {1, 0, 0.25f}, {0, 1, 0.5f}));
  c.triangles.push_back(make_triangle({-1, 0, 0}, {1, 0, 0}, {0, 0.5f, -1}));
  c.triangles.push_back(make_triangle({-1, -1, 0.5f}, {1, -1, -0.5f}, {0, 2, 0}));
  add_rays_of_all_kinds(c, 2 * kRays);
  Random random(56);
  for (uint32_t i = 0; i < kRays; ++i)
    c.add(make_ray(glm::vec3(0), random.on_sphere()), kSomething);
  return c;
}

// 100 000 small triangles in a cube of a centimetre, in a room of 20 m.
HardCase crowded_corner() {
  HardCase c;
  add_box(c.triangles, glm::vec3(-10), glm::vec3(10));
  Random random(57);
  const glm::vec3 place(3, -4, 5);
  const auto near = [&] { return place + random.in_box(glm::vec3(-0.005f), glm::vec3(0.005f)); };
  for (int i = 0; i < 100'000; ++i) {
    const glm::vec3 a = near();
    c.triangles.push_back(
        make_triangle(a, a + 5e-4f * random.on_sphere(), a + 5e-4f * random.on_sphere()));
  }
  for (uint32_t i = 0; i < 48; ++i) {
    const glm::vec3 from = random.in_box(glm::vec3(-9), glm::vec3(9));
    c.add(make_ray(from, near() - from), kSomething);
    c.add(make_ray(near(), random.on_sphere()), kSomething);
    c.add(make_ray(from, random.on_sphere()), kSomething);
  }
  return c;
}

// More triangles in one place than an invocation of llvmpipe can loop over.
HardCase hundred_thousand_duplicates() {
  HardCase c;
  for (int i = 0; i < 100'000; ++i)
    c.triangles.push_back(make_triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0}));
  look_down(c, 2, 0.25f, 0, 16);
  TracedRay behind = make_ray({0, 0, 2}, {0, 0, -1}, 2);
  behind.after = 99'998;
  c.add(behind, 99'999);
  behind.after = 99'999;
  c.add(behind, shared::NO_PRIMITIVE);
  c.add(make_ray({0, 0, 2}, {0, 0, -1}, 2), shared::NO_PRIMITIVE);
  return c;
}

}  // namespace

std::vector<HardCaseMaker> hard_triangles() {
  return {{"Slivers", slivers},
          {"ZeroArea", zero_area},
          {"OnlyPoints", only_points},
          {"Duplicates", duplicates},
          {"CoplanarLayers", coplanar_layers},
          {"StackedLayers", stacked_layers},
          {"BrokenVertices", broken_vertices},
          {"SeenByNobody", seen_by_nobody},
          {"GeometryAtTheMiddle", geometry_at_the_middle},
          {"CrowdedCorner", crowded_corner},
          {"HundredThousandDuplicates", hundred_thousand_duplicates}};
}

}  // namespace panoptes::test
