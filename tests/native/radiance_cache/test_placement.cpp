// Where the volumes of the radiance cache lie: they cover the scene or the camera's surroundings, on
// lattices that stay.
#include "radiance_cache/placement.h"
#include "support.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace panoptes::test {
namespace {

using radiance_cache::choose_grids;
using radiance_cache::Grid;
using radiance_cache::Settings;

scene::Bounds box_of(const glm::dvec3& low, const glm::dvec3& high) {
  scene::Bounds bounds;
  bounds.add(glm::vec3(low));
  bounds.add(glm::vec3(high));
  return bounds;
}

gpu_scene::Camera camera_at(const glm::dvec3& eye) {
  return perspective(eye, eye + glm::dvec3(0, 1, 0), 0.8, 64, 48);
}

Settings with(int resolution, int cascades) {
  Settings settings;
  settings.resolution = resolution;
  settings.cascades = cascades;
  return settings;
}

glm::dvec3 high_of(const Grid& grid) { return grid.low + grid.cell * glm::dvec3(grid.cells); }

// By how many cells `bounds` lies within the grid; negative where it does not.
double margin(const Grid& grid, const scene::Bounds& bounds) {
  const glm::dvec3 below = (glm::dvec3(bounds.low) - grid.low) / grid.cell,
                   above = (high_of(grid) - glm::dvec3(bounds.high)) / grid.cell;
  return std::min({below.x, below.y, below.z, above.x, above.y, above.z});
}

int longest(const Grid& grid) { return std::max({grid.cells.x, grid.cells.y, grid.cells.z}); }

// How far each corner is from the lattice of its size in the world, in cells, beside that of `other`.
void expect_one_lattice(const Grid& a, const Grid& b) {
  ASSERT_EQ(a.cell, b.cell);
  for (int i = 0; i < 3; ++i) {
    const double steps = (b.low[i] - a.low[i]) / a.cell;
    EXPECT_NEAR(steps, std::round(steps), 1e-6);
  }
}

TEST(Placement, OneVolumeHoldsTheSceneAndACellAround) {
  for (int resolution : {0, 8, 16, 24, 32, 64})
    for (const glm::dvec3& size : {glm::dvec3(1, 1, 1), {38, 15, 22}, {0.01, 0.02, 0.005}, {3000, 10, 700}}) {
      const scene::Bounds bounds = box_of(-0.3 * size, 0.7 * size);
      const std::vector<Grid> grids = choose_grids(bounds, camera_at({}), with(resolution, 1));
      ASSERT_EQ(grids.size(), 1u);
      EXPECT_GE(margin(grids[0], bounds), 0.99);
      EXPECT_LE(longest(grids[0]), resolution ? resolution : 32);
      // Not more than an eighth of an octave coarser than what was asked for.
      if (resolution >= 16) {
        EXPECT_GE(longest(grids[0]), int(0.9 * resolution) - 2);
      }
    }
}

TEST(Placement, ChoosesMoreCellsForAFlatSceneThanForACube) {
  const auto cells = [](const glm::dvec3& size) {
    return longest(choose_grids(box_of({}, size), camera_at({}), Settings())[0]);
  };
  EXPECT_GT(cells({10, 10, 1}), cells({10, 10, 10}));
  EXPECT_GE(cells({10, 10, 10}), 20);
}

TEST(Placement, KeepsALatticeWhileASceneMovesALittle) {
  const std::vector<Grid> before = choose_grids(box_of({0, 0, 0}, {9, 4, 3}), camera_at({}), Settings());
  for (int i = 1; i < 20; ++i) {
    const glm::dvec3 moved(0.013 * i, -0.07 * i, 0.031 * i);
    const std::vector<Grid> after =
        choose_grids(box_of(moved, glm::dvec3(9, 4, 3) + moved), camera_at({}), Settings());
    expect_one_lattice(before[0], after[0]);
  }
}

TEST(Placement, SeesAWholeSceneInOneVolumeWhereItsCellsAreSmallEnough) {
  const scene::Bounds bounds = box_of({0, 0, 0}, {20, 20, 10});
  EXPECT_EQ(choose_grids(bounds, camera_at({5, 5, 5}), Settings()).size(), 1u);
  EXPECT_EQ(choose_grids(bounds, camera_at({5, 5, 5}), Settings(), 15).size(), 1u);
  EXPECT_GT(choose_grids(bounds, camera_at({5, 5, 5}), Settings(), 2).size(), 1u);
}

TEST(Placement, CascadesAreTwiceAsWideEachAndAboutTheCamera) {
  const glm::dvec3 eye(40, -30, 5);
  const scene::Bounds bounds = box_of({-100, -100, 0}, {100, 100, 40});
  for (int cascades : {2, 3}) {
    const std::vector<Grid> grids = choose_grids(bounds, camera_at(eye), with(24, cascades));
    ASSERT_EQ(int(grids.size()), cascades);
    for (size_t i = 0; i < grids.size(); ++i) {
      if (i > 0) {
        EXPECT_DOUBLE_EQ(grids[i].cell, 2 * grids[i - 1].cell);
      }
      EXPECT_LE(longest(grids[i]), 24);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LT(grids[i].low[axis], eye[axis]);
        EXPECT_GT(high_of(grids[i])[axis], eye[axis]);
        if (i == 0) continue;
        EXPECT_LE(grids[i].low[axis], grids[i - 1].low[axis]);
        EXPECT_GE(high_of(grids[i])[axis], high_of(grids[i - 1])[axis]);
      }
    }
    EXPECT_GE(margin(grids.back(), bounds), 0.99);
  }
}

