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

float unit_float(uint32_t bits) { return float(bits >> 8) * (1.0f / 16777216.0f); }

uint32_t reverse_bits(uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x & 0xff00ff00u) >> 8) | ((x & 0x00ff00ffu) << 8);
  x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
  return ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
}

// A nested (Owen) permutation of the unit interval's 32-bit fractions, as base/packing.glsl has it.
uint32_t owen_scramble(uint32_t x, uint32_t seed) {
  x = reverse_bits(x);
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return reverse_bits(x);
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
  const uint32_t key = hash(seed ^ hash(dimension));
  const uint32_t shuffled = owen_scramble(index, key);
  // The second dimension's generator matrix: each column is the one before, xor itself shifted.
  uint32_t second = 0;
  for (uint32_t i = shuffled, column = 1u << 31; i != 0; i >>= 1, column ^= column >> 1)
    if (i & 1) second ^= column;
  return {unit_float(owen_scramble(reverse_bits(shuffled), hash(key))),
          unit_float(owen_scramble(second, hash(key + 1)))};
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
