#include "film/mixture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace panoptes::film {

namespace {

// Pixels to each side about one that tell its bias: fewer take noise for it, more blur it over edges.
constexpr int kRadius = 6;

// What is less than so much of the noise may be noise itself: light has outliers, and so has what is told of it. Left
// out where it is bias after all, it costs a seventh more than the least error.
constexpr double kDoubt = 0.5;

// What is averaged about each pixel.
struct Local {
  double difference = 0;  // squared, the mean of the colours
  double variance = 0;    // of brightness
  double red = 0, green = 0, blue = 0;

  Local& operator+=(const Local& o) {
    difference += o.difference, variance += o.variance, red += o.red, green += o.green, blue += o.blue;
    return *this;
  }
  Local& operator-=(const Local& o) {
    difference -= o.difference, variance -= o.variance, red -= o.red, green -= o.green, blue -= o.blue;
    return *this;
  }
};

double brightness(double red, double green, double blue) { return 0.2126 * red + 0.7152 * green + 0.0722 * blue; }

// Sums over the window along a line of `count` values, `stride` apart.
void sum_line(const Local* from, Local* to, int count, size_t stride) {
  Local sum;
  for (int i = 0; i < std::min(kRadius, count); ++i) sum += from[size_t(i) * stride];
  for (int i = 0; i < count; ++i) {
    if (i + kRadius < count) sum += from[size_t(i + kRadius) * stride];
    if (i - kRadius - 1 >= 0) sum -= from[size_t(i - kRadius - 1) * stride];
    to[size_t(i) * stride] = sum;
  }
}

std::vector<Local> sums_about(int width, int height, std::vector<Local> values) {
  std::vector<Local> across(values.size());
  for (int y = 0; y < height; ++y) {
    const size_t row = size_t(y) * size_t(width);
    sum_line(&values[row], &across[row], width, 1);
  }
  for (int x = 0; x < width; ++x) sum_line(&across[size_t(x)], &values[size_t(x)], height, size_t(width));
  return values;
}

// Of a window's sums: squares of the bias of the smooth picture, and of the noise of the other.
struct Errors {
  double bias = 0, noise = 0;
  double colour = 1;  // the mean square of colours by that of their brightness
};

Errors errors_of(const Local& sums, int pixels) {
  const double bright = brightness(sums.red, sums.green, sums.blue);
  const double squares = (sums.red * sums.red + sums.green * sums.green + sums.blue * sums.blue) / 3;
  Errors e;
  // Running sums may end a little below 0.
  if (bright > 0) e.colour = squares / (bright * bright);
  e.noise = std::max(sums.variance, 0.0) / pixels * e.colour;
  e.bias = std::max(sums.difference / pixels - e.noise, 0.0);
  return e;
}

int window(int i, int count) { return std::min(i + kRadius, count - 1) - std::max(i - kRadius, 0) + 1; }

}  // namespace

Mixture mix_by_error(int width, int height, std::span<const float> smooth, std::span<const float> noisy,
                     std::span<const float> variance, std::span<const float> shared) {
  const size_t count = size_t(width) * size_t(height);
  std::vector<Local> local(count);
  for (size_t i = 0; i < count; ++i) {
    const float *s = &smooth[4 * i], *n = &noisy[4 * i];
    double squares = 0;
    for (int c = 0; c < 3; ++c) squares += (double(n[c]) - s[c]) * (double(n[c]) - s[c]);
    // As if each pixel had kept a share of its own noise. Where it comes from others' instead, the noise is
    // taken for too little, by less than the doubt.
    double excess = variance[i];
    if (!shared.empty()) excess = std::pow(std::sqrt(excess) - std::sqrt(double(shared[i])), 2);
    local[i] = {squares / 3, excess, n[0], n[1], n[2]};
  }
  local = sums_about(width, height, std::move(local));

  Mixture mixture{std::vector<float>(4 * count), 0, std::vector<float>(count)};
  double squares = 0, bright = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const size_t i = size_t(y) * size_t(width) + size_t(x);
      const Errors e = errors_of(local[i], window(x, width) * window(y, height));
      const double bias = std::max(e.bias - kDoubt * e.noise, 0.0), both = bias + e.noise;
      const double weight = both > 0 ? bias / both : 1.0;
      double square = (1 - weight) * (1 - weight) * e.bias + weight * weight * e.noise;
      if (!shared.empty()) square += e.colour * shared[i];
      squares += square;
      mixture.variance[i] = float(square / e.colour);
      float* pixel = &mixture.pixels[4 * i];
      for (int c = 0; c < 4; ++c) pixel[c] = float(smooth[4 * i + c] + weight * (double(noisy[4 * i + c]) - smooth[4 * i + c]));
      bright += brightness(pixel[0], pixel[1], pixel[2]);
    }
  if (bright > 0) mixture.error = std::sqrt(squares / double(count)) / (bright / double(count));
  return mixture;
}

}  // namespace panoptes::film
