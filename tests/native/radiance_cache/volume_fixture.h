// A geometry volume over a small scene, read back, and its voxels by exact clipping on the host.
#pragma once

#include "gl/context.h"
#include "radiance_cache/geometry_volume.h"
#include "support.h"

#include <array>
#include <bit>
#include <map>
#include <memory>

namespace panoptes::test {

using radiance_cache::GeometryVolume;
using radiance_cache::Grid;

class VolumeTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { context = std::make_unique<gl::Context>(); }
  static void TearDownTestSuite() {
    programs.clear();
    context.reset();
  }

  VolumeTest() : gpu(context->device()), timer(context->device()), list(context->device()) {}

  bool update(const std::vector<Grid>& grids, float fill) {
    gpu.update(scene);
    list.update(scene, gpu, programs, timer);
    const bool made = volume.update(grids, fill, list, gpu, view_block, programs, timer);
    EXPECT_NO_THROW(gl::check_errors("geometry volume"));
    words.resize(volume.word_count());
    if (!words.empty()) volume.word_buffer().read(0, int64_t(words.size() * 8), words.data());
    surfels.resize(volume.solid());
    if (!surfels.empty())
      volume.surfel_buffer().read(0, int64_t(surfels.size() * sizeof(shared::Surfel)),
                                  surfels.data());
    return made;
  }
  void install(const TestScene& setup, const std::vector<Grid>& grids, float fill) {
    setup.install(scene);
    update(grids, fill);
  }

  // Solid voxels of a volume, each with the number of its surfel.
  std::map<std::array<int, 3>, uint32_t> solid(int index = 0) const {
    std::map<std::array<int, 3>, uint32_t> found;
    const shared::CacheVolume& v = volume.volumes().volumes[index];
    const glm::ivec3 counts = glm::ivec3(v.cells) * v.cells.w;
    for (int z = 0; z < counts.z; ++z)
      for (int y = 0; y < counts.y; ++y)
        for (int word = 0; word < v.first.x; ++word) {
          const glm::uvec2 bits = words[size_t(v.first.y + (z * counts.y + y) * v.first.x + word)];
          uint32_t number = bits.y;
          for (int i = 0; i < 32; ++i)
            if (bits.x >> i & 1u) found[{word * 32 + i, y, z}] = number++;
        }
    return found;
  }

  // A surfel's place in the world.
  glm::dvec3 place_of(uint32_t number) const {
    return glm::dvec3(surfels[number].place) + glm::dvec3(list.origin());
  }

  static inline std::unique_ptr<gl::Context> context;
  static inline gl::ProgramCache programs;
  scene::Scene scene;
  gpu_scene::GpuScene gpu;
  gl::PassTimer timer;
  gpu_scene::ViewBlock view_block;
  tracing::TriangleList list;
  GeometryVolume volume;
  std::vector<glm::uvec2> words;
  std::vector<shared::Surfel> surfels;
};

// As pack_color() of surfel_color.glsl has it.
inline glm::dvec3 unpack_color(uint32_t word) {
  glm::dvec3 color;
  for (int i = 0; i < 3; ++i) {
    const double root = double(word >> (10 * i) & 1023u) / 1023.0;
    color[i] = root * root;
  }
  return color;
}

using Polygon = std::vector<glm::dvec3>;

// What of a convex polygon lies on the side of sign * axis >= sign * at.
inline Polygon cut(const Polygon& polygon, int axis, double at, double sign) {
  Polygon kept;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double a = sign * (p[axis] - at), b = sign * (q[axis] - at);
    if (a >= 0) kept.push_back(p);
    if ((a >= 0) != (b >= 0)) kept.push_back(p + (q - p) * (a / (a - b)));
  }
  return kept;
}

// Area of a triangle in a box.
inline double area_in_box(const Polygon& triangle, const glm::dvec3& low, const glm::dvec3& high) {
  Polygon p = triangle;
  for (int axis = 0; axis < 3; ++axis)
    p = cut(cut(p, axis, low[axis], 1), axis, high[axis], -1);
  glm::dvec3 sum(0);
  for (size_t i = 2; i < p.size(); ++i) sum += glm::cross(p[i - 1] - p[0], p[i] - p[0]);
  return 0.5 * glm::length(sum);
}

}  // namespace panoptes::test
