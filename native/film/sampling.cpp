#include "film/sampling.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace panoptes::film {

namespace {

uint32_t hash(uint32_t x) {  // PCG's permutation, as base/packing.glsl
  const uint32_t state = x * 747796405u + 2891336453u;
  const uint32_t word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}

// (offset + index * step) mod 1 without the loss of low bits that floats would bring.
float recurrence(uint32_t index, uint32_t step, uint32_t offset) {
  return float((offset + index * step) >> 8) * (1.0f / 16777216.0f);
}

// The window's cumulative distribution over [-1, 1].
double cumulative(double x) {
  constexpr double pi = 3.14159265358979323846;
  constexpr double a[4] = {0.35875, 0.48829, 0.14128, 0.01168};
  const double t = 0.5 * (x + 1.0);
  const double sum = a[0] * t - a[1] * std::sin(2 * pi * t) / (2 * pi) +
                     a[2] * std::sin(4 * pi * t) / (4 * pi) -
                     a[3] * std::sin(6 * pi * t) / (6 * pi);
  return sum / a[0];
}

}  // namespace

glm::vec2 sample_point(uint32_t index, uint32_t seed, uint32_t dimension) {
  // 2^32 / p and 2^32 / p^2 for the plastic number p = 1.32471795724474602596.
  const uint32_t first = hash(seed ^ hash(2 * dimension)),
                 second = hash(seed ^ hash(2 * dimension + 1));
  return {recurrence(index, 3242174889u, first), recurrence(index, 2447445414u, second)};
}

float blackman_harris_offset(float u, float width) {
  // The inverse by a table of the forward function; its error is below a thousandth of a pixel.
  constexpr int n = 1024;
  static const std::array<float, n + 1> table = [] {
    std::array<float, n + 1> t{};
    for (int i = 0; i <= n; ++i) t[size_t(i)] = float(cumulative(2.0 * i / n - 1.0));
    return t;
  }();
  const auto above = std::upper_bound(table.begin(), table.end(), u);
  const int i = std::clamp(int(above - table.begin()) - 1, 0, n - 1);
  const float span = table[size_t(i) + 1] - table[size_t(i)];
  const float fraction = span > 0 ? (u - table[size_t(i)]) / span : 0.5f;
  return width * (2.0f * (float(i) + std::clamp(fraction, 0.0f, 1.0f)) / n - 1.0f);
}

}  // namespace panoptes::film
