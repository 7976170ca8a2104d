// Sums of samples: the same bits however a run is cut, and exact over many samples.
#include "film/sample_sums.h"
#include "support.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace panoptes::test {
namespace {

using film::kBlock;
using film::Piece;
using film::SampleSums;

constexpr size_t kValues = 3;

// Values of all magnitudes and both signs, the same for the same sample.
Piece sample(uint32_t index) {
  std::mt19937 random(index);
  std::uniform_real_distribution<float> exponent(-20, 20), mantissa(-1, 1);
  Piece piece{index, index + 1, {}};
  for (size_t i = 0; i < kValues; ++i)
    piece.sums.push_back(std::ldexp(mantissa(random), int(exponent(random))));
  return piece;
}

SampleSums run(uint32_t first, uint32_t last) {
  SampleSums sums;
  for (uint32_t i = first; i < last; ++i) sums.add(sample(i));
  return sums;
}

// As a film without pieces does it: block by block, each summed before.
SampleSums run_by_blocks(uint32_t first, uint32_t last) {
  SampleSums sums;
  while (first < last) {
    Piece block = sample(first);
    while (block.last < last && block.last % kBlock != 0)
      film::accumulate(block.sums, sample(block.last++).sums);
    first = block.last;
    sums.add(std::move(block));
  }
  return sums;
}

SampleSums merge(const std::vector<SampleSums>& parts) {
  SampleSums sums;
  for (const SampleSums& part : parts)
    for (const Piece& piece : part.pieces()) sums.add(piece);
  return sums;
}

void expect_same(const SampleSums& a, const SampleSums& b) {
  ASSERT_EQ(a.pieces().size(), b.pieces().size());
  for (size_t i = 0; i < a.pieces().size(); ++i) {
    EXPECT_EQ(a.pieces()[i].first, b.pieces()[i].first);
    EXPECT_EQ(a.pieces()[i].last, b.pieces()[i].last);
    EXPECT_EQ(a.pieces()[i].sums, b.pieces()[i].sums);
  }
  EXPECT_EQ(a.total(0, kValues), b.total(0, kValues));
}

TEST(SampleSums, KeepsTheLargestNodesOfARun) {
  const auto spans = [](uint32_t first, uint32_t last) {
    std::vector<std::pair<uint32_t, uint32_t>> found;
    const SampleSums sums = run(first, last);
    for (const Piece& piece : sums.pieces()) {
      EXPECT_TRUE(film::is_piece(piece.first, piece.last));
      found.emplace_back(piece.first, piece.last);
    }
    return found;
  };
  using Spans = std::vector<std::pair<uint32_t, uint32_t>>;
  EXPECT_EQ(spans(0, 40), (Spans{{0, 32}, {32, 40}}));
  EXPECT_EQ(spans(13, 36), (Spans{{13, 14}, {14, 15}, {15, 16}, {16, 32}, {32, 36}}));
  EXPECT_EQ(spans(48, 128), (Spans{{48, 64}, {64, 128}}));
  EXPECT_EQ(spans(7, 9), (Spans{{7, 8}, {8, 9}}));
}

TEST(SampleSums, AnyCutOfARunGivesItsBits) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 200; ++trial) {
    const uint32_t start = trial % 2 ? random() % 100 : 0;
    const uint32_t end = start + 1 + random() % 300;
    std::vector<uint32_t> cuts{start, end};
    for (uint32_t i = random() % 8; i > 0; --i) cuts.push_back(start + random() % (end - start));
    std::sort(cuts.begin(), cuts.end());
    cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
    std::vector<SampleSums> parts;
    for (size_t i = 1; i < cuts.size(); ++i) parts.push_back(run(cuts[i - 1], cuts[i]));
    SCOPED_TRACE(fmt::format("samples {} to {} in {} parts", start, end, parts.size()));
    expect_same(merge(parts), run(start, end));
    // What is merged can be merged again: here the last parts first, then those before.
    if (parts.size() > 2) {
      const SampleSums later = merge({parts.begin() + 1, parts.end()});
      expect_same(merge({parts.front(), later}), run(start, end));
    }
  }
}

TEST(SampleSums, BlocksThatAreSummedBeforeGiveTheSameTotal) {
  for (auto [first, last] : {std::pair{0u, 5u}, {0u, 16u}, {5u, 40u}, {5u, 11u}, {31u, 32u}, {17u, 400u}})
    EXPECT_EQ(run_by_blocks(first, last).total(0, kValues), run(first, last).total(0, kValues))
        << first << " to " << last;
}

TEST(SampleSums, PartsOfTheValuesHaveTheirOwnTotals) {
  const SampleSums sums = run(3, 50);
  const std::vector<float> all = sums.total(0, kValues);
  EXPECT_EQ(sums.total(1, 2), std::vector<float>(all.begin() + 1, all.end()));
  EXPECT_EQ(SampleSums().total(0, 2), std::vector<float>(2));
}

TEST(SampleSums, TwentyThousandSamplesAreSummedToTheLastDigits) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> value(0, 1);
  SampleSums sums;
  double random_sum = 0, bright_sum = 0;
  for (uint32_t i = 0; i < 20000; ++i) {
    const float x = value(random), y = i % 1000 == 0 ? 1e4f * x : x * x;
    random_sum += double(x);
    bright_sum += double(y);
    sums.add({i, i + 1, {0.1f, x, y}});
  }
  const std::vector<float> total = sums.total(0, 3);
  EXPECT_NEAR(total[0] / (20000 * double(0.1f)), 1, 1e-6);
  EXPECT_NEAR(total[1] / random_sum, 1, 1e-6);
  EXPECT_NEAR(total[2] / bright_sum, 1, 1e-6);
  EXPECT_LE(sums.pieces().size(), 12u);
}

TEST(SampleSums, ValuesBelowTheLeastNormalAreNone) {
  std::vector<float> a{1e-39f, 1.5e-38f, 1.0f};
  film::accumulate(a, {1e-39f, -1.0e-38f, 1e-39f});
  EXPECT_EQ(a, (std::vector<float>{0, 0, 1}));
}

TEST(SampleSums, WhatDoesNotFitIsRefused) {
  SampleSums sums = run(0, 20);
  expect_error([&] { sums.add(sample(21)); }, "do not follow");
  expect_error([&] { sums.add(sample(19)); }, "do not follow");
  expect_error([&] { sums.add({20, 21, {1}}); }, "another size");
  expect_error([&] { sums.add({20, 32, {1, 2, 3}}); }, "no piece");
  expect_error([&] { sums.add({20, 20, {1, 2, 3}}); }, "no piece");
  SampleSums blocks = run(0, 16);
  expect_error([&] { blocks.add({16, 40, {1, 2, 3}}); }, "no piece");
  expect_error([&] { blocks.add({16, 48, {1, 2, 3}}); }, "no piece");
  // All of those left it as it was.
  expect_same(sums, run(0, 20));
}

}  // namespace
}  // namespace panoptes::test
