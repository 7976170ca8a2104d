// Which surface each pixel shows: ids, bins, attributes and awkward geometry.
#include "gl/counters.h"
#include "support.h"

#include <cmath>
#include <numeric>
#include <random>

namespace panoptes::test {
namespace {

using film::Pass;

// Exact in half floats, and different for the first 4096 numbers.
glm::vec3 number_color(int i) { return glm::vec3(i % 16, i / 16 % 16, i / 256 % 16) / 16.0f; }

glm::mat4 placed(const glm::vec3& at, const glm::vec3& scale = glm::vec3(1)) {
  return {glm::vec4(scale.x, 0, 0, 0), glm::vec4(0, scale.y, 0, 0), glm::vec4(0, 0, scale.z, 0),
          glm::vec4(at, 1)};
}

// Thirty-two by thirty-two cells of two by two pixels each.
const gpu_scene::Camera kGrid = orthographic({0, 0, 5}, {0, 0, 0}, 16, 64, 64);
glm::vec3 cell_center(int i) { return {float(i % 32) - 15.5f, float(i / 32) - 15.5f, 0}; }

void expect_cells(const Picture& p, const std::vector<int>& colors) {
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      ASSERT_EQ(p.rgb(Pass::kDiffCol, x, y),
                glm::dvec3(number_color(colors[size_t(y / 2 * 32 + x / 2)])))
          << x << " " << y;
}

TEST(GBuffer, AThousandInstancesOfHundredsOfMaterialsKeepTheirColours) {
  TestScene s;
  const int materials = 320;
  for (int i = 0; i < materials; ++i) s.add_material(lambert(number_color(i)));
  // Two triangles in two slots: the material of a pixel depends on its instance and its triangle.
  Geometry cell = floor_at(0, 0.5f);
  cell.slots = {1, 0};
  s.meshes = {cell.mesh()};
  for (int i = 0; i < 1024; ++i)
    s.add_instance(1, {1 + i % materials, 1 + (i * 7 + 3) % materials}, placed(cell_center(i)));
  const int64_t programs = gl::counters().programs;
  const Picture p = render(s, request(kGrid, {Pass::kDiffCol}));
  // Materials of one text share their programs: two passes of ours, not hundreds.
  EXPECT_LT(gl::counters().programs, programs + 12);
  for (int i = 0; i < 1024; ++i) {
    const int x = i % 32 * 2, y = i / 32 * 2;
    // The diagonal runs from the lower left to the upper right: (1, 0) is below it, (0, 1) above.
    ASSERT_EQ(p.rgb(Pass::kDiffCol, x + 1, y), glm::dvec3(number_color((i * 7 + 3) % materials)))
        << i;
    ASSERT_EQ(p.rgb(Pass::kDiffCol, x, y + 1), glm::dvec3(number_color(i % materials))) << i;
  }
}

TEST(GBuffer, HundredsOfSlotsInOneMeshKeepTheirColours) {
  TestScene s;
  std::vector<Id> slots;
  for (int i = 0; i < 500; ++i) slots.push_back(s.add_material(lambert(number_color(i))));
  std::vector<int> order(1024);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(5));  // slots are sorted by make_mesh
  Geometry grid;
  std::vector<int> colors(1024);
  for (int i : order) {
    colors[size_t(i)] = (i * 31) % 500;
    grid.add(quad(cell_center(i), {0.5f, 0, 0}, {0, 0.5f, 0}), colors[size_t(i)]);
  }
  s.add_object(grid, slots);
  // A second mesh before the camera's back: its ids must not leak into the first one's.
  s.add_object(floor_at(50, 1), {slots[7]});
  expect_cells(render(s, request(kGrid, {Pass::kDiffCol})), colors);
}

TEST(GBuffer, AttributesAreThoseOfTheCorner) {
  // Emission (u, v of "a", u of "b"); the names' order differs between two materials.
  const char* code = "void evaluate_material(const Hit hit, inout Surface surface) {\n"
                     "  closure_emission(surface, vec3(1.0), vec3(hit_uv(hit, ATTRIBUTE(0)),\n"
                     "                                            hit_uv(hit, ATTRIBUTE(1)).x));\n"
                     "}\n";
  Geometry g = floor_at(0, 1);
  g.uv = {0, 0, 1, 0, 1, 2, 0, 2};
  const std::vector<float> other{5, 9, 5, 9, 7, 9, 7, 9};
  scene::MeshInput in = g.input();
  in.attributes[0].name = "a";
  in.attributes.push_back({"b", 2, other});
  in.default_uv = "a";
  TestScene s;
  s.meshes.push_back(scene::make_mesh(in));
  scene::Material ab = material(code, {}, {.emission = true, .glossy = false}), ba = ab;
  ab.attributes = {"a", "b"};
  ba.attributes = {"b", "a"};
  const Id first = s.add_material(ab), second = s.add_material(ba);
  s.add_instance(1, {first}, placed({-1, 0, 0}));
  s.add_instance(1, {second}, placed({1, 0, 0}));
  const gpu_scene::Camera camera = orthographic({0, 0, 3}, {0, 0, 0}, 1, 32, 16);
  const Picture p = render(s, request(camera, {Pass::kEmit}));
  Worst worst;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 32; ++x) {
      const double u = (x % 16 + 0.5) / 16, v = 2 * (y + 0.5) / 16, b = 5 + v;
      const glm::dvec3 due = x < 16 ? glm::dvec3(u, v, b) : glm::dvec3(b, 9, u);
      for (int c = 0; c < 3; ++c) worst.compare(p.value(Pass::kEmit, x, y, c), due[c], 1, x, y);
    }
  EXPECT_WORST_BELOW(worst, 1e-5);
}

