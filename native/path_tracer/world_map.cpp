#include "path_tracer/world_map.h"

#include "gl/dispatch.h"

#include <algorithm>
#include <numeric>

namespace panoptes::path_tracer {

namespace {

constexpr double kPi = 3.14159265358979323846;

// Widths of the map: fine enough for a sky without an image, and what a frame can bear.
constexpr int kLeastWidth = 1024, kMostWidth = 2048;
constexpr int kMostPoints = 4;  // along each side of a texel

constexpr double kEven = 0.05;  // share of samples that are spread evenly

// A texel is taken to be at least so bright beside the brightest of its neighbours: its points may have
// missed the rim of a sun.
constexpr float kRim = 1.0f / 8;

std::vector<float> with_rims(const std::vector<float>& values, glm::ivec2 size) {
  // Rows, then columns; directions go on around the poles' axis, not across the poles.
  std::vector<float> across(values.size()), result(values.size());
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const float* row = &values[size_t(y) * size_t(size.x)];
      across[size_t(y) * size_t(size.x) + size_t(x)] =
          std::max({row[x], row[(x + 1) % size.x], row[(x + size.x - 1) % size.x]});
    }
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const auto at = [&](int row) {
        return across[size_t(std::clamp(row, 0, size.y - 1)) * size_t(size.x) + size_t(x)];
      };
      const size_t i = size_t(y) * size_t(size.x) + size_t(x);
      result[i] = std::max(values[i], kRim * std::max({at(y - 1), at(y), at(y + 1)}));
    }
  return result;
}

// Sums of `values` before each of them and after the last, divided by that.
void accumulate(std::span<const double> values, float* sums) {
  const double total = std::accumulate(values.begin(), values.end(), 0.0);
  double sum = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    sums[i] = float(sum / total);
    sum += values[i];
  }
  sums[values.size()] = 1.0f;
}

}  // namespace

gl::ProgramSource world_map_program(const gpu_scene::GpuShading& world) {
  gl::ProgramSource source;
  source.name = "world map";
  source.stages = {{GL_COMPUTE_SHADER, "path_tracer/world_map.comp"}};
  gpu_scene::GpuScene::add_world(world, source);
  return source;
}

std::vector<float> world_distribution(std::span<const float> brightness, int width, int height) {
  const size_t across = size_t(width), down = size_t(height);
  const double total = std::accumulate(brightness.begin(), brightness.end(), 0.0);
  std::vector<float> sums((down + 1) + down * (across + 1));
  std::vector<double> rows(down), texels(across);
  for (size_t y = 0; y < down; ++y) {
    // The band's share of the sphere.
    const double even = std::sin(kPi * (double(y) + 0.5) / height) * std::sin(0.5 * kPi / height);
    for (size_t x = 0; x < across; ++x)
      texels[x] = (1 - kEven) * double(brightness[y * across + x]) / total + kEven * even / width;
    rows[y] = std::accumulate(texels.begin(), texels.end(), 0.0);
    accumulate(texels, &sums[(down + 1) + y * (across + 1)]);
  }
  accumulate(rows, sums.data());
  return sums;
}

void WorldMap::clear() { *this = WorldMap(); }

void WorldMap::update(const gpu_scene::GpuScene& gpu, const gl::DeviceInfo& device,
                      gl::ProgramCache& programs) {
  clear();
  const int image = gpu.world_image_width();
  int width = std::clamp(image, kLeastWidth, kMostWidth);
  // Half as high, and one value more a row.
  while (int64_t(width / 2) * (width + 2) + 1 > device.max_texture_buffer_texels) width /= 2;
  size_ = {width, width / 2};
  const int points = std::clamp((2 * image + width - 1) / width, 2, kMostPoints);
  const uint32_t count = uint32_t(size_.x * size_.y);

  const gl::Buffer measured(int64_t(count) * 4);
  programs.get(world_map_program(*gpu.world())).use();
  gpu.bind_shading(*gpu.world());
  glUniform3i(1, size_.x, size_.y, points);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, measured.id());
  gl::dispatch(count, GL_BUFFER_UPDATE_BARRIER_BIT);
  std::vector<float> brightness(count);
  measured.read(0, measured.bytes(), brightness.data());

  // Texels hold brightness times solid angle.
  const double sum = std::accumulate(brightness.begin(), brightness.end(), 0.0);
  irradiance_ = float(0.25 * sum);
  if (!any()) return;
  buffer_ = gl::Buffer(std::span<const float>(world_distribution(with_rims(brightness, size_), size_.x, size_.y)));
  texture_ = gl::Texture(GL_R32F, buffer_);
}

}  // namespace panoptes::path_tracer
