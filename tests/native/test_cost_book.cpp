// Which ray tracer a frame takes, from what they have been seen to cost.
#include "tracing/cost_book.h"

#include <gtest/gtest.h>

#include <array>

namespace panoptes::test {
namespace {

using tracing::CostBook;

const std::array<std::string, 2> kBoth{"orthographic", "bvh"};

TEST(CostBook, FewRaysTakeWhatBuildsFastAndManyWhatTracesFast) {
  CostBook book;
  EXPECT_EQ(book.choose(kBoth, "", 1'000'000, 1000), "orthographic");
  EXPECT_EQ(book.choose(kBoth, "", 1000, 100'000'000), "bvh");
}

TEST(CostBook, AStructureThatStandsCostsNoBuild) {
  CostBook book;
  for (const std::string& built : kBoth) EXPECT_EQ(book.choose(kBoth, built, 10'000'000, 1000), built);
  // But it is left when the other pays for itself.
  EXPECT_EQ(book.choose(kBoth, "orthographic", 100'000, 1'000'000'000), "bvh");
}

TEST(CostBook, MeasurementsReplaceGuesses) {
  CostBook book;
  // A device on which the hierarchy is built on a slow host, and traces no faster.
  for (int i = 0; i < 4; ++i) {
    book.add_build("bvh", 1'000'000, 500);
    book.add_build("orthographic", 1'000'000, 5);
    book.add_trace("bvh", 1'000'000, 1);
    book.add_trace("orthographic", 1'000'000, 1);
  }
  EXPECT_EQ(book.choose(kBoth, "", 1'000'000, 400'000'000), "orthographic");
  // Then the scene turns out to be one that it traces ten times faster.
  for (int i = 0; i < 8; ++i) book.add_trace("bvh", 1'000'000, 0.1);
  EXPECT_EQ(book.choose(kBoth, "", 1'000'000, 4'000'000'000), "bvh");
  EXPECT_EQ(book.choose(kBoth, "", 1'000'000, 1'000'000), "orthographic");
}

TEST(CostBook, OneTracerTellsHowFastTheDeviceIs) {
  CostBook book;
  // A hundred times faster at both than software: the choice stays in proportion.
  book.add_build("orthographic", 1'000'000, 1.9);
  book.add_trace("orthographic", 1'000'000, 7.7);
  const CostBook fresh;
  for (const int64_t rays : {1000, 100'000, 1'000'000, 10'000'000, 1'000'000'000})
    EXPECT_EQ(book.choose(kBoth, "", 1'000'000, rays), fresh.choose(kBoth, "", 1'000'000, rays));
}

TEST(CostBook, HandfulsTeachNothing) {
  CostBook book;
  book.add_build("orthographic", 12, 5);
  book.add_trace("bvh", 1, 5);
  EXPECT_EQ(book.choose(kBoth, "", 1'000'000, 1000), "orthographic");
  EXPECT_EQ(book.choose(kBoth, "", 1000, 100'000'000), "bvh");
}

}  // namespace
}  // namespace panoptes::test