TEST(GBuffer, AbsentAttributesAreBlack) {
  scene::Material m = material(
      "void evaluate_material(const Hit hit, inout Surface surface) {\n"
      "  vec4 color = hit_color(hit, ATTRIBUTE(1));\n"
      "  closure_emission(surface, vec3(1.0), vec3(hit_uv(hit, ATTRIBUTE(0)) + vec2(1.0),\n"
      "                                            color.a + color.r));\n"
      "}\n",
      {}, {.emission = true, .glossy = false});
  m.attributes = {"no such map", "no such colour"};
  TestScene s;
  s.add_object(floor_at(0, 1), {s.add_material(m)});
  const Picture p =
      render(s, request(orthographic({0, 0, 3}, {0, 0, 0}, 0.5, 4, 4), {Pass::kEmit}));
  EXPECT_EQ(p.rgb(Pass::kEmit, 2, 2), glm::dvec3(1, 1, 0));
}

TEST(GBuffer, ColoursHaveFourChannels) {
  Geometry g = floor_at(0, 1);
  g.color = {0, 0, 0, 1, 1, 0, 0, 1, 1, 1, 0, 1, 0, 1, 0, 1};
  TestScene s;
  s.add_object(g, {s.add_material(material(
                      "void evaluate_material(const Hit hit, inout Surface surface) {\n"
                      "  closure_emission(surface, vec3(1.0), hit_color(hit, COLOR_DEFAULT).rga);\n"
                      "}\n",
                      {}, {.emission = true, .glossy = false}))});
  const Picture p =
      render(s, request(orthographic({0, 0, 3}, {0, 0, 0}, 1, 16, 16), {Pass::kEmit}));
  for (int i = 0; i < 16; ++i) {
    EXPECT_NEAR(p.value(Pass::kEmit, i, 5, 0), (i + 0.5) / 16, 1e-5);
    EXPECT_NEAR(p.value(Pass::kEmit, 5, i, 1), (i + 0.5) / 16, 1e-5);
    EXPECT_EQ(p.value(Pass::kEmit, 5, i, 2), 1);
  }
}

TEST(GBuffer, PositionsAreKnownInEverySpace) {
  const glm::vec3 at(100, -50, 25);
  for (int space = 0; space < 3; ++space) {
    const char* calls[] = {"hit_world_position(hit)", "hit_object_position(hit)",
                           "hit_generated(hit)"};
    TestScene s;
    s.add_object(box({1, 2, 3}, {0.5f, 1, 2}),
                 {s.add_material(material(
                     fmt::format("void evaluate_material(const Hit hit, inout Surface surface) {{\n"
                                 "  closure_emission(surface, vec3(1.0), {});\n}}\n",
                                 calls[space]),
                     {}, {.emission = true, .glossy = false}))},
                 placed(at, {2, 1, 1}));
    const glm::dvec3 top = glm::dvec3(at) + glm::dvec3(2, 2, 5);
    const gpu_scene::Camera camera = orthographic(top + glm::dvec3(0, 0, 3), top, 0.8, 8, 8);
    const Picture p = render(s, request(camera, {Pass::kEmit}));
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) {
        const glm::dvec3 world = on_plane(pixel_ray(camera, x, y), top, {0, 0, 1});
        const glm::dvec3 object = (world - glm::dvec3(at)) / glm::dvec3(2, 1, 1);
        const glm::dvec3 generated = (object - glm::dvec3(0.5, 1, 1)) / glm::dvec3(1, 2, 4);
        const glm::dvec3 due = space == 0 ? world : space == 1 ? object : generated;
        EXPECT_LT(glm::length(p.rgb(Pass::kEmit, x, y) - due), space == 0 ? 3e-5 : 1e-5)
            << calls[space];
      }
  }
}

