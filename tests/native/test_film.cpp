// The film on the device: its sums against those of the host, whatever the range and the block, what
// is no number, and pixels that stop.
#include "film/film.h"
#include "gl/context.h"
#include "support.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace panoptes::test {
namespace {

using film::Film;
using film::Pass;

constexpr int kWidth = 7, kHeight = 3;
constexpr size_t kPixels = kWidth * kHeight;

// Adds a value of the host's to each pixel that wants one: to Combined, and twice that to Normal.
const char* const kAdd = R"(
#include "film/film.glsl"
layout(local_size_x = 32) in;
layout(std430, binding = 0) readonly buffer Values { vec4 values[]; };
layout(std430, binding = 1) readonly buffer Pixels { uint pixels[]; };
layout(location = 0) uniform int count;
void main() {
  int slot = int(gl_GlobalInvocationID.x);
  if (slot >= count) return;
#if LISTED
  int number = int(pixels[slot]);
#else
  int number = slot;
#endif
  ivec2 pixel = ivec2(number % WIDTH, number / WIDTH);
  film_add(FILM_COMBINED, pixel, values[number]);
#ifdef FILM_NORMAL
  film_add(FILM_NORMAL, pixel, 2.0 * values[number]);
#endif
#if FIRST && defined(FILM_DEPTH)
  film_add(FILM_DEPTH, pixel, vec4(values[number].x));
#endif
}
)";

class FilmTest : public ::testing::Test {
 protected:
  // The value of a pixel in a sample.
  using Values = std::function<glm::vec4(uint32_t sample, size_t pixel)>;

  void add(Film& film, uint32_t sample, bool first, const Values& values) {
    std::vector<glm::vec4> list(kPixels);
    for (size_t i = 0; i < kPixels; ++i) list[i] = values(sample, i);
    values_.reserve(int64_t(kPixels * sizeof(glm::vec4)));
    values_.write(0, int64_t(kPixels * sizeof(glm::vec4)), list.data());
    gl::ProgramSource source;
    source.name = "film test";
    source.stages = {{GL_COMPUTE_SHADER, "generated/film_test.comp"}};
    source.snippets["generated/film_test.comp"] = kAdd;
    source.defines = {fmt::format("WIDTH {}", kWidth), fmt::format("FIRST {}", int(first)),
                      fmt::format("LISTED {}", int(!film.all_active()))};
    film.add_defines(source);
    programs_.get(source).use();
    film.bind();
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, values_.id());
    if (!film.all_active())
      glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, film.active_pixels().id());
    glUniform1i(0, film.all_active() ? int(kPixels) : film.active_count());
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
    film.end_sample(sample);
  }

  void run(Film& film, uint32_t first, uint32_t last, const Values& values) {
    for (uint32_t i = first; i < last; ++i) add(film, i, i == first, values);
  }

  gl::Context context_;
  gl::ProgramCache programs_;
  gl::Buffer values_;
};

glm::vec4 random_value(uint32_t sample, size_t pixel) {
  std::mt19937 random(sample * 1000 + uint32_t(pixel));
  std::uniform_real_distribution<float> value(-1, 3);
  return {value(random), value(random), value(random), 1};
}

TEST_F(FilmTest, AveragesWhatWasAddedAfterEverySample) {
  Film film;
  film.start(kWidth, kHeight, pass_set({Pass::kNormal, Pass::kDepth, Pass::kSampleCount}));
  std::vector<glm::dvec4> sums(kPixels);
  for (uint32_t i = 3; i < 40; ++i) {
    add(film, i, i == 3, random_value);
    const std::vector<float> combined = film.read(Pass::kCombined, 2.0f);
    const std::vector<float> normal = film.read(Pass::kNormal, 2.0f);
    const std::vector<float> depth = film.read(Pass::kDepth, 2.0f);
    ASSERT_EQ(normal.size(), kPixels * 3);
    for (size_t p = 0; p < kPixels; ++p) {
      sums[p] += glm::dvec4(random_value(i, p));
      for (size_t c = 0; c < 4; ++c)
        ASSERT_NEAR(combined[4 * p + c], (c < 3 ? 2 : 1) * sums[p][int(c)] / (i - 2), 2e-6);
      for (size_t c = 0; c < 3; ++c)
        ASSERT_NEAR(normal[3 * p + c], 2 * sums[p][int(c)] / (i - 2), 2e-6);
      ASSERT_EQ(depth[p], random_value(3, p).x);
    }
    EXPECT_EQ(film.read(Pass::kSampleCount, 2.0f), std::vector<float>(kPixels, 1.0f));
    EXPECT_EQ(film.samples(), i - 2);
  }
  expect_error([&] { film.read(Pass::kEmit, 1); }, "'Emit' was not rendered");
}

