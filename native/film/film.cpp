#include "film/film.h"

#include "base/error.h"

#include <algorithm>
#include <cmath>

namespace panoptes::film {

void Film::start(int width, int height, const PassSet& wanted, bool moments) {
  const PassSet passes = with_divisors(wanted);
  if (width != width_ || height != height_ || passes != passes_ || moments != moments_) {
    sums_ = gl::Texture();
    int count = 0;
    for (int i = 0; i < kPassCount; ++i)
      if (passes[size_t(i)]) layers_[i] = count++;
    moments_layer_ = count;
    if (moments) ++count;
    sums_ = gl::Texture({GL_TEXTURE_2D_ARRAY, GL_RGBA32F, width, height, count, 1});
    width_ = width;
    height_ = height;
    passes_ = passes;
    moments_ = moments;
  }
  const float zero[4] = {0, 0, 0, 0};
  glClearTexImage(sums_.id(), 0, GL_RGBA, GL_FLOAT, zero);
}

void Film::add_defines(gl::ProgramSource& source) const {
  for (int i = 0; i < kPassCount; ++i)
    if (passes_[size_t(i)])
      source.defines.push_back(fmt::format("{} {}", kPasses[size_t(i)].define, layers_[i]));
  if (moments_) source.defines.push_back(fmt::format("FILM_MOMENTS {}", moments_layer_));
}

void Film::bind() const {
  sums_.bind_image(7, GL_WRITE_ONLY);
  sums_.bind(8);
  glBindSampler(8, 0);  // one of a material's images may still sit there
}

std::vector<float> Film::layer(int index) const {
  std::vector<float> values(size_t(width_) * size_t(height_) * 4);
  glGetTextureSubImage(sums_.id(), 0, 0, 0, index, width_, height_, 1, GL_RGBA, GL_FLOAT,
                       GLsizei(values.size() * sizeof(float)), values.data());
  return values;
}

std::vector<float> Film::read(Pass pass, int samples, float exposure) const {
  const PassInfo& p = info(pass);
  if (!passes_[size_t(pass)])
    fail("pass '{}' was not rendered: enable it in the view layer and render again", p.name);
  const std::vector<float> sums = layer(layers_[size_t(pass)]);
  const size_t pixels = size_t(width_) * size_t(height_);
  std::vector<float> result(pixels * size_t(p.channels));
  const bool divide = p.divisor != pass;
  const std::vector<float> divisor =
      divide ? layer(layers_[size_t(p.divisor)]) : std::vector<float>();
  const float scale = (p.light ? exposure : 1.0f) /
                      (divide || pass == Pass::kDepth ? 1.0f : float(std::max(samples, 1)));
  for (size_t i = 0; i < pixels; ++i)
    for (int c = 0; c < p.channels; ++c) {
      float value = sums[i * 4 + size_t(c)];
      if (divide) {
        const float d = divisor[i * 4 + size_t(c)];
        value = d > 0 ? value / d : 0.0f;
      }
      // Coverage (the fourth channel) is no light.
      result[i * size_t(p.channels) + size_t(c)] =
          value * (c == 3 ? 1.0f / float(std::max(samples, 1)) : scale);
    }
  return result;
}

std::optional<double> Film::estimated_error(int samples) const {
  if (!moments_ || samples < 2) return std::nullopt;
  const std::vector<float> sums = layer(moments_layer_);
  double variance = 0, mean = 0;
  for (size_t i = 0; i < sums.size(); i += 4) {
    const double m = sums[i] / samples;
    const double v = std::max(sums[i + 1] / samples - m * m, 0.0) / (samples - 1);
    variance += v;
    mean += m;
  }
  const double pixels = double(sums.size() / 4);
  mean /= pixels;
  return mean > 0 ? std::sqrt(variance / pixels) / mean : 0.0;
}

}  // namespace panoptes::film
