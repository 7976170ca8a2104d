// The list of triangles that rays meet: it is the scene, transformed, and written when that changes.
#include "gl/context.h"
#include "gl/counters.h"
#include "still_life.h"
#include "tracing/triangle_list.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <limits>

namespace panoptes::test {
namespace {

using shared::TracedTriangle;

class TriangleLists : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { context = std::make_unique<gl::Context>(); }
  static void TearDownTestSuite() { context.reset(); }

  TriangleLists() : gpu(context->device()), timer(context->device()), list(context->device()) {}

  bool update() {
    gpu.update(scene);
    return list.update(scene, gpu, programs, timer);
  }
  std::vector<TracedTriangle> flatten(const TestScene& setup) {
    setup.install(scene);
    update();
    EXPECT_NO_THROW(gl::check_errors("flatten"));
    return list.read();
  }

  static inline std::unique_ptr<gl::Context> context;
  scene::Scene scene;
  gpu_scene::GpuScene gpu;
  gl::ProgramCache programs;
  gl::PassTimer timer;
  tracing::TriangleList list;
};

std::array<glm::vec3, 3> corners(const TracedTriangle& t) {
  return {glm::vec3(t.x0, t.y0, t.z0), {t.x1, t.y1, t.z1}, {t.x2, t.y2, t.z2}};
}

// What the list must hold, by the same operations in the same order.
std::vector<TracedTriangle> transformed(const scene::Scene& scene, const gpu_scene::GpuScene& gpu,
                                        const glm::vec3& origin) {
  std::vector<TracedTriangle> all;
  for (size_t i = 0; i < scene.instances().size(); ++i) {
    const scene::Instance& instance = scene.instances()[i];
    const scene::Mesh* mesh = scene.mesh_of(instance);
    if (!mesh) continue;
    const glm::mat4& m = instance.object_to_world;
    const glm::vec3 translation = glm::vec3(m[3]) - origin;
    for (const scene::MaterialRange& range : mesh->ranges)
      for (uint32_t t = range.first; t < range.first + range.count; ++t) {
        TracedTriangle triangle{};
        float* const places[3] = {&triangle.x0, &triangle.x1, &triangle.x2};
        for (int k = 0; k < 3; ++k) {
          const glm::vec3 p = mesh->positions[mesh->triangles[t][k]];
          for (int axis = 0; axis < 3; ++axis)
            places[k][axis] =
                m[0][axis] * p.x + m[1][axis] * p.y + m[2][axis] * p.z + translation[axis];
        }
        const uint32_t material = gpu.material_index(scene.material_of(instance, range.slot));
        triangle.instance = gpu.place_of(i);
        triangle.triangle = t;
        triangle.flags =
            instance.visibility | material << shared::TRIANGLE_MATERIAL_SHIFT |
            (gpu.materials()[material].facts.alpha ? shared::TRIANGLE_HAS_ALPHA : 0);
        all.push_back(triangle);
      }
  }
  return all;
}

size_t differences(const std::vector<TracedTriangle>& a, const std::vector<TracedTriangle>& b) {
  size_t count = 0;
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    count += std::memcmp(&a[i], &b[i], sizeof a[i]) != 0;
  return count;
}

void expect_within(const std::vector<TracedTriangle>& triangles, const scene::Bounds& bounds) {
  scene::Bounds exact;
  for (const TracedTriangle& t : triangles)
    if (t.flags & shared::TRIANGLE_SEEN_BY)
      for (const glm::vec3& p : corners(t)) exact.add(p);
  EXPECT_EQ(exact, bounds);
}

TestScene with_something_of_everything() {
  TestScene s = still_life().scene;
  Geometry two_slots = quad({0, 0, 2}, {1, 0.25f, 0}, {0, 1, 0.3f});
  two_slots.add(sphere({0.3f, 0.2f, 3}, 0.7f, 12, true), 1);
  s.add_object(two_slots, {1, s.add_material(alpha_card({1, 1, 1, 0.5f}))},
               glm::rotate(glm::mat4(1.0f), 0.7f, {0.3f, 0.5f, 0.8f}));
  // Mirrored, flat, and from a slot without a material.
  s.add_instance(4, {2, 1}, glm::scale(glm::mat4(1.0f), {-1.3f, 0.7f, 2.1f}));
  s.add_instance(4, {2, 1}, glm::scale(glm::mat4(1.0f), {1.0f, 1.0f, 0.0f}));
  s.instances.push_back({4, glm::translate(glm::mat4(1.0f), {5.0f, 1.7f, 0.1f}), 1000});
  return s;
}

TEST_F(TriangleLists, HoldTheTransformedScene) {
  const std::vector<TracedTriangle> triangles = flatten(with_something_of_everything());
  const std::vector<TracedTriangle> due = transformed(scene, gpu, list.origin());
  ASSERT_EQ(triangles.size(), due.size());
  EXPECT_EQ(list.count(), due.size());
  EXPECT_EQ(differences(triangles, due), 0u);
  EXPECT_EQ(list.lost(), 0u);
  expect_within(triangles, list.bounds());
  const scene::Bounds world = scene.bounds();
  EXPECT_EQ(list.origin(), 0.5f * world.low + 0.5f * world.high);
}

TEST_F(TriangleLists, LoseNothingFarFromTheOrigin) {
  // Coordinates on a grid of 1/8 and places on one of 1/2: all exact, wherever the scene lies.
  const glm::vec3 far_away(1048576.5f, -1048577.0f, 1048578.5f);
  TestScene near, distant;
  for (TestScene* s : {&near, &distant}) {
    const glm::vec3 place = s == &distant ? far_away : glm::vec3(0);
    for (float x : {-3.0f, 1.0f, 3.0f})
      s->add_object(box({0.125f, 0, 0.25f}, {1, 0.5f, 0.375f}), {},
                    glm::translate(glm::mat4(1.0f), place + glm::vec3(x, 0.5f, 0)));
  }
  const std::vector<TracedTriangle> here = flatten(near);
  const glm::vec3 near_origin = list.origin();
  const std::vector<TracedTriangle> there = flatten(distant);
  ASSERT_EQ(here.size(), there.size());
  for (size_t i = 0; i < here.size(); ++i)
    for (size_t k = 0; k < 3; ++k) {
      const glm::vec3 a = corners(here[i])[k] + near_origin;
      const glm::dvec3 b = glm::dvec3(corners(there[i])[k]) + glm::dvec3(list.origin());
      EXPECT_EQ(glm::dvec3(a) + glm::dvec3(far_away), b);
    }
  expect_within(there, list.bounds());
}

TEST_F(TriangleLists, GiveSharedVerticesTheSameBits) {
  // An indexed grid under a matrix that rounds everywhere.
  Geometry g;
  constexpr int kSide = 40;
  for (int y = 0; y <= kSide; ++y)
    for (int x = 0; x <= kSide; ++x)
      g.positions.push_back({0.1f * float(x), 0.1f * float(y), std::sin(float(x * y))});
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const int a = y * (kSide + 1) + x, b = a + 1, c = a + kSide + 1, d = c + 1;
      g.triangles.insert(g.triangles.end(), {{a, b, d}, {d, c, a}});
    }
  g.loops.assign(g.triangles.size(), {0, 0, 0});
  g.slots.assign(g.triangles.size(), 0);
  g.normals = {{0, 0, 1}};
  TestScene s;
  s.add_object(g, {}, glm::rotate(glm::translate(glm::mat4(1.0f), {0.3f, 7.1f, -2.7f}), 1.1f,
                                  {0.2f, 0.7f, 0.4f}));
  const std::vector<TracedTriangle> triangles = flatten(s);
  const scene::Mesh& mesh = s.meshes[0];
  std::map<uint32_t, glm::vec3> seen;
  size_t shared_vertices = 0, different = 0;
  for (const TracedTriangle& t : triangles)
    for (int k = 0; k < 3; ++k) {
      const glm::vec3 p = corners(t)[size_t(k)];
      const auto [it, fresh] = seen.try_emplace(mesh.triangles[t.triangle][k], p);
      shared_vertices += !fresh;
      different += it->second != p;
    }
  EXPECT_GT(shared_vertices, 3u * kSide * kSide);
  EXPECT_EQ(different, 0u);
}