TEST_F(FilmTest, RangesHaveTheBitsOfOneRun) {
  const film::PassSet passes = pass_set({Pass::kNormal, Pass::kDepth});
  Film film;
  film.start(kWidth, kHeight, passes);
  run(film, 0, 70, random_value);
  const std::vector<float> combined = film.read(Pass::kCombined, 1.5f);
  const std::vector<float> normal = film.read(Pass::kNormal, 1.5f);

  film::SampleSums merged;
  std::vector<float> depth;
  for (auto [first, last] : {std::pair{0u, 5u}, {5u, 24u}, {24u, 41u}, {41u, 70u}}) {
    film.start(kWidth, kHeight, passes, {.pieces = true});
    run(film, first, last, random_value);
    const film::Pieces pieces = film.take_pieces(1.5f);
    EXPECT_EQ(pieces.sums.first(), first);
    EXPECT_EQ(pieces.sums.last(), last);
    for (const film::Piece& piece : pieces.sums.pieces()) merged.add(piece);
    if (first == 0) depth = pieces.firsts.at(Pass::kDepth);
  }
  const film::Layout layout(kPixels, film::with_divisors(passes));
  const auto average = [&](Pass pass) {
    return film::average(pass, merged.total(layout.begin(pass), layout.size(pass)), {}, {70, {}},
                         1.5f);
  };
  EXPECT_EQ(average(Pass::kCombined), combined);
  EXPECT_EQ(average(Pass::kNormal), normal);
  for (size_t p = 0; p < kPixels; ++p) EXPECT_EQ(depth[p], random_value(0, p).x);
}

TEST_F(FilmTest, TwentyThousandSamplesAreAveragedToTheLastDigits) {
  Film film;
  film.start(kWidth, kHeight, {});
  const auto values = [](uint32_t sample, size_t pixel) {
    // A small constant in one half, and the fractions of a golden sequence in the other.
    const double turn = sample * 0.6180339887498949;
    return pixel % 2 ? glm::vec4(0.1f) : glm::vec4(float(turn - std::floor(turn)));
  };
  run(film, 0, 20000, values);
  const std::vector<float> found = film.read(Pass::kCombined, 1.0f);
  double sum = 0;
  for (uint32_t i = 0; i < 20000; ++i) sum += double(values(i, 0).x);
  EXPECT_NEAR(found[0] / (sum / 20000), 1, 1e-6);
  EXPECT_NEAR(found[4] / double(0.1f), 1, 1e-6);
}

TEST_F(FilmTest, WhatIsNoNumberCountsAsBlackAndIsCounted) {
  Film film;
  film.start(kWidth, kHeight, pass_set({Pass::kNormal}), {.moments = true});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  run(film, 0, 4, [&](uint32_t sample, size_t pixel) {
    if (sample == 1 && pixel == 3) return glm::vec4(nan, 1, 1, 1);
    if (sample == 2 && pixel == 3) return glm::vec4(1, 1, -infinity, 1);
    if (sample == 2 && pixel == 4) return glm::vec4(1, 1, 1, nan);
    return glm::vec4(1);
  });
  EXPECT_EQ(film.spoiled_samples(), 2u);
  const std::vector<float> combined = film.read(Pass::kCombined, 1.0f);
  const auto pixel = [&](size_t p) {
    return std::vector<float>(combined.begin() + std::ptrdiff_t(4 * p),
                              combined.begin() + std::ptrdiff_t(4 * p + 4));
  };
  EXPECT_EQ(pixel(0), (std::vector<float>{1, 1, 1, 1}));
  EXPECT_EQ(pixel(3), (std::vector<float>{0.5f, 0.5f, 0.5f, 1}));
  EXPECT_EQ(pixel(4), (std::vector<float>{1, 1, 1, 0.75f}));
  EXPECT_EQ(film.read(Pass::kNormal, 1.0f)[9], 1.0f);
  ASSERT_TRUE(film.estimated_error());
  EXPECT_TRUE(std::isfinite(*film.estimated_error()));
  film.start(kWidth, kHeight, {});
  EXPECT_EQ(film.spoiled_samples(), 0u);
}

