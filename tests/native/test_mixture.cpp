// A mixture of a smooth picture that is off and a noisy one that is right on average.
#include "film/mixture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace panoptes::test {
namespace {

constexpr int kWidth = 64, kHeight = 48;
constexpr size_t kPixels = size_t(kWidth) * kHeight;

using Values = std::vector<float>;

double truth(int x, int y, int c) { return (0.5 + 0.4 * std::sin(0.2 * x) * std::cos(0.15 * y)) * (c == 0 ? 1.0 : c == 1 ? 0.7 : 0.2); }

Values picture(const std::function<double(int x, int y, int c)>& value) {
  Values v(4 * kPixels, 1.0f);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 3; ++c) v[4 * size_t(y * kWidth + x) + size_t(c)] = float(value(x, y, c));
  return v;
}

// The truth times a factor of mean 1 and this standard deviation, and the variance of its brightness.
struct Noisy {
  Values pixels, variance;
};
Noisy noisy(double deviation, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::exponential_distribution<double> sample(1.0);  // as skewed as light is
  Noisy n{picture(truth), Values(kPixels)};
  for (size_t i = 0; i < kPixels; ++i) {
    float* p = &n.pixels[4 * i];
    const double bright = 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2];
    n.variance[i] = float(std::pow(deviation * bright, 2));
    const double factor = 1 + deviation * (sample(random) - 1);
    for (int c = 0; c < 3; ++c) p[c] = float(p[c] * factor);
  }
  return n;
}

double rmse(const Values& found, int from = 0, int to = kWidth) {
  const Values right = picture(truth);
  double sum = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = from; x < to; ++x)
      for (int c = 0; c < 3; ++c) {
        const size_t i = 4 * size_t(y * kWidth + x) + size_t(c);
        sum += std::pow(double(found[i]) - right[i], 2);
      }
  return std::sqrt(sum / (3.0 * kHeight * (to - from)));
}

film::Mixture mix(const Values& smooth, const Noisy& n) { return film::mix_by_error(kWidth, kHeight, smooth, n.pixels, n.variance); }

TEST(Mixture, ASmoothPictureThatIsRightHidesTheNoise) {
  const Noisy n = noisy(0.5);
  const film::Mixture m = mix(picture(truth), n);
  EXPECT_LT(rmse(m.pixels), 0.2 * rmse(n.pixels));
}

TEST(Mixture, IsAsNearToTheTruthAsTheBetterOne) {
  for (double bias : {0.02, 0.1, 0.3})
    for (double deviation : {0.02, 0.1, 0.5}) {
      const Values smooth = picture([&](int x, int y, int c) { return truth(x, y, c) * (1 - bias); });
      const Noisy n = noisy(deviation);
      // A few windows take outliers for bias.
      const double mixed = rmse(mix(smooth, n).pixels), better = std::min(rmse(smooth), rmse(n.pixels));
      EXPECT_LT(mixed, 1.05 * better + 0.05 * rmse(n.pixels)) << bias << " " << deviation << " " << better;
    }
}

TEST(Mixture, ChangesOverWhereLightIsMissingAlone) {
  // The right half lacks a half of its light.
  const Values smooth = picture([](int x, int y, int c) { return truth(x, y, c) * (x < kWidth / 2 ? 1.0 : 0.5); });
  const Noisy n = noisy(0.2);
  const film::Mixture m = mix(smooth, n);
  EXPECT_LT(rmse(m.pixels, 0, kWidth / 2 - 8), 0.25 * rmse(n.pixels, 0, kWidth / 2 - 8));
  EXPECT_LT(rmse(m.pixels, kWidth / 2 + 8, kWidth), 1.1 * rmse(n.pixels, kWidth / 2 + 8, kWidth));
}

TEST(Mixture, BecomesThePictureWithoutNoise) {
  const Values smooth = picture([](int x, int y, int c) { return truth(x, y, c) * 0.9; });
  double before = 1;
  for (double deviation : {0.5, 0.1, 0.02, 0.004}) {
    const Noisy n = noisy(deviation);
    const double apart = rmse(mix(smooth, n).pixels);
    EXPECT_LT(apart, before);
    before = apart;
  }
  EXPECT_EQ(mix(smooth, noisy(0)).pixels, noisy(0).pixels);
}

TEST(Mixture, ADifferenceInColourAloneCounts) {
  // Blue, the darkest, is missing.
  const Values smooth = picture([](int x, int y, int c) { return c == 2 ? 0.0 : truth(x, y, c); });
  const film::Mixture m = mix(smooth, noisy(0.02));
  EXPECT_LT(rmse(m.pixels), 0.3 * rmse(smooth));
}

TEST(Mixture, KeepsTheMeanBrightness) {
  // A smooth picture that is right: what is mixed must not darken by leaving outliers out.
  double mixed = 0, right = 0;
  for (unsigned seed = 0; seed < 20; ++seed)
    for (float v : mix(picture(truth), noisy(1.0, seed)).pixels) mixed += v;
  for (float v : picture(truth)) right += 20 * v;
  EXPECT_NEAR(mixed / right, 1, 0.005);
}

TEST(Mixture, TellsItsError) {
  // A bias that is well below the noise is not seen through it.
  for (double bias : {0.1, 0.3})
    for (double deviation : {0.05, 0.2}) {
      const Values smooth = picture([&](int x, int y, int c) { return truth(x, y, c) * (1 - bias); });
      const film::Mixture m = mix(smooth, noisy(deviation));
      double bright = 0;
      for (size_t i = 0; i < kPixels; ++i)
        bright += 0.2126 * m.pixels[4 * i] + 0.7152 * m.pixels[4 * i + 1] + 0.0722 * m.pixels[4 * i + 2];
      const double right = rmse(m.pixels) / (bright / double(kPixels));
      EXPECT_NEAR(m.error / right, 1, 0.3) << bias << " " << deviation;
    }
}

TEST(Mixture, OfPicturesSmallerThanTheWindow) {
  const Values smooth{1, 1, 1, 1, 2, 2, 2, 1}, noisy{1, 1, 1, 1, 2, 2, 2, 1}, variance{0.1f, 0.1f};
  EXPECT_EQ(film::mix_by_error(2, 1, smooth, noisy, variance).pixels, smooth);
  EXPECT_EQ(film::mix_by_error(1, 2, smooth, noisy, variance).pixels, smooth);
  const Values black(4, 0.0f), none(1, 0.0f);
  EXPECT_EQ(film::mix_by_error(1, 1, black, black, none).error, 0);
}

}  // namespace
}  // namespace panoptes::test