TEST_F(TriangleLists, SayWhoSeesATriangle) {
  TestScene s;
  s.add_object(floor_at(0, 1), {});
  for (uint32_t visibility : {0u, uint32_t(shared::SEEN_BY_SHADOW), 21u}) {
    s.add_instance(1, {}, glm::mat4(1.0f));
    s.instances.back().visibility = visibility;
  }
  s.instances.push_back({});  // without a mesh
  const std::vector<TracedTriangle> triangles = flatten(s);
  std::vector<uint32_t> visibility;
  for (const TracedTriangle& t : triangles)
    visibility.push_back(t.flags & shared::TRIANGLE_SEEN_BY);
  EXPECT_EQ(visibility, (std::vector<uint32_t>{63, 63, 32, 32, 21, 21}));
}

TEST_F(TriangleLists, ShowNobodyWhatIsNotFinite) {
  TestScene s;
  s.add_object(floor_at(0, 1), {});
  const float infinite = std::numeric_limits<float>::infinity();
  // Left out by the scene; and two whose products overflow, in part or throughout.
  s.add_instance(1, {}, glm::translate(glm::mat4(1.0f), {infinite, 0, 0}));
  s.add_instance(1, {}, glm::scale(glm::mat4(1.0f), glm::vec3(3e38f)) *
                            glm::translate(glm::mat4(1.0f), {1.0f, 1.0f, 0.0f}));
  Geometry wild = floor_at(1, 1);
  wild.positions[3].x = -1e30f;  // of the second triangle alone
  s.add_object(wild, {});
  const std::vector<TracedTriangle> triangles = flatten(s);
  ASSERT_EQ(triangles.size(), 6u);
  std::vector<bool> met;
  for (const TracedTriangle& t : triangles) {
    met.push_back(t.flags & shared::TRIANGLE_SEEN_BY);
    for (const glm::vec3& p : corners(t))
      for (int axis = 0; axis < 3; ++axis) EXPECT_TRUE(std::isfinite(p[axis]));
  }
  EXPECT_EQ(met, (std::vector<bool>{true, true, false, false, true, false}));
  EXPECT_EQ(list.lost(), 3u);
  EXPECT_EQ(list.origin(), glm::vec3(0));
  expect_within(triangles, list.bounds());
}

