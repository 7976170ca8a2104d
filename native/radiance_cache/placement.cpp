#include "radiance_cache/placement.h"

#include <algorithm>
#include <cmath>

namespace panoptes::radiance_cache {

namespace {

// Cells along the longest side that are chosen: fewer show corners too dark, more are hardly better.
// Between them, as many as make so many cells of the scene's box.
constexpr int kLeastCells = 24, kMostCells = 32;
constexpr double kChosenCells = 12'000;

// A cell as wide as this share of what the picture's longer side shows is detail enough.
constexpr double kSeenCell = 0.15;

// Cascades are about the camera as long as the finest reaches so far past the distance that it looks at.
constexpr double kReach = 1.25;

// Cells come in sizes that are so many to an octave, so that a scene which moves a little keeps them;
// cascades in octaves, or they would change with every step of the camera.
constexpr double kSizes = 8, kCascadeSizes = 1;

// What surfaces are built on, they rarely share with a lattice that is off by these shares of a voxel:
// one that lies between two layers of voxels would be in either by rounding.
const glm::dvec3 kShift(0.37, 0.41, 0.43);

// Beyond, places are not those of a scene (tracing/flatten_shared.h).
constexpr double kFarthest = 1e12;

struct Box {
  glm::dvec3 low, high;
};

bool finite(const glm::dvec3& v) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  return largest <= kFarthest && v.x == v.x && v.y == v.y && v.z == v.z;
}

glm::dvec3 place_of(const gpu_scene::Camera& camera) {
  const glm::dvec3 place(glm::inverse(camera.world_to_camera)[3]);
  return finite(place) ? place : glm::dvec3(0);
}

double longest_side(const Box& box) {
  const glm::dvec3 size = box.high - box.low;
  return std::max({size.x, size.y, size.z});
}

int chosen_resolution(const Box& box) {
  const glm::dvec3 size = box.high - box.low;
  const double longest = longest_side(box);
  // Of a cell's thickness at least.
  const glm::dvec3 shares = glm::max(size / longest, glm::dvec3(1.0 / kMostCells));
  const double side = std::cbrt(kChosenCells / (shares.x * shares.y * shares.z));
  return int(std::clamp(side, double(kLeastCells), double(kMostCells)));
}

// The least size of those there are that is not below `size`.
double rounded_up(double size, double sizes_an_octave) {
  return std::exp2(std::ceil(std::log2(size) * sizes_an_octave - 1e-9) / sizes_an_octave);
}

// The numbers of the cells along an axis that hold [low, high], and one more on either side.
struct Range {
  double first, end;
};
Range cells_around(double low, double high, double cell, double shift) {
  return {std::floor(low / cell - shift) - 1, std::floor(high / cell - shift) + 2};
}

// Cells of `side` metres over the part of `box` that lies within `reach` cells about `centre`: as many
// wherever the centre is, shifted so that none is lost beyond the box.
Grid grid_over(const Box& box, double side, int voxels, const glm::dvec3& centre, int reach) {
  Grid grid;
  grid.cell = side;
  grid.voxels = voxels;
  for (int axis = 0; axis < 3; ++axis) {
    const double shift = kShift[axis] / voxels;
    const Range all = cells_around(box.low[axis], box.high[axis], side, shift);
    const double count = std::clamp(all.end - all.first, 1.0, double(reach));
    const double wanted = std::round(centre[axis] / side - shift - 0.5 * count);
    const double first = std::clamp(wanted, all.first, all.end - count);
    grid.cells[axis] = int(count);
    grid.low[axis] = (first + shift) * side;
  }
  return grid;
}

int64_t voxels_of(const std::vector<Grid>& grids) {
  int64_t sum = 0;
  for (const Grid& grid : grids) {
    const glm::i64vec3 counts = grid.cells * grid.voxels;
    sum += (counts.x + 31) / 32 * 32 * counts.y * counts.z;
  }
  return sum;
}

// Metres that the longer side of the picture shows at a distance.
double seen_width(const gpu_scene::Camera& camera, double distance) {
  const double scale = std::min(std::abs(camera.projection[0][0]), std::abs(camera.projection[1][1]));
  const double width = 2 / scale * (camera.perspective() ? distance : 1);
  return std::isfinite(width) && width > 0 ? width : distance;
}

// Where cascades whose finest reaches so many metres about its middle lie best.
glm::dvec3 middle_of(const gpu_scene::Camera& camera, double distance, double reach) {
  const glm::dvec3 eye = place_of(camera);
  const glm::dvec3 axis = -glm::dvec3(glm::inverse(camera.world_to_camera)[2]);
  const double length = glm::length(axis);
  const double ahead = distance - reach / kReach;
  const glm::dvec3 middle = eye + axis * (ahead / length);
  return ahead > 0 && length > 0 && finite(middle) ? middle : eye;
}

}  // namespace

bool choose_by_distance(const Settings& settings) { return settings.cascades != 1; }

std::vector<Grid> choose_grids(const scene::Bounds& bounds, const gpu_scene::Camera& camera,
                               const Settings& settings, double distance) {
  const glm::dvec3 eye = place_of(camera);
  Box box{bounds.low, bounds.high};
  if (bounds.empty() || !finite(box.low) || !finite(box.high)) box = {eye, eye};
  // Never flatter than what coordinates of this size can tell apart.
  const double largest = std::max(glm::length(box.low), glm::length(box.high));
  const double least = std::max(1e-6, 1e-7 * largest);
  if (longest_side(box) < least) box = {box.low - 0.5 * least, box.high + 0.5 * least};

  const double longest = longest_side(box);
  const int resolution = settings.resolution ? settings.resolution : chosen_resolution(box);
  // Of `resolution` cells two may lie beyond the box, and one be begun at either end.
  const double whole = rounded_up(longest / std::max(resolution - 3, 1), kSizes);
  int cascades = std::clamp(settings.cascades, 1, kMostCascades);
  double finest = whole * std::exp2(1.0 - cascades);
  const bool looks = distance > 0 && std::isfinite(distance);
  if (settings.cascades == 0 && looks) {
    const double seen = std::max(kSeenCell * seen_width(camera, distance), 1e-6 * whole);
    const int wanted = std::max(int(std::ceil(std::log2(whole / seen) - 1e-9)), 0) + 1;
    cascades = std::min(wanted, kMostCascades);
    // All of the scene rather than the last octave of detail, and detail rather than a scene that
    // would take more of it.
    finest = wanted <= kMostCascades + 1 ? whole * std::exp2(1.0 - cascades)
                                         : rounded_up(0.5 * seen, kCascadeSizes);
  }

  const glm::dvec3 middle = looks ? middle_of(camera, distance, 0.5 * finest * resolution) : eye;

  std::vector<Grid> grids;
  for (int i = 0; i < cascades; ++i) {
    grids.push_back(grid_over(box, finest * std::exp2(double(i)), settings.voxels, middle, resolution));
    if (grids.back().cell >= whole) break;
  }
  // Voxels may be larger than wanted, rather than cells.
  while (voxels_of(grids) > kMostVoxels && grids[0].voxels > 1)
    for (Grid& grid : grids) --grid.voxels;
  return grids;
}

}  // namespace panoptes::radiance_cache
