// The geometry volume where scenes, grids and triangles are unusual.
#include "gl/counters.h"
#include "radiance_cache/volume_fixture.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <limits>

namespace panoptes::test {
namespace {

class VolumeHardCases : public VolumeTest {
 protected:
  double total_area() const {
    double sum = 0;
    for (const shared::Surfel& surfel : surfels) sum += surfel.place.w;
    return sum;
  }
};

Geometry triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  Geometry g;
  g.positions = {a, b, c};
  g.triangles = g.loops = {{0, 1, 2}};
  g.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  g.uv = {0, 0, 1, 0, 0, 1};
  g.slots = {0};
  return g;
}

TEST_F(VolumeHardCases, NothingAtAll) {
  install(TestScene(), {Grid()}, 0.75f);
  EXPECT_EQ(volume.solid(), 0u);
  update({}, 0.75f);
  EXPECT_EQ(volume.solid(), 0u);
  EXPECT_EQ(volume.volumes().count.x, 0);
}

TEST_F(VolumeHardCases, AFlatSceneInOneLayerOfCells) {
  TestScene s;
  s.add_object(floor_at(0, 1), {s.add_material(lambert())});
  // In the middle of a layer, at its lower border, and with more words a row than one.
  for (const Grid& grid : {Grid{{-1, -1, -0.05}, 0.25, {8, 8, 1}, 4}, Grid{{-1, -1, 0}, 0.25, {8, 8, 1}, 4},
                           Grid{{-1, -1, -0.02}, 0.05, {40, 40, 1}, 2}}) {
    install(s, {grid}, 0.75f);
    EXPECT_EQ(volume.solid(), uint32_t(grid.cells.x * grid.voxels * grid.cells.y * grid.voxels));
    EXPECT_NEAR(total_area(), 4, 1e-3);
  }
}

TEST_F(VolumeHardCases, TrianglesThatAreNone) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                  kInf = std::numeric_limits<float>::infinity();
  TestScene s;
  const Id grey = s.add_material(lambert());
  s.add_object(floor_at(0, 1), {grey});
  s.add_object(triangle({kNan, 0, 0}, {1, 0, 0}, {0, 1, 0}), {grey});
  s.add_object(triangle({kInf, 0, 0}, {1, 0, 0}, {0, 1, 0}), {grey});
  s.add_object(triangle({0.1f, 0.1f, 0.2f}, {0.1f, 0.1f, 0.2f}, {0.1f, 0.1f, 0.2f}), {grey});
  s.add_object(triangle({0.1f, 0.1f, 0.2f}, {0.5f, 0.5f, 0.2f}, {0.9f, 0.9f, 0.2f}), {grey});
  s.add_object(triangle({0.1f, 0.1f, 1e30f}, {0.5f, -1e30f, 0.2f}, {1e30f, 0.9f, 0.2f}), {grey});
  install(s, {Grid{{-1, -1, -0.5}, 0.25, {8, 8, 4}, 4}}, 0);
  EXPECT_EQ(volume.solid(), 32u * 32u);
  EXPECT_NEAR(total_area(), 4, 1e-3);
}

TEST_F(VolumeHardCases, FarFromTheWorldsOrigin) {
  TestScene s;
  const double far = 1048576;
  s.add_object(sphere({0, 0, 0}, 1, 32), {s.add_material(lambert())});
  Grid grid{{-1.2, -1.2, -1.2}, 0.3, {8, 8, 8}, 4};
  install(s, {grid}, 0.5f);
  const std::vector<glm::uvec2> near_words = words;
  const double area = total_area();
  TestScene moved = s;
  moved.instances[0].object_to_world =
      glm::translate(glm::mat4(1), glm::vec3(glm::dvec3(far, -far, far)));
  grid.low += glm::dvec3(far, -far, far);
  install(moved, {grid}, 0.5f);
  EXPECT_EQ(words, near_words);
  EXPECT_NEAR(total_area(), area, 1e-3 * area);
  for (const auto& [voxel, number] : solid())
    EXPECT_NEAR(glm::distance(place_of(number), glm::dvec3(far, -far, far)), 1, 0.02);
}

TEST_F(VolumeHardCases, ATriangleAcrossEverything) {
  for (float size : {10.0f, 1e3f, 1e5f}) {
    TestScene s;
    // The plane z = x / 2, which the grid's corners lie on both sides of.
    s.add_object(quad({0, 0, 0}, {size, 0, 0.5f * size}, {0, size, 0}), {s.add_material(lambert())});
    const Grid grid{{-1, -1, -1}, 0.25, {8, 8, 8}, 4};
    install(s, {grid}, 0);
    EXPECT_NEAR(total_area(), 4 * std::sqrt(1.25), 1e-2) << size;
    for (const auto& [voxel, number] : solid()) {
      const glm::dvec3 p = place_of(number);
      EXPECT_NEAR(p.z, 0.5 * p.x, 1e-6 * size + 1e-4);
    }
  }
}

