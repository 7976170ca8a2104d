// The voxels of the geometry volume: which are solid, by how much surface, in one or several volumes.
#include "radiance_cache/volume_fixture.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <random>

namespace panoptes::test {
namespace {

class GeometryVolumes : public VolumeTest {
 protected:
  // Expects every voxel's area to be that of `triangles` clipped to it, within `tolerance` faces and
  // one part in a hundred.
  void expect_areas(const std::vector<Polygon>& triangles, const Grid& grid, double tolerance) {
    const double size = grid.cell / grid.voxels;
    std::map<std::array<int, 3>, double> due;
    for (const Polygon& t : triangles) {
      glm::ivec3 low, high;
      for (int i = 0; i < 3; ++i) {
        const auto [least, most] = std::minmax({t[0][i], t[1][i], t[2][i]});
        const int last = grid.cells[i] * grid.voxels - 1;
        low[i] = int(std::clamp(std::floor((least - grid.low[i]) / size), 0.0, double(last)));
        high[i] = int(std::clamp(std::floor((most - grid.low[i]) / size), 0.0, double(last)));
      }
      for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y)
          for (int x = low.x; x <= high.x; ++x) {
            const glm::dvec3 corner = grid.low + size * glm::dvec3(x, y, z);
            const double area = area_in_box(t, corner, corner + size) / (size * size);
            if (area > 0) due[{x, y, z}] += area;
          }
    }
    const auto found = solid();
    double worst = 0;
    for (const auto& [voxel, number] : found) {
      const double area = surfels[number].place.w / (size * size);
      worst = std::max(worst, std::abs(area - due[voxel]) / (tolerance + 0.01 * due[voxel]));
    }
    EXPECT_LT(worst, 1);
    // Nothing of any size is missing.
    for (const auto& [voxel, area] : due) EXPECT_TRUE(area <= tolerance || found.count(voxel)) << area;
  }
};

Geometry soup(int count, double size, double reach, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-reach, reach), edge(-size, size);
  Geometry g;
  for (int i = 0; i < count; ++i) {
    const glm::vec3 p(place(random), place(random), place(random));
    for (int k = 0; k < 3; ++k) {
      g.positions.push_back(p + glm::vec3(edge(random), edge(random), edge(random)));
      g.normals.push_back({0, 0, 1});
      g.uv.insert(g.uv.end(), {0, 0});
    }
    g.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    g.loops.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    g.slots.push_back(0);
  }
  return g;
}

std::vector<Polygon> polygons(const Geometry& g) {
  std::vector<Polygon> list;
  for (const glm::ivec3& t : g.triangles)
    list.push_back({g.positions[size_t(t.x)], g.positions[size_t(t.y)], g.positions[size_t(t.z)]});
  return list;
}

TEST_F(GeometryVolumes, HoldTheAreaOfSmallTriangles) {
  TestScene s;
  const Geometry g = soup(2000, 0.3, 2, 1);
  s.add_object(g, {s.add_material(lambert())});
  const Grid grid{{-2.5, -2.4, -2.3}, 0.5, {10, 9, 10}, 4};
  install(s, {grid}, 0);
  expect_areas(polygons(g), grid, 1e-3);
}

TEST_F(GeometryVolumes, HoldTheAreaOfLargeTriangles) {
  TestScene s;
  const Geometry g = soup(40, 6, 2, 2);
  s.add_object(g, {s.add_material(lambert())});
  const Grid grid{{-3, -3, -3}, 0.5, {12, 12, 12}, 4};
  install(s, {grid}, 0);
  expect_areas(polygons(g), grid, 2e-3);
}

TEST_F(GeometryVolumes, HoldTheAreaOfSurfacesThatLieBetweenVoxels) {
  // All faces lie in planes between voxels, and edges where these meet.
  TestScene s;
  const Geometry g = box({0, 0, 0}, {1, 1, 1});
  s.add_object(g, {s.add_material(lambert())});
  const Grid grid{{-2, -2, -2}, 1, {4, 4, 4}, 4};
  install(s, {grid}, 0.75f);
  // Sides of eight by eight voxels, each in the layer that begins there; so the three of the low ends
  // share their edges.
  EXPECT_EQ(volume.solid(), 6u * 64 - 3 * 8 + 1);
  double area = 0;
  for (const shared::Surfel& surfel : surfels) area += surfel.place.w;
  EXPECT_NEAR(area, 24, 1e-3);
}

}  // namespace
}  // namespace panoptes::test