TEST(GBuffer, MirroredInstancesShowTheirFaces) {
  TestScene s;
  const Id white = s.add_material(lambert());
  const Id mesh = s.add_object(sphere({0, 0, 0}, 1, 32), {white}, placed({-1.5f, 0, 0}));
  s.add_instance(mesh, {white}, placed({1.5f, 0, 0}, {-1, 1, 1}));
  s.lights = {sun({0, 0.5f, -1}, float(kPi))};  // symmetric to the mirror
  const gpu_scene::Camera camera = orthographic({0, 0, 5}, {0, 0, 0}, 1.2, 64, 24);
  const Picture p = render(s, request(camera, {Pass::kDiffDir, Pass::kNormal}));
  Worst light;
  int lit = 0;
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 32; ++x) {
      light.compare(p.value(Pass::kDiffDir, 63 - x, y), p.value(Pass::kDiffDir, x, y), 0.1, x, y);
      EXPECT_NEAR(p.value(Pass::kNormal, 63 - x, y, 0), -p.value(Pass::kNormal, x, y, 0), 2e-4);
      lit += p.value(Pass::kDiffDir, x, y) > 0.5;
    }
  EXPECT_GT(lit, 100);
  EXPECT_WORST_BELOW(light, 2e-3);
}

TEST(GBuffer, FlatAndEmptyMatricesDoNoHarm) {
  for (const glm::vec3& scale : {glm::vec3(1, 1, 0), glm::vec3(0, 1, 1), glm::vec3(0, 0, 1),
                                 glm::vec3(0), glm::vec3(1e-30f), glm::vec3(1, 1, -1e-20f)}) {
    TestScene s;
    const Id white = s.add_material(lambert());
    const Id mesh =
        s.add_object(box({0, 0, 0}, glm::vec3(0.5f)), {white}, placed({0, 0, 0}, scale));
    s.add_instance(mesh, {white}, placed({0, 0, -2}, glm::vec3(4)));
    s.lights = {sun({0, 0, -1}, float(kPi)), point({3, 3, 3}, 100)};
    const gpu_scene::Camera camera = perspective({0, 0, 5}, {0, 0, 0}, 0.3, 16, 16);
    const Picture p = render(s, request(camera, {Pass::kDiffDir, Pass::kDepth, Pass::kNormal}));
    if (scale == glm::vec3(1, 1, 0)) {  // a flat square that faces up, lit as such
      EXPECT_NEAR(p.value(Pass::kDepth, 8, 8), 5, 1e-5);
      EXPECT_EQ(p.rgb(Pass::kNormal, 8, 8), glm::dvec3(0, 0, 1));
      EXPECT_GT(p.value(Pass::kDiffDir, 8, 8), 1);
    } else if (scale != glm::vec3(1, 1, -1e-20f)) {
      EXPECT_NEAR(p.value(Pass::kDepth, 1, 1), 5, 1e-4) << "the large box behind is seen";
    }
  }
}

TEST(GBuffer, DegenerateTrianglesShowNothing) {
  TestScene s;
  Geometry g = floor_at(0, 1);
  Geometry point_like = floor_at(1, 0), line = quad({0, 0, 1}, {1, 0, 0}, {0, 0, 0});
  Geometry twice = floor_at(1, 1);
  twice.triangles = {{0, 0, 1}, {2, 2, 2}};
  for (glm::vec3& n : point_like.normals) n = glm::vec3(0);  // Blender gives such faces no normal
  g.add(point_like).add(line).add(twice);
  s.add_object(g, {s.add_material(lambert({0.5f, 0.25f, 1}))});
  s.lights = {point({0, 0, 3}, 10)};
  const Picture p = render(s, request(orthographic({0, 0, 5}, {0, 0, 0}, 0.9, 24, 24),
                                      {Pass::kDiffCol, Pass::kDepth, Pass::kDiffDir}));
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 24; ++x) {
      EXPECT_EQ(p.rgb(Pass::kDiffCol, x, y), glm::dvec3(0.5, 0.25, 1));
      EXPECT_NEAR(p.value(Pass::kDepth, x, y), 5, 1e-5);
    }
}

