// Hard scenes for paths: finite everywhere, the same picture twice, near to what is due.
#include "still_life.h"
#include "support.h"

#include <cmath>
#include <limits>

namespace panoptes::test {
namespace {

using film::Pass;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

engine::RenderRequest paths(const gpu_scene::Camera& camera, uint32_t samples) {
  engine::RenderRequest r = request(camera, {Pass::kDiffDir, Pass::kGlossInd, Pass::kAo}, samples);
  r.method = engine::Method::kPrimitive;
  return r;
}

// Renders twice; render() itself expects all values to be finite.
Picture twice(const TestScene& s, const engine::RenderRequest& r, const std::string& label) {
  const Picture first = render(s, r);
  EXPECT_TRUE(render(s, r)[Pass::kCombined] == first[Pass::kCombined]) << label;
  return first;
}

// Of Combined's colours.
double mean_rgb(const Picture& p) {
  const std::vector<float>& rgba = p[Pass::kCombined];
  double sum = 0;
  for (size_t i = 0; i < rgba.size(); ++i) sum += i % 4 == 3 ? 0 : rgba[i];
  return sum / (0.75 * double(rgba.size()));
}

TEST(PathHardCases, ScalesAndFarOrigins) {
  const StillLife life = still_life(1, {0, 0, 0}, 24);
  const double due = mean(render(life.scene, paths(life.camera, 64))[Pass::kCombined]);
  // 1.5 % is what another rounding, and with it other paths, may change of a mean over 24 x 24
  // pixels and 64 samples.
  for (float scale : {1e-3f, 1e3f}) {
    const StillLife other = still_life(scale, {0, 0, 0}, 24);
    EXPECT_NEAR(mean(twice(other.scene, paths(other.camera, 64), "scale")[Pass::kCombined]) / due, 1,
                0.015)
        << "scale " << scale;
  }
  const StillLife far = still_life(1, {-1048576, 1048576, 524288}, 24);
  EXPECT_NEAR(mean(twice(far.scene, paths(far.camera, 64), "far")[Pass::kCombined]) / due, 1, 0.015);
}

TEST(PathHardCases, BrokenNumbersInTheScene) {
  const StillLife life = still_life(1, {0, 0, 0}, 16);
  for (float broken : {kNaN, kInf, 3e38f}) {
    TestScene s = life.scene;
    Geometry g = box({0, 0, 1}, glm::vec3(0.5f));
    g.positions[0].x = broken;
    for (glm::vec3& n : g.normals) n.y = broken;
    for (float& uv : g.uv) uv = broken;
    s.add_object(g, {1});
    s.lights.push_back(point({0, 0, broken}, 10));
    s.lights.push_back(point({0, 0, 3}, broken));
    s.materials.push_back(lambert(glm::vec3(broken)));
    s.materials.push_back(emitter(glm::vec3(broken)));
    s.add_object(floor_at(1.5f, 0.5f), {3});
    s.add_object(floor_at(2.5f, 0.5f), {4});
    twice(s, paths(life.camera, 4), fmt::format("{}", broken));
  }
}

TEST(PathHardCases, ExtremeMaterials) {
  const char* const codes[] = {
      "closure_glass(hit, surface, vec3(1.0), vec3(1.0), 0.0, 1.0, hit.normal);",
      "closure_glass(hit, surface, vec3(1.0), vec3(1.0), 0.0179, 1.0001, hit.normal);",
      "closure_glass(hit, surface, vec3(1.0), vec3(1.0), 1.0, 1000.0, hit.normal);",
      "closure_glass(hit, surface, vec3(1.0), vec3(0.0), 0.5, 0.0, hit.normal);",
      "closure_refraction(hit, surface, vec3(1.0), vec3(1.0), 0.3, -2.0, hit.normal);",
      "closure_glossy(surface, vec3(1.0), vec3(1.0), 0.0, -hit.normal);",
      "closure_glossy(surface, vec3(1.0), vec3(1.0), 1.0e-6, vec3(0.0));",
      "closure_diffuse(surface, vec3(1.0), vec3(1.0), 1.0, normalize(vec3(1.0, 0.0, -0.2)));",
      "closure_velvet(surface, vec3(1.0), vec3(1.0), 1.0e-3, hit.normal);",
      "Principled p = principled_defaults(hit); p.roughness = 0.0; p.metallic = 1.0; p.coat = 1.0;\n"
      "p.transmission = 0.5; p.sheen = 1.0; p.ior = 1.0;\n"
      "closure_principled_v3(surface, vec3(1.0), p);"};
  for (const char* code : codes) {
    TestScene s;
    const Id id = s.add_material(
        material(std::string("void evaluate_material(const Hit hit, inout Surface surface) {\n") +
                     code + "\n}\n",
                 {}, {.glossy = true, .transmission = true, .layers = true}));
    s.add_object(sphere({0, 0, 0}, 0.7f, 12), {id});
    s.add_object(floor_at(-0.8f, 3), {id});
    s.world = constant_world(glm::vec3(1));
    s.lights = {area({0, -1, 2}, {0, 0, -1}, 30, scene::AreaShape::kSquare, 1, 1)};
    const Picture p = twice(s, paths(perspective({0, -4, 0.5}, {0, 0, 0}, 0.5, 16, 16), 8), code);
    EXPECT_GE(mean(p[Pass::kCombined]), 0) << code;
  }
}

TEST(PathHardCases, CamerasAndLightsWhereSurfacesAre) {
  TestScene s;
  const Id white = s.add_material(lambert());
  s.add_object(floor_at(0, 3), {white});
  s.add_object(box({0, 0, 0}, glm::vec3(1)), {white});
  // On a face, on an edge, inside; with and without an extent.
  for (const glm::vec3& place : {glm::vec3(0, 0, 1), glm::vec3(1, 0, 1), glm::vec3(0, 0, 0.5f)})
    for (float radius : {0.0f, 0.5f}) {
      s.lights = {point(place, 10, radius), area(place, {0, 0, -1}, 10, scene::AreaShape::kDisk,
                                                radius, radius)};
      twice(s, paths(perspective({2, -4, 2}, {0, 0, 0.5}, 0.6, 16, 16), 4), "light on a surface");
    }
  for (const glm::dvec3& eye : {glm::dvec3(0, 0, 0.5), glm::dvec3(0, 0, 1), glm::dvec3(1, 1, 1)})
    twice(s, paths(perspective(eye, eye + glm::dvec3(0.3, 1, 0.1), 1, 16, 16), 4), "camera on a surface");
}

TEST(PathHardCases, ViewsSizesAndEmptyScenes) {
  const StillLife life = still_life();
  for (const auto& [w, h] : {std::pair(1, 1), {3, 1}, {17, 13}}) {
    engine::RenderRequest r = paths(life.camera, 2);
    r.camera.width = w;
    r.camera.height = h;
    EXPECT_EQ(twice(life.scene, r, "size")[Pass::kCombined].size(), size_t(w * h * 4));
  }
  for (double degrees : {1.0, 179.0})
    twice(life.scene, paths(perspective({0, -5, 3}, {0, 0, 0.5}, degrees * kPi / 180, 16, 16), 2), "angle");
  twice(life.scene, paths(orthographic({0, -5, 3}, {0, 0, 0.5}, 2, 16, 16), 2), "orthographic");
  TestScene nothing;
  EXPECT_EQ(mean_rgb(twice(nothing, paths(life.camera, 2), "empty")), 0);
  nothing.world = constant_world(glm::vec3(0.5f));
  EXPECT_NEAR(mean_rgb(twice(nothing, paths(life.camera, 2), "sky")), 0.5, 1e-6);
  TestScene triangle;
  Geometry one;
  one.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
  one.triangles = one.loops = {{0, 1, 2}};
  one.slots = {0};
  one.normals.assign(3, {0, -1, 0});
  one.uv.assign(6, 0);
  triangle.add_object(one, {triangle.add_material(lambert())});
  triangle.world = nothing.world;
  twice(triangle, paths(life.camera, 2), "one triangle");
}

TEST(PathHardCases, SunsInSkiesAndManyLamps) {
  TestScene s;
  s.add_object(floor_at(0, 3), {s.add_material(lambert())});
  // A sun of half a degree in an otherwise dim sky: irradiance 2 from straight above.
  s.world = world("vec3 evaluate_world(vec3 d) {\n"
                  "  return vec3(d.z > 0.99996 ? 7957.7 : 0.1);\n"
                  "}\n");
  const gpu_scene::Camera camera = perspective({0, -2, 3}, {0, 0, 0}, 0.3, 16, 16);
  const double lit = mean_rgb(twice(s, paths(camera, 64), "sun in a sky"));
  EXPECT_NEAR(lit, 2 / kPi + 0.1, 0.03);
  s.world = scene::World();
  for (int i = 0; i < 2000; ++i)
    s.lights.push_back(point({float(i % 50) * 0.1f - 2.5f, float(i / 50) * 0.1f - 2, 0.5f}, 0.01f));
  EXPECT_GT(mean_rgb(twice(s, paths(camera, 4), "2000 lamps")), 0);
}

}  // namespace
}  // namespace panoptes::test
