#include "radiance_cache/placement.h"

#include <algorithm>
#include <cmath>

namespace panoptes::radiance_cache {
std::vector<Grid> choose_grids(const scene::Bounds& bounds, const gpu_scene::Camera&, const Settings& settings) {
  const int r = settings.resolution ? settings.resolution : 28;
  const glm::dvec3 low(bounds.low), size = glm::dvec3(bounds.high) - low;
  const double longest = std::max({size.x, size.y, size.z}) * 1.02;
  Grid grid;
  grid.cell = longest / r;
  grid.voxels = settings.voxels;
  for (int i = 0; i < 3; ++i) grid.cells[i] = std::clamp(int(std::ceil(size[i] * 1.02 / grid.cell)), 1, r);
  grid.low = low + 0.5 * size - 0.5 * grid.cell * glm::dvec3(grid.cells);
  return {grid};
}
}  // namespace panoptes::radiance_cache
