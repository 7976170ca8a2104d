// Points of the film's samples against numeric quadrature and counting.
#include "film/sampling.h"
#include "support.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace panoptes::test {
namespace {

using film::blackman_harris_offset;
using film::sample_point;

double window(double x) {  // over -1 .. 1
  const double t = kPi * (x + 1);
  return 0.35875 - 0.48829 * std::cos(t) + 0.14128 * std::cos(2 * t) - 0.01168 * std::cos(3 * t);
}

// The integral of x^power * window from -1 to `end`, by the midpoint rule.
double moment(int power, double end) {
  const int n = 20000;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double x = -1 + (end + 1) * (i + 0.5) / n;
    sum += std::pow(x, power) * window(x);
  }
  return sum * (end + 1) / n;
}

TEST(BlackmanHarris, OffsetsAreDistributedAsTheWindow) {
  const int n = 100000;
  for (float width : {1.5f, 0.5f}) {
    std::vector<double> offsets;
    for (int i = 0; i < n; ++i)
      offsets.push_back(blackman_harris_offset((float(i) + 0.5f) / n, width));
    EXPECT_TRUE(std::is_sorted(offsets.begin(), offsets.end()));
    for (int power = 1; power <= 4; ++power) {
      double sum = 0;
      for (double o : offsets) sum += std::pow(o / width, power);
      EXPECT_NEAR(sum / n, moment(power, 1) / moment(0, 1), 1e-4) << "moment " << power;
    }
    for (double x = -0.95; x < 1; x += 0.05) {
      const double share =
          double(std::lower_bound(offsets.begin(), offsets.end(), x * width) - offsets.begin()) / n;
      EXPECT_NEAR(share, moment(0, x) / moment(0, 1), 2e-4) << "below " << x;
    }
  }
}

TEST(BlackmanHarris, IsTheInverseOfItsCumulativeDistribution) {
  // Cycles' default: an edge that passes half a pixel beside the centre is covered by what the
  // window holds beyond it.
  for (double x : {-0.9, -0.5, -0.1, 0.0, 0.3, 1.0 / 3, 0.8}) {
    const double u = moment(0, x) / moment(0, 1);
    EXPECT_NEAR(blackman_harris_offset(float(u), 1.5f), 1.5 * x, 1e-3);
  }
}

TEST(BlackmanHarris, StaysInsideItsWidth) {
  for (float u : {0.0f, 1e-12f, 1e-7f, 0.5f, 0.9999f, 0.99999994f, 1.0f})
    for (float width : {0.0f, 0.01f, 1.5f, 10.0f}) {
      const float offset = blackman_harris_offset(u, width);
      EXPECT_LE(std::abs(offset), width) << u;
    }
  EXPECT_NEAR(blackman_harris_offset(0.5f, 1.5f), 0, 1e-3);
  EXPECT_NEAR(blackman_harris_offset(0.25f, 1.5f), -blackman_harris_offset(0.75f, 1.5f), 1e-4);
}

TEST(SamplePoints, LieInTheUnitSquare) {
  for (uint32_t i = 0; i < 100000; i += 7) {
    const glm::vec2 p = sample_point(i, 3, 1);
    ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
  }
}

TEST(SamplePoints, HitEveryStratum) {
  // 256 random points would leave one of 64 cells empty with a probability of two thirds.
  for (uint32_t seed : {0u, 1u, 12345u})
    for (uint32_t dimension = 0; dimension < 8; ++dimension)
      for (uint32_t first : {0u, 1000u, 4000000000u}) {
        int hits[8][8] = {};
        for (uint32_t i = 0; i < 256; ++i) {
          const glm::vec2 p = sample_point(first + i, seed, dimension);
          ++hits[int(p.y * 8)][int(p.x * 8)];
        }
        for (const auto& row : hits)
          for (int count : row) ASSERT_GT(count, 0) << seed << " " << dimension << " " << first;
      }
}

