#include "film/noise.h"

#include <algorithm>
#include <cmath>

namespace panoptes::film {

namespace {

constexpr double kDarkest = 0.01;  // of the picture's mean brightness

struct Estimate {
  double mean = 0, variance = 0;  // of the brightness, and of that mean
};

Estimate estimate(const Moments& moments, uint32_t count) {
  if (count < 2) return {count ? moments.sum : 0.0, 0.0};
  const double mean = moments.sum / count;
  return {mean, std::max(moments.squares / count - mean * mean, 0.0) / (count - 1)};
}

double mean_brightness(std::span<const Moments> moments, const SampleCounts& counts) {
  double sum = 0;
  for (size_t i = 0; i < moments.size(); ++i) sum += estimate(moments[i], counts.of(i)).mean;
  return moments.empty() ? 0.0 : sum / double(moments.size());
}

}  // namespace

std::optional<double> relative_error(std::span<const Moments> moments,
                                     const SampleCounts& counts) {
  if (moments.empty() || counts.all < 2) return std::nullopt;
  double variance = 0;
  for (size_t i = 0; i < moments.size(); ++i)
    variance += estimate(moments[i], counts.of(i)).variance;
  const double mean = mean_brightness(moments, counts);
  return mean > 0 ? std::sqrt(variance / double(moments.size())) / mean : 0.0;
}

std::vector<float> variances(std::span<const Moments> moments, const SampleCounts& counts, float scale) {
  std::vector<float> found(moments.size());
  for (size_t i = 0; i < moments.size(); ++i)
    found[i] = float(estimate(moments[i], counts.of(i)).variance * scale * scale);
  return found;
}

std::vector<uint32_t> noisy_pixels(std::span<const Moments> moments, const SampleCounts& counts,
                                   int width, int height, double threshold) {
  const double darkest = kDarkest * mean_brightness(moments, counts);
  std::vector<uint8_t> wanted(moments.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const size_t pixel = size_t(y) * size_t(width) + size_t(x);
      const Estimate e = estimate(moments[pixel], counts.of(pixel));
      if (std::sqrt(e.variance) <= threshold * std::max(e.mean, darkest)) continue;
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u)
          wanted[size_t(v) * size_t(width) + size_t(u)] = 1;
    }
  std::vector<uint32_t> pixels;
  for (size_t i = 0; i < wanted.size(); ++i)
    if (wanted[i]) pixels.push_back(uint32_t(i));
  return pixels;
}

}  // namespace panoptes::film