TEST(Placement, CascadesMoveInStepsOfWholeCells) {
  const scene::Bounds bounds = box_of({-500, -500, -20}, {500, 500, 80});
  const std::vector<Grid> before = choose_grids(bounds, camera_at({}), with(16, 3), 0);
  int moves = 0;
  glm::dvec3 last = before[0].low;
  for (int i = 1; i <= 200; ++i) {
    const std::vector<Grid> after =
        choose_grids(bounds, camera_at(glm::dvec3(0.9, 0.3, 0.1) * double(i)), with(16, 3), 0);
    ASSERT_EQ(after.size(), before.size());
    for (size_t k = 0; k < after.size(); ++k) {
      expect_one_lattice(before[k], after[k]);
      EXPECT_EQ(after[k].cells, before[k].cells);
    }
    moves += after[0].low != last;
    last = after[0].low;
  }
  // Sometimes, not with every step of the camera.
  EXPECT_GT(moves, 5);
  EXPECT_LT(moves, 100);
}

TEST(Placement, ManyDistancesHaveTheSameCascades) {
  const scene::Bounds bounds = box_of({-5000, -5000, -20}, {5000, 5000, 300});
  std::set<double> sizes;
  for (double distance = 8; distance < 16; distance *= 1.01)
    sizes.insert(choose_grids(bounds, camera_at({}), Settings(), distance)[0].cell);
  EXPECT_LE(sizes.size(), 2u);
}

TEST(Placement, DetailComesBeforeTheRestOfAVastScene) {
  const std::vector<Grid> grids = choose_grids(box_of({-5000, -5000, -20}, {5000, 5000, 300}),
                                               camera_at({10, 20, 1.7}), Settings(), 10);
  ASSERT_EQ(int(grids.size()), radiance_cache::kMostCascades);
  // The picture's longer side shows 11.3 m at this distance.
  EXPECT_LE(grids[0].cell, 0.15 * 11.3);
  EXPECT_GE(grids[0].cell, 0.07 * 11.3);
  // One octave more than cascades bring goes into the cells, and the scene is held.
  const scene::Bounds town = box_of({-120, -120, -20}, {120, 120, 30});
  EXPECT_GE(margin(choose_grids(town, camera_at({}), Settings(), 12).back(), town), 0.99);
}

TEST(Placement, CascadesLieAboutWhatALongLensLooksAt) {
  const scene::Bounds bounds = box_of({-500, -500, 0}, {500, 500, 40});
  const glm::dvec3 eye(0, -300, 20), target(0, 0, 20);
  for (const gpu_scene::Camera& camera :
       {perspective(eye, target, 0.02, 64, 48), orthographic(eye, target, 5, 64, 48)}) {
    const std::vector<Grid> grids = choose_grids(bounds, camera, Settings(), 300);
    EXPECT_LE(grids[0].cell, 2);
    EXPECT_GT(margin(grids[0], box_of(target - 2.0, target + 2.0)), 0);
  }
}

TEST(Placement, IsFiniteForEveryInput) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN(), million = 1048576.0f;
  std::vector<scene::Bounds> all(1);
  all.push_back(box_of({0, 0, 0}, {0, 0, 0}));
  all.push_back(box_of({0, 0, 0}, {5, 5, 0}));
  all.push_back(box_of({0, 0, 0}, {5, 0, 0}));
  all.push_back(box_of({million, million, -million}, {million + 2, million + 2, 2 - million}));
  all.push_back(box_of({million, million, million}, {million, million, million}));
  all.push_back(box_of({-1e-3, -1e-3, 0}, {1e-3, 1e-3, 1e-4}));
  all.push_back(box_of({-1e30, -1e30, -1e30}, {1e30, 1e30, 1e30}));
  all.push_back(box_of({-1e11, -1e11, -1e11}, {1e11, 1e11, 1e11}));
  all.push_back({{-kInf, 0, 0}, {kInf, 1, 1}});
  all.push_back({{nan, 0, 0}, {1, nan, 1}});
  std::vector<gpu_scene::Camera> cameras{camera_at({}), camera_at({1e9, -1e9, 3}), camera_at({})};
  cameras[2].world_to_camera = glm::dmat4(0);
  for (const scene::Bounds& bounds : all)
    for (const gpu_scene::Camera& camera : cameras)
      for (int resolution : {0, 4, 64})
        for (int cascades : {0, 1, 3})
          for (int voxels : {2, 8})
            for (double distance : {0.0, 1e-9, 1e9, double(nan)}) {
              Settings settings = with(resolution, cascades);
              settings.voxels = voxels;
              const std::vector<Grid> grids = choose_grids(bounds, camera, settings, distance);
              ASSERT_FALSE(grids.empty());
              ASSERT_LE(grids.size(), size_t(radiance_cache::kMostCascades));
              int64_t held = 0;
              for (const Grid& grid : grids) {
                ASSERT_TRUE(grid.cell > 0 && std::isfinite(grid.cell));
                for (int i = 0; i < 3; ++i) {
                  ASSERT_TRUE(std::isfinite(grid.low[i]));
                  ASSERT_GE(grid.cells[i], 1);
                  ASSERT_LE(grid.cells[i], 64);
                }
                ASSERT_GE(grid.voxels, 1);
                const glm::ivec3 counts = grid.cells * grid.voxels;
                held += int64_t((counts.x + 31) / 32 * 32) * counts.y * counts.z;
              }
              ASSERT_LE(held, radiance_cache::kMostVoxels);
            }
}

}  // namespace
}  // namespace panoptes::test