TEST_F(TriangleLists, OfNothingAreEmpty) {
  EXPECT_TRUE(flatten({}).empty());
  EXPECT_EQ(list.origin(), glm::vec3(0));
  EXPECT_TRUE(list.bounds().empty());
}

TEST_F(TriangleLists, HoldTenThousandInstances) {
  TestScene s;
  s.add_object(box({0, 0, 0}, glm::vec3(0.3f)), {s.add_material(lambert())});
  s.instances.clear();
  for (int i = 0; i < 10'000; ++i)
    s.instances.push_back({1, glm::translate(glm::mat4(1.0f), {float(i % 100), float(i / 100), 0.1f}),
                           0});
  const std::vector<TracedTriangle> triangles = flatten(s);
  const std::vector<TracedTriangle> due = transformed(scene, gpu, list.origin());
  ASSERT_EQ(triangles.size(), due.size());
  EXPECT_EQ(differences(triangles, due), 0u);
  expect_within(triangles, list.bounds());
}

// --- when the list is written ----------------------------------------------------------------------

TEST_F(TriangleLists, RestWithTheGeometry) {
  flatten(with_something_of_everything());
  const auto expect_rest = [&](const char* what) {
    gpu.update(scene);  // has uploads of its own
    const int64_t uploads = gl::counters().uploads, bytes = gl::counters().memory_bytes,
                  compiled = gl::counters().programs;
    timer.reset();
    EXPECT_FALSE(list.update(scene, gpu, programs, timer)) << what;
    EXPECT_EQ(gl::counters().uploads, uploads) << what;
    EXPECT_EQ(gl::counters().memory_bytes, bytes) << what;
    EXPECT_EQ(gl::counters().programs, compiled) << what;
    EXPECT_TRUE(timer.times().empty()) << what;
  };
  expect_rest("nothing has changed");
  scene.set_lights({sun({0, 0, -1}, 1)});
  expect_rest("a lamp");
  scene.set_world(constant_world(glm::vec3(1)));
  expect_rest("the world");
  scene.set_material_params(1, {glm::vec4(0.5f)});
  expect_rest("a colour");
  scene.set_material(1, emitter(glm::vec3(1)));
  expect_rest("a material's nodes");
  scene::Mesh shaded = scene.meshes().at(1);
  shaded.corner_normals[0].x ^= 1;
  scene.set_mesh(1, shaded);
  expect_rest("a normal");
}

TEST_F(TriangleLists, FollowEveryChangeOfTheGeometry) {
  flatten(with_something_of_everything());
  const auto expect_written = [&](const char* what) {
    EXPECT_TRUE(update()) << what;
    const std::vector<TracedTriangle> triangles = list.read();
    const std::vector<TracedTriangle> due = transformed(scene, gpu, list.origin());
    ASSERT_EQ(triangles.size(), due.size()) << what;
    EXPECT_EQ(differences(triangles, due), 0u) << what;
    expect_within(triangles, list.bounds());
    EXPECT_FALSE(update()) << what;
  };
  const glm::mat4 moved = glm::translate(glm::mat4(1.0f), {0.1f, 3.0f, 0.7f});
  const int first = 0;
  scene.set_instance_matrices({&first, 1}, {&moved, 1});
  expect_written("a moved object");
  scene::Mesh edited = scene.meshes().at(2);
  edited.positions[3].z += 0.5f;
  scene.set_mesh(2, edited);
  expect_written("a moved vertex");
  scene.set_mesh(2, sphere({0, 0, 0}, 1, 8).mesh());
  expect_written("another mesh");
  scene::Material clear = alpha_card({1, 1, 1, 0.5f});
  scene.set_material(1, clear);
  expect_written("a material that gains an alpha");
  clear.attributes = {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j"};
  scene.set_material(1, clear);
  expect_written("names of attributes, for which mesh records move");
  std::vector<scene::Instance> instances = scene.instances();
  instances[1].visibility = shared::SEEN_BY_CAMERA;
  instances.erase(instances.begin());
  scene.set_instances(instances, scene.material_table());
  expect_written("an object less, and one that is hidden");
}

TEST_F(TriangleLists, ThatTheDriverCannotAddressAreRefused) {
  gl::DeviceInfo small = context->device();
  small.max_texture_buffer_texels = 3 * 11;
  tracing::TriangleList narrow(small);
  TestScene s;
  s.add_object(box({0, 0, 0}, glm::vec3(1)), {});
  s.install(scene);
  gpu.update(scene);
  expect_error([&] { narrow.update(scene, gpu, programs, timer); }, "12 triangles");
  // It is no more there than before, and fits after all when the scene does.
  scene.set_mesh(1, floor_at(0, 1).mesh());
  gpu.update(scene);
  EXPECT_TRUE(narrow.update(scene, gpu, programs, timer));
  EXPECT_EQ(narrow.count(), 2u);
}

}  // namespace
}  // namespace panoptes::test