// The largest difference between area and share of points over anchored boxes on a 64 x 64 grid.
double star_discrepancy(uint32_t count, uint32_t seed, uint32_t dimension) {
  std::vector<glm::vec2> points;
  for (uint32_t i = 0; i < count; ++i) points.push_back(sample_point(i, seed, dimension));
  double worst = 0;
  for (int a = 1; a <= 64; ++a)
    for (int b = 1; b <= 64; ++b) {
      int inside = 0;
      for (const glm::vec2& p : points) inside += p.x < float(a) / 64 && p.y < float(b) / 64;
      worst = std::max(worst, std::abs(inside / double(count) - a * b / 4096.0));
    }
  return worst;
}

TEST(SamplePoints, HaveALowDiscrepancyAtEveryLength) {
  // Random points have about sqrt(log log n / 2n): .06 at 256. A good lattice has a few times
  // log(n)^2 / n at most; .4 log(n)^2 / n is far below random from 64 on.
  for (uint32_t n : {16u, 64u, 100u, 256u})
    for (uint32_t dimension : {0u, 5u}) {
      const double log = std::log(double(n));
      EXPECT_LT(star_discrepancy(n, 9, dimension), 0.4 * log * log / n + 1.0 / n) << n;
    }
}

TEST(SamplePoints, DimensionsAndSeedsAreShiftedApart) {
  std::set<std::pair<float, float>> first;
  for (uint32_t seed = 0; seed < 32; ++seed)
    for (uint32_t dimension = 0; dimension < 32; ++dimension) {
      const glm::vec2 p = sample_point(0, seed, dimension);
      first.insert({p.x, p.y});
    }
  EXPECT_EQ(first.size(), 32u * 32u);
  // Offsets of the dimensions must be spread themselves: no eighth of the line may stay empty.
  int hits[8] = {};
  for (const auto& [x, y] : first) ++hits[int(x * 8)];
  for (int count : hits) EXPECT_GT(count, 64);
}

TEST(SamplePoints, DependOnTheIndexAlone) {
  // Ranges of samples can be rendered apart: the order and the past do not matter.
  std::vector<glm::vec2> forward;
  for (uint32_t i = 0; i < 64; ++i) forward.push_back(sample_point(i, 8, 3));
  for (uint32_t i = 64; i-- > 0;) {
    sample_point(i * 977, 1, 1);
    EXPECT_EQ(sample_point(i, 8, 3), forward[i]);
  }
}

TEST(SamplePoints, EveryElementaryIntervalHoldsOnePoint) {
  // What makes it a (0,2)-sequence: each aligned block of 2^m indices has exactly one point in every
  // 2^-a by 2^(a-m) box, whatever the shape.
  constexpr int m = 6;
  for (uint32_t seed : {0u, 7u})
    for (uint32_t dimension : {0u, 3u})
      for (uint32_t first : {0u, 1u << m, 77u << m})
        for (int a = 0; a <= m; ++a) {
          std::set<std::pair<int, int>> boxes;
          for (uint32_t i = first; i < first + (1u << m); ++i) {
            const glm::vec2 p = sample_point(i, seed, dimension);
            ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
            boxes.insert({int(p.x * float(1 << a)), int(p.y * float(1 << (m - a)))});
          }
          EXPECT_EQ(boxes.size(), size_t(1) << m) << "boxes 2^-" << a;
        }
}

TEST(SamplePoints, SequencesAreIndependent) {
  // Correlation of the same index in two sequences: 1 / sqrt(n) would be chance.
  const int n = 4096;
  for (uint32_t other : {1u, 2u, 9u}) {
    double sum = 0;
    for (uint32_t i = 0; i < n; ++i)
      sum += (sample_point(i, 5, 0).x - 0.5) * (sample_point(i, 5, other).x - 0.5);
    EXPECT_LT(std::abs(sum / n * 12), 4 / std::sqrt(double(n)));
  }
}

}  // namespace
}  // namespace panoptes::test
