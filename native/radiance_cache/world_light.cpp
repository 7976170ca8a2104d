#include "radiance_cache/world_light.h"

#include "gl/dispatch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace panoptes::radiance_cache {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kBlurredWidth = kWorldWidth / 4, kBlurredHeight = kWorldHeight / 4;

glm::dvec3 direction(int x, int y, int width, int height) {
  const double phi = (x + 0.5) / width * 2 * kPi, theta = (y + 0.5) / height * kPi;
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

// Of a texel in row `y`, exactly.
double solid_angle(int y, int width, int height) {
  const double band = kPi / height;
  return 2 * kPi / width * 2 * std::sin((y + 0.5) * band) * std::sin(0.5 * band);
}

std::array<double, 9> harmonics_of(const glm::dvec3& d) {
  return {0.282094792,
          0.488602512 * d.y,
          0.488602512 * d.z,
          0.488602512 * d.x,
          1.092548431 * d.x * d.y,
          1.092548431 * d.y * d.z,
          0.315391565 * (3 * d.z * d.z - 1),
          1.092548431 * d.x * d.z,
          0.546274215 * (d.x * d.x - d.y * d.y)};
}

}  // namespace

std::array<glm::vec4, 9> world_harmonics(std::span<const glm::vec4> radiance) {
  std::array<glm::dvec4, 9> sums{};
  for (int y = 0; y < kWorldHeight; ++y)
    for (int x = 0; x < kWorldWidth; ++x) {
      const auto basis = harmonics_of(direction(x, y, kWorldWidth, kWorldHeight));
      const glm::dvec4 light = glm::dvec4(radiance[size_t(y * kWorldWidth + x)]) *
                               solid_angle(y, kWorldWidth, kWorldHeight);
      for (size_t k = 0; k < 9; ++k) sums[k] += light * basis[k];
    }
  std::array<glm::vec4, 9> result;
  for (size_t k = 0; k < 9; ++k) result[k] = glm::vec4(glm::dvec3(sums[k]), 0);
  return result;
}

std::vector<glm::vec4> blurred_world(std::span<const glm::vec4> radiance, int directions) {
  // The integral of cos^n over a hemisphere is 2 pi / (n + 1).
  const double power = std::max(directions / 2.0 - 1, 1.0);
  struct Texel {
    glm::dvec3 direction, radiance;
    double solid_angle;
  };
  std::vector<Texel> texels;
  // Four texels at a time are fine enough to be blurred.
  constexpr int kWidth = kWorldWidth / 2, kHeight = kWorldHeight / 2;
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u) {
      const auto row = radiance.begin() + 2 * v * kWorldWidth + 2 * u, below = row + kWorldWidth;
      const double size = solid_angle(2 * v, kWorldWidth, kWorldHeight),
                   size_below = solid_angle(2 * v + 1, kWorldWidth, kWorldHeight);
      const glm::dvec4 sum = size * (glm::dvec4(row[0]) + glm::dvec4(row[1])) +
                             size_below * (glm::dvec4(below[0]) + glm::dvec4(below[1]));
      texels.push_back({direction(u, v, kWidth, kHeight),
                        glm::dvec3(sum) / (2 * (size + size_below)),
                        2 * (size + size_below)});
    }
  std::vector<glm::vec4> result;
  for (int y = 0; y < kBlurredHeight; ++y)
    for (int x = 0; x < kBlurredWidth; ++x) {
      const glm::dvec3 axis = direction(x, y, kBlurredWidth, kBlurredHeight);
      glm::dvec3 sum(0);
      double weights = 0;
      for (const Texel& texel : texels) {
        const double cosine = glm::dot(axis, texel.direction);
        if (cosine <= 0) continue;
        const double weight = std::pow(cosine, power) * texel.solid_angle;
        sum += weight * texel.radiance;
        weights += weight;
      }
      result.emplace_back(glm::vec3(sum / weights), 1);
    }
  return result;
}

gl::ProgramSource world_radiance_program(const gpu_scene::GpuShading& world) {
  gl::ProgramSource source;
  source.name = "world radiance";
  source.stages = {{GL_COMPUTE_SHADER, "radiance_cache/world_radiance.comp"}};
  gpu_scene::GpuScene::add_world(world, source);
  return source;
}

void WorldLight::update(const scene::World& world, const gpu_scene::GpuScene& gpu,
                        gl::ProgramCache& programs) {
  if (revision_ == gpu.world_revision()) return;
  constexpr int kTexels = kWorldWidth * kWorldHeight;
  radiance_.assign(kTexels, glm::vec4(world.constant.value_or(glm::vec3(0)), 0));
  if (!world.constant && gpu.world()) {
    // As many directions as the world's images have texels, within what a frame can bear.
    const int points = std::clamp(gpu.world_image_width() / kWorldWidth, 2, 16);
    const gl::Buffer measured(kTexels * 16);
    programs.get(world_radiance_program(*gpu.world())).use();
    gpu.bind_shading(*gpu.world());
    glUniform3i(1, kWorldWidth, kWorldHeight, points);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, measured.id());
    gl::dispatch(kTexels, GL_BUFFER_UPDATE_BARRIER_BIT);
    measured.read(0, measured.bytes(), radiance_.data());
  }
  std::array<glm::vec4, 9> coefficients = world_harmonics(radiance_);
  if (world.constant) {
    // Only the first harmonic, 1 / sqrt(4 pi), has a mean.
    coefficients = {};
    coefficients[0] = glm::vec4(*world.constant * float(std::sqrt(4 * kPi)), 0);
  }
  if (!harmonics_) harmonics_ = gl::Buffer(int64_t(sizeof coefficients));
  harmonics_.write(0, int64_t(sizeof coefficients), coefficients.data());
  directions_ = 0;
  revision_ = gpu.world_revision();
}

const gl::Texture& WorldLight::map(int directions) {
  if (directions_ != directions) {
    const std::vector<glm::vec4> texels = blurred_world(radiance_, directions);
    if (!map_) map_ = gl::Texture({GL_TEXTURE_2D, GL_RGBA32F, kBlurredWidth, kBlurredHeight, 1, 1});
    map_.write(GL_RGBA, GL_FLOAT, texels.data());
    directions_ = directions;
  }
  return map_;
}

}  // namespace panoptes::radiance_cache
