#include "denoise/edge_avoiding.h"

#include "base/cancelled.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace panoptes::denoise {

namespace {

// Each level reaches twice as far as the one before: 62 pixels in all.
constexpr int kLevels = 5;
constexpr int kGroup = 16;  // filter.comp's
// Darker surfaces are taken for so bright: what they scatter is hardly seen.
constexpr float kDarkest = 0.01f;

float brightness(const float* rgb) { return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2]; }

float scattered(float albedo) { return std::max(albedo, kDarkest); }

float brightness_of_albedo(const float* rgb) {
  const float values[3] = {scattered(rgb[0]), scattered(rgb[1]), scattered(rgb[2])};
  return brightness(values);
}

gl::Texture texture(const Picture& picture, GLenum format) {
  return gl::Texture({GL_TEXTURE_2D, format, picture.width, picture.height, 1, 1});
}

}  // namespace

gl::ProgramSource filter_program(bool smooths, bool positions) {
  gl::ProgramSource source;
  source.name = smooths ? "denoiser, variance" : "denoiser, level";
  source.stages = {{GL_COMPUTE_SHADER, "denoise/filter.comp"}};
  source.defines = {fmt::format("SMOOTHS_VARIANCE {}", int(smooths)), fmt::format("POSITIONS {}", int(positions))};
  return source;
}

void EdgeAvoidingFilter::upload(const Picture& picture) {
  const size_t pixels = size_t(picture.width) * size_t(picture.height);
  const gl::TextureOptions& had = light_[0].options();
  if (!light_[0] || had.width != picture.width || had.height != picture.height) {
    release();
    for (gl::Texture& light : light_) light = texture(picture, GL_RGBA32F);
    normals_ = texture(picture, GL_RGBA16F);
    albedo_ = texture(picture, GL_RGBA16F);
  }
  std::vector<float> light(4 * pixels), normals(4 * pixels);
  for (size_t i = 0; i < pixels; ++i) {
    for (size_t c = 0; c < 3; ++c)
      light[4 * i + c] = (picture.noisy[4 * i + c] - picture.unscattered[3 * i + c]) / scattered(picture.albedo[3 * i + c]);
    const float albedo = brightness_of_albedo(&picture.albedo[3 * i]);
    light[4 * i + 3] = picture.variance[i] / (albedo * albedo);
    const float* n = &picture.normals[3 * i];
    const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (size_t c = 0; c < 3; ++c) normals[4 * i + c] = length > 0 ? n[c] / length : 0.0f;
    normals[4 * i + 3] = length;
  }
  light_[0].write(GL_RGBA, GL_FLOAT, light.data());
  normals_.write(GL_RGBA, GL_FLOAT, normals.data());
  albedo_.write(GL_RGB, GL_FLOAT, picture.albedo.data());
  if (picture.positions.empty()) {
    positions_ = gl::Texture();
    return;
  }
  if (!positions_) positions_ = texture(picture, GL_RGBA32F);
  positions_.write(GL_RGB, GL_FLOAT, picture.positions.data());
}

Filtered EdgeAvoidingFilter::run(const Picture& picture, gl::ProgramCache& programs, gl::PassTimer& timer,
                                 const std::atomic<bool>& cancelled) {
  gl::PassScope scope(timer, "denoiser");
  upload(picture);
  const auto pass = [&](bool smooths, int spacing) {
    programs.get(filter_program(smooths, bool(positions_))).use();
    light_[0].bind(0);
    normals_.bind(1);
    albedo_.bind(2);
    if (positions_) positions_.bind(3);
    for (GLuint unit = 0; unit < 4; ++unit) glBindSampler(unit, 0);
    light_[1].bind_image(0, GL_WRITE_ONLY);
    glUniform1i(0, spacing);
    glDispatchCompute(GLuint((picture.width + kGroup - 1) / kGroup), GLuint((picture.height + kGroup - 1) / kGroup), 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
    std::swap(light_[0], light_[1]);
    stop_if(cancelled);
  };
  pass(true, 1);
  for (int level = 0; level < kLevels; ++level) pass(false, 1 << level);

  const size_t pixels = size_t(picture.width) * size_t(picture.height);
  Filtered filtered{std::vector<float>(4 * pixels), std::vector<float>(pixels)};
  glGetTextureImage(light_[0].id(), 0, GL_RGBA, GL_FLOAT, GLsizei(filtered.pixels.size() * sizeof(float)),
                    filtered.pixels.data());
  for (size_t i = 0; i < pixels; ++i) {
    float* pixel = &filtered.pixels[4 * i];
    const float albedo = brightness_of_albedo(&picture.albedo[3 * i]);
    filtered.variance[i] = std::min(pixel[3] * albedo * albedo, picture.variance[i]);
    for (size_t c = 0; c < 3; ++c)
      pixel[c] = pixel[c] * scattered(picture.albedo[3 * i + c]) + picture.unscattered[3 * i + c];
    pixel[3] = picture.noisy[4 * i + 3];
  }
  return filtered;
}

void EdgeAvoidingFilter::release() { *this = EdgeAvoidingFilter(); }

}  // namespace panoptes::denoise