TEST_F(VolumeHardCases, ManyTrianglesInOneVoxel) {
  constexpr int kTriangles = 100'000;
  TestScene s;
  Geometry heap;
  for (int i = 0; i < kTriangles; ++i) {
    const float x = 0.001f * float(i % 300), y = 0.001f * float(i / 300);
    const int v = int(heap.positions.size());
    heap.positions.insert(heap.positions.end(),
                          {{x, y, 0.1f}, {x + 0.001f, y, 0.1f}, {x, y + 0.001f, 0.1f}});
    heap.normals.insert(heap.normals.end(), 3, {0, 0, 1});
    heap.uv.insert(heap.uv.end(), 6, 0.0f);
    heap.triangles.push_back({v, v + 1, v + 2});
    heap.loops.push_back({v, v + 1, v + 2});
    heap.slots.push_back(0);
  }
  s.add_object(heap, {s.add_material(lambert())});
  install(s, {Grid{{-1, -1, -1}, 2, {1, 1, 1}, 1}}, 0);
  ASSERT_EQ(volume.solid(), 1u);
  // Each is the five-hundredth part of a step that areas are counted in.
  EXPECT_NEAR(total_area(), kTriangles * 0.5e-6, 0.05 * kTriangles * 0.5e-6);
}

TEST_F(VolumeHardCases, MoreContendersThanThereIsRoomFor) {
  // A few triangles over many voxels, which each of them is drawn for at first.
  TestScene s;
  Geometry sheets;
  for (int i = 0; i < 12; ++i) sheets.add(floor_at(0.0003f * float(12 - i), 2));
  s.add_object(sheets, {s.add_material(lambert())});
  install(s, {Grid{{-1, -1, -0.05}, 2.0 / 64, {64, 64, 4}, 4}}, 0.5f);
  EXPECT_EQ(volume.solid(), 256u * 256u);
  EXPECT_NEAR(total_area(), 12 * 4, 0.05);
  for (const shared::Surfel& surfel : surfels) ASSERT_EQ(surfel.surface.x, 0u);  // up
}

TEST_F(VolumeHardCases, VolumesInEachOtherAreAsEachAlone) {
  TestScene s;
  s.add_object(sphere({0, 0, 0}, 2, 32), {s.add_material(lambert())});
  s.add_object(box({0, 0, 0}, {0.7f, 0.6f, 0.5f}), {s.add_material(lambert())});
  const std::vector<Grid> grids{{{-1, -1, -1}, 0.25, {8, 8, 8}, 4}, {{-1.5, -2, -2}, 0.5, {7, 8, 9}, 4},
                                {{-4, -4, -4}, 1, {8, 8, 8}, 3}};
  install(s, grids, 0.5f);
  ASSERT_EQ(volume.volumes().count.x, 3);
  EXPECT_EQ(volume.volumes().count.y, 512 + 7 * 8 * 9 + 512);
  EXPECT_EQ(volume.volumes().count.z, int(volume.solid()));
  std::vector<std::map<std::array<int, 3>, uint32_t>> together;
  for (int i = 0; i < 3; ++i) together.push_back(solid(i));
  const std::vector<shared::Surfel> all = surfels;
  for (int i = 0; i < 3; ++i) {
    update({grids[size_t(i)]}, 0.5f);
    const auto alone = solid();
    ASSERT_EQ(alone.size(), together[size_t(i)].size());
    ASSERT_GT(alone.size(), 100u);
    for (const auto& [voxel, number] : alone) {
      ASSERT_TRUE(together[size_t(i)].count(voxel));
      const shared::Surfel &a = surfels[number], &b = all[together[size_t(i)][voxel]];
      ASSERT_EQ(a.place.w, b.place.w);
      ASSERT_EQ(a.surface, b.surface);
    }
  }
}

TEST_F(VolumeHardCases, TooManyVoxelsAreASentenceAndTheNextVolumeIsWell) {
  TestScene s;
  s.add_object(floor_at(0, 1), {s.add_material(lambert())});
  s.install(scene);
  expect_error([&] { update({Grid{{-1, -1, -1}, 2.0 / 64, {64, 64, 64}, 8}}, 0.75f); }, "million voxels");
  update({Grid{{-1, -1, -0.05}, 0.25, {8, 8, 1}, 4}}, 0.75f);
  EXPECT_EQ(volume.solid(), 32u * 32u);
}

TEST_F(VolumeHardCases, ReleasedItHoldsNothing) {
  const int64_t buffers = gl::counters().buffers, textures = gl::counters().textures;
  TestScene s;
  s.add_object(floor_at(0, 1), {s.add_material(lambert())});
  s.install(scene);
  gpu.update(scene);
  list.update(scene, gpu, programs, timer);
  const int64_t with_scene = gl::counters().buffers, textures_with = gl::counters().textures;
  EXPECT_GE(with_scene, buffers);
  EXPECT_GE(textures_with, textures);
  update({Grid{{-1, -1, -0.05}, 0.25, {8, 8, 1}, 4}}, 0.75f);
  EXPECT_GT(gl::counters().buffers, with_scene);
  volume.release();
  EXPECT_EQ(volume.solid(), 0u);
  // The view's block is not the volume's.
  EXPECT_EQ(gl::counters().buffers, with_scene + 1);
  EXPECT_EQ(gl::counters().textures, textures_with);
}

}  // namespace
}  // namespace panoptes::test
