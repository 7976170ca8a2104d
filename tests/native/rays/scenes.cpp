#include "rays/scenes.h"

#include "base/error.h"

#include <fmt/ranges.h>

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace panoptes::test {

namespace {

constexpr float kTurn = 6.2831853f;  // 2 pi

// Moves the scene's middle to the origin and sets the camera.
RayScene finish(const std::string& name, Triangles triangles, const glm::vec3& eye,
                const glm::vec3& target, float fov) {
  const scene::Bounds world = bounds_of(triangles);
  const glm::vec3 middle = 0.5f * (world.low + world.high);
  for (TracedTriangle& t : triangles)
    t = make_triangle(corner(t, 0) - middle, corner(t, 1) - middle, corner(t, 2) - middle, t.flags);
  RayScene scene{name, std::move(triangles), {}, {}, {}};
  scene.bounds = bounds_of(scene.triangles);
  scene.camera_from_scene =
      glm::lookAt(glm::dvec3(eye - middle), glm::dvec3(target - middle), glm::dvec3(0, 0, 1));
  scene.projection = glm::perspective(double(fov), 1.0, 0.01, 1000.0);
  return scene;
}

// --- the atrium ----------------------------------------------------------------------------------

constexpr float kHalfLength = 15.0f, kHalfWidth = 7.0f, kHeight = 12.0f;

// A fluted column that widens at its foot and its head, `height` above `foot`.
void add_column(Triangles& to, const glm::vec3& foot, float height) {
  add_surface(to, 48, 24, [&](float u, float v) {
    const float flutes = 1.0f + 0.06f * std::cos(u * kTurn * 16);
    const float swell = v < 0.08f ? 1.5f - 5 * v : v > 0.92f ? 1.0f + 5 * (v - 0.92f) : 1.0f;
    const float radius = 0.38f * flutes * swell;
    return foot + glm::vec3(radius * std::cos(u * kTurn), radius * std::sin(u * kTurn), v * height);
  });
}

// Half a torus that spans from one column to the next along x.
void add_arch(Triangles& to, const glm::vec3& middle, float span) {
  add_surface(to, 24, 10, [&](float u, float v) {
    const float along = 0.5f * kTurn * u, around = kTurn * v;
    const float radius = 0.5f * span + 0.22f * std::cos(around);
    return middle +
           glm::vec3(-radius * std::cos(along), 0.3f * std::sin(around), radius * std::sin(along));
  });
}

void add_colonnade(Triangles& to, float floor_height, float side) {
  constexpr int kColumns = 9;
  constexpr float kPitch = 3.25f, kColumnHeight = 3.6f;
  for (int i = 0; i < kColumns; ++i) {
    const glm::vec3 foot(-13.0f + i * kPitch, side * 4.0f, floor_height);
    const glm::vec3 head = foot + glm::vec3(0, 0, kColumnHeight);
    add_column(to, foot, kColumnHeight);
    add_box(to, head - glm::vec3(0.5f, 0.5f, 0), head + glm::vec3(0.5f, 0.5f, 0.2f));
    if (i + 1 < kColumns) add_arch(to, head + glm::vec3(0.5f * kPitch, 0, 0.2f), kPitch);
  }
}

void add_curtain(Triangles& to, float x, float side, float phase) {
  add_surface(to, 70, 70, [&](float u, float v) {
    const float folds = 0.18f * std::sin(u * 25 + v * 2) + 0.1f * std::sin(v * 13 + phase);
    return glm::vec3(x + (u - 0.5f) * 2.4f, side * 3.2f + folds, 4.8f - v * 3.6f);
  });
}

void add_ball(Triangles& to, const glm::vec3& center, float radius) {
  add_surface(to, 40, 20, [&](float u, float v) {
    const float a = u * kTurn, b = 0.5f * v * kTurn;
    return center +
           radius * glm::vec3(std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), std::cos(b));
  });
}

}  // namespace

RayScene atrium() {
  Triangles t;
  add_box(t, {-kHalfLength, -kHalfWidth, 0}, {kHalfLength, kHalfWidth, kHeight});
  for (float side : {-1.0f, 1.0f}) {
    add_colonnade(t, 0.0f, side);
    const float inner = side * 3.5f, outer = side * kHalfWidth;
    add_box(t, {-kHalfLength, std::min(inner, outer), 5.6f},
            {kHalfLength, std::max(inner, outer), 6.0f});
    add_colonnade(t, 6.0f, side);
    for (int i = 0; i < 5; ++i) add_curtain(t, -11.5f + i * 5.2f, side, 2 * i + (side > 0));
  }
  for (int i = 0; i < 6; ++i) add_ball(t, {-10.0f + 4 * i, (i % 3 - 1) * 1.5f, 0.7f}, 0.6f);
  return finish("atrium", std::move(t), {-11.0f, 0.4f, 2.2f}, {5.0f, -0.5f, 3.0f}, 1.2f);
}