TEST_F(FilmTest, PixelsStopOnceTheirNoiseIsLowEnough) {
  // Noise in the first columns alone; the column beside it goes on as a neighbour.
  const auto values = [](uint32_t sample, size_t pixel) {
    if (pixel % kWidth >= 2) return glm::vec4(0.25f);
    return glm::vec4(0.5f + 0.3f * random_value(sample, pixel).x / 3);
  };
  Film film;
  film.start(kWidth, kHeight, pass_set({Pass::kSampleCount}),
             {.moments = true, .noise_threshold = 0.02});
  ASSERT_FALSE(film.all_active());
  uint32_t sample = 0;
  for (; sample < 500 && film.active_count() > 0; ++sample) {
    if (sample < film::kBlock)
      EXPECT_EQ(film.active_count(), int(kPixels));
    else if (sample < 2 * film::kBlock)
      EXPECT_EQ(film.active_count(), 3 * kHeight);
    add(film, sample, sample == 0, values);
  }
  EXPECT_GT(sample, 2 * film::kBlock);
  EXPECT_LT(sample, 500u) << "no end";
  const std::vector<float> shares = film.read(Pass::kSampleCount, 1.0f);
  const std::vector<float> picture = film.read(Pass::kCombined, 1.0f);
  for (size_t p = 0; p < kPixels; ++p) {
    if (p % kWidth >= 3) {
      EXPECT_EQ(shares[p], float(film::kBlock) / float(sample));
    }
    if (p % kWidth >= 2) {
      EXPECT_EQ(picture[4 * p], 0.25f);
    } else {
      const uint32_t count = uint32_t(std::lround(shares[p] * float(sample)));
      double sum = 0;
      for (uint32_t i = 0; i < count; ++i) sum += double(values(i, p).x);
      EXPECT_NEAR(picture[4 * p], sum / count, 1e-6) << p << " after " << count;
    }
  }
  ASSERT_TRUE(film.estimated_error());
  EXPECT_LT(*film.estimated_error(), 0.02);
}

TEST(FilmNoise, EstimatesTheStandardErrorOfTheMean) {
  // Samples of 0 and 1 in turns: the variance of a single one is 1/4, that of the mean 1/4 / (n - 1).
  const std::vector<film::Moments> moments(4, {50, 50});
  const std::optional<double> error = film::relative_error(moments, {100, {}});
  ASSERT_TRUE(error);
  EXPECT_NEAR(*error, std::sqrt(0.25 / 99) / 0.5, 1e-12);
  EXPECT_FALSE(film::relative_error(moments, {1, {}}));
  EXPECT_EQ(film::relative_error(std::vector<film::Moments>(4), {9, {}}), 0.0);
}

TEST(FilmNoise, DarkPixelsAreHeldToAHundredthOfTheMean) {
  // A row of ten: nine bright and without noise, one with the noise of a thousandth of the mean.
  std::vector<film::Moments> moments(10, {100, 100});
  const double mean = 1e-4, deviation = 1e-3;
  moments[9] = {100 * mean, 100 * (mean * mean + deviation * deviation)};
  const film::SampleCounts counts{100, {}};
  EXPECT_TRUE(film::noisy_pixels(moments, counts, 10, 1, 0.02).empty());
  EXPECT_EQ(film::noisy_pixels(moments, counts, 10, 1, 0.01), (std::vector<uint32_t>{8, 9}));
}

}  // namespace
}  // namespace panoptes::test