TEST(GBuffer, SliversAreCoveredWithoutHoles) {
  // A square cut into a fan of 500 slivers that all meet in one corner.
  Geometry fan;
  const int n = 500;
  fan.positions.push_back({-1, -1, 0});
  for (int i = 0; i <= n; ++i) fan.positions.push_back({1, -1 + 2.0f * float(i) / n, 0});
  for (int i = 0; i <= n; ++i) fan.positions.push_back({1 - 2.0f * float(i) / n, 1, 0});
  fan.normals.assign(fan.positions.size(), {0, 0, 1});
  fan.uv.assign(2 * fan.positions.size(), 0);
  for (int i = 1; i + 1 < int(fan.positions.size()); ++i) {
    fan.triangles.push_back({0, i, i + 1});
    fan.loops.push_back({0, i, i + 1});
    fan.slots.push_back(0);
  }
  TestScene s;
  s.add_object(fan, {s.add_material(lambert())});
  s.lights = {sun({0, 0, -1}, float(kPi))};
  const gpu_scene::Camera camera = orthographic({0, 0, 5}, {0, 0, 0}, 0.99, 64, 64);
  const Picture p = render(s, request(camera, {Pass::kDiffDir, Pass::kDepth}));
  Worst light, depth;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      light.compare(p.value(Pass::kDiffDir, x, y), 1, 1, x, y);
      depth.compare(p.value(Pass::kDepth, x, y), 5, 1, x, y);
    }
  EXPECT_WORST_BELOW(light, 1e-5);
  EXPECT_WORST_BELOW(depth, 1e-5);
}

TEST(GBuffer, CoplanarLayersAreStable) {
  // Which of two equal surfaces wins is nobody's business, but it must not change between frames.
  TestScene s;
  s.add_object(floor_at(0, 1), {s.add_material(lambert({1, 0, 0}))});
  s.add_object(floor_at(0, 1), {s.add_material(lambert({0, 1, 0}))});
  s.lights = {point({0.5f, 0, 2}, 10)};
  const engine::RenderRequest r =
      request(perspective({1, -2, 3}, {0, 0, 0}, 0.5, 32, 32), {Pass::kDiffCol, Pass::kDiffDir});
  const Picture a = render(s, r), b = render(r), c = render(s, r);
  EXPECT_EQ(a[Pass::kDiffCol], b[Pass::kDiffCol]);
  EXPECT_EQ(a[Pass::kDiffCol], c[Pass::kDiffCol]);
  EXPECT_EQ(a[Pass::kDiffDir], c[Pass::kDiffDir]);
}

TEST(GBuffer, AHundredThousandTrianglesInOnePixel) {
  Geometry dust;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-1e-3f, 1e-3f);
  for (int i = 0; i < 100000; ++i) {
    const int first = 3 * i;
    for (int k = 0; k < 3; ++k) {
      dust.positions.push_back({uniform(random), uniform(random), uniform(random)});
      dust.normals.push_back({0, 0, 1});
    }
    dust.triangles.push_back({first, first + 1, first + 2});
    dust.loops.push_back({first, first + 1, first + 2});
    dust.slots.push_back(0);
  }
  TestScene s;
  const Id white = s.add_material(lambert());
  s.add_object(floor_at(-0.5f, 1), {white});
  s.add_object(dust, {white});
  s.lights = {sun({0.2f, 0, -1}, 1)};
  const Picture p =
      render(s, request(orthographic({0, 0, 5}, {0, 0, 0}, 0.5, 15, 15), {Pass::kDepth}));
  EXPECT_NEAR(p.value(Pass::kDepth, 7, 7), 5, 2e-3);
  EXPECT_NEAR(p.value(Pass::kDepth, 2, 2), 5.5, 1e-5);
}

}  // namespace
}  // namespace panoptes::test