RayScene box_room() {
  Triangles t;
  add_box(t, {-1, -1, 0}, {1, 1, 2});
  t.erase(t.begin() + 4, t.begin() + 6);  // the wall at y = -1: the camera looks in there
  const glm::vec3 x(0.25f, 0, 0), y(0, 0.25f, 0), lamp(0, 0, 1.98f);
  add_quad(t, lamp - x - y, lamp - x + y, lamp + x + y, lamp + x - y);
  const auto add_turned_box = [&](const glm::vec2& place, const glm::vec3& size, float angle) {
    Triangles box;
    add_box(box, {-size.x, -size.y, 0}, size);
    const glm::mat4 to_room =
        glm::rotate(glm::translate(glm::mat4(1), glm::vec3(place, 0)), angle, glm::vec3(0, 0, 1));
    const auto put = [&](const glm::vec3& p) { return glm::vec3(to_room * glm::vec4(p, 1)); };
    for (const TracedTriangle& f : box)
      t.push_back(make_triangle(put(corner(f, 0)), put(corner(f, 1)), put(corner(f, 2))));
  };
  add_turned_box({-0.35f, 0.35f}, {0.3f, 0.3f, 1.2f}, 0.3f);
  add_turned_box({0.35f, -0.3f}, {0.3f, 0.3f, 0.6f}, -0.3f);
  return finish("box_room", std::move(t), {0.05f, -3.2f, 1.07f}, {0, 0, 1}, 0.7f);
}

RayScene soup() {
  Triangles t;
  Random random(7);
  const glm::vec3 one(1.0f);
  const auto add = [&](float size) {
    const glm::vec3 center = random.in_box(-10.0f * one, 10.0f * one);
    const glm::vec3 a = random.in_box(-one, one), b = random.in_box(-one, one),
                    c = random.in_box(-one, one);
    t.push_back(make_triangle(center + size * a, center + size * b, center + size * c));
  };
  for (int i = 0; i < 50'000; ++i) add(0.04f);
  for (int i = 0; i < 8; ++i) add(20.0f);
  return finish("soup", std::move(t), {0, -14, 2}, {0, 0, 0}, 1.0f);
}

RayScene blob(float time) {
  Triangles t;
  add_surface(t, 400, 200, [&](float u, float v) {
    const float a = u * kTurn, b = 0.5f * v * kTurn;
    const float swell =
        1.0f + 0.2f * std::sin(3 * a + 2 * time) * std::sin(b) + 0.1f * std::sin(5 * b + 3 * time);
    const float twist = a + 1.5f * std::cos(b) * std::sin(time);
    return swell *
           glm::vec3(std::sin(b) * std::cos(twist), std::sin(b) * std::sin(twist), std::cos(b));
  });
  return finish("blob", std::move(t), {0.5f, -3.2f, 1.2f}, {0, 0, 0}, 0.8f);
}

RayScene grass() {
  Triangles t;
  Random random(11);
  add_quad(t, {-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0});
  for (int i = 0; i < 20'000; ++i) {
    const glm::vec3 root(random.between(-5, 5), random.between(-5, 5), 0);
    const float turn = random.between(0, kTurn), height = random.between(0.2f, 0.6f);
    const glm::vec3 across = (0.0025f * height) * glm::vec3(std::cos(turn), std::sin(turn), 0);
    const glm::vec3 tip =
        root + height * glm::vec3(random.between(-0.4f, 0.4f), random.between(-0.4f, 0.4f), 1);
    t.push_back(make_triangle(root - across, root + across, tip));
  }
  return finish("grass", std::move(t), {0, -5.5f, 1.2f}, {0, 0, 0.2f}, 1.0f);
}

namespace {

struct NamedScene {
  const char* name;
  RayScene (*make)();
};
constexpr NamedScene kScenes[] = {{"atrium", atrium},
                                  {"box_room", box_room},
                                  {"soup", soup},
                                  {"blob", [] { return blob(); }},
                                  {"grass", grass}};

}  // namespace

std::vector<std::string> generated_scene_names() {
  std::vector<std::string> names;
  for (const NamedScene& scene : kScenes) names.push_back(scene.name);
  return names;
}

RayScene generated_scene(const std::string& name) {
  for (const NamedScene& scene : kScenes)
    if (name == scene.name) return scene.make();
  fail("there is no generated scene '{}': choose one of {}", name,
       fmt::join(generated_scene_names(), ", "));
}

}  // namespace panoptes::test
