// The bookkeeping of the geometry heaps against a naive model.
#include "gpu_scene/heap.h"
#include "support.h"

#include <random>

namespace panoptes::test {
namespace {

using gpu_scene::Range;
using gpu_scene::RangeAllocator;

// Which elements are taken, one flag each.
class Model {
 public:
  void grow(uint32_t capacity) { taken_.resize(capacity, false); }
  bool free(const Range& r) const {
    for (uint32_t i = r.first; i < r.first + r.count; ++i)
      if (i >= taken_.size() || taken_[i]) return false;
    return true;
  }
  bool fits(uint32_t count) const {
    uint32_t run = 0;
    for (bool taken : taken_) {
      run = taken ? 0 : run + 1;
      if (run >= count) return true;
    }
    return false;
  }
  void set(const Range& r, bool taken) {
    for (uint32_t i = r.first; i < r.first + r.count; ++i) taken_[i] = taken;
  }

 private:
  std::vector<bool> taken_;
};

TEST(RangeAllocator, AgreesWithANaiveModel) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    RangeAllocator allocator;
    Model model;
    uint32_t capacity = 64;
    allocator.grow(capacity);
    model.grow(capacity);
    std::vector<Range> held;
    int full = 0;
    for (int step = 0; step < 3000; ++step) {
      const uint32_t dice = random() % 100;
      if (dice < 55) {
        const uint32_t count = 1 + random() % (dice < 5 ? 100 : 12);
        const Range range = allocator.allocate(count);
        if (range.first == RangeAllocator::kFull) {
          ASSERT_FALSE(model.fits(count)) << "there was room for " << count;
          ASSERT_EQ(range.count, 0u);
          ++full;
        } else {
          ASSERT_EQ(range.count, count);
          ASSERT_TRUE(model.free(range)) << range.first << " + " << range.count;
          model.set(range, true);
          held.push_back(range);
        }
      } else if (dice < 99 && !held.empty()) {
        const size_t which = random() % held.size();
        allocator.release(held[which]);
        model.set(held[which], false);
        held[which] = held.back();
        held.pop_back();
      } else if (capacity < 400) {
        capacity += random() % 30;
        allocator.grow(capacity);
        model.grow(capacity);
        ASSERT_EQ(allocator.capacity(), capacity);
      }
    }
    EXPECT_GT(full, 0) << "the model never filled up: nothing was tested there";
    // Whatever the order of releases was, the space is one piece again.
    for (const Range& range : held) allocator.release(range);
    const Range all = allocator.allocate(capacity);
    EXPECT_EQ(all.first, 0u);
    EXPECT_EQ(all.count, capacity);
  }
}

TEST(RangeAllocator, MergesNeighboursInEveryOrder) {
  int order[3] = {0, 1, 2};
  do {
    RangeAllocator allocator;
    allocator.grow(9);
    Range parts[3];
    for (Range& part : parts) part = allocator.allocate(3);
    EXPECT_EQ(allocator.allocate(1).first, RangeAllocator::kFull);
    for (int i : order) allocator.release(parts[i]);
    EXPECT_EQ(allocator.allocate(9).count, 9u);
  } while (std::next_permutation(order, order + 3));
}

TEST(RangeAllocator, GrowthJoinsTheFreeEnd) {
  RangeAllocator allocator;
  EXPECT_EQ(allocator.allocate(1).first, RangeAllocator::kFull);
  allocator.grow(4);
  const Range a = allocator.allocate(3);
  allocator.grow(10);
  const Range b = allocator.allocate(7);  // the last of the old and all of the new
  EXPECT_EQ(a.first, 0u);
  EXPECT_EQ(b.first, 3u);
  EXPECT_EQ(b.count, 7u);
  allocator.grow(5);  // never shrinks
  EXPECT_EQ(allocator.capacity(), 10u);
}

TEST(RangeAllocator, EmptyRangesCostNothing) {
  RangeAllocator allocator;
  EXPECT_EQ(allocator.allocate(0).count, 0u);
  allocator.grow(2);
  EXPECT_EQ(allocator.allocate(0).count, 0u);
  allocator.release({});
  allocator.release({1, 0});
  EXPECT_EQ(allocator.allocate(2).first, 0u);
  EXPECT_EQ(allocator.allocate(1).first, RangeAllocator::kFull);
}

}  // namespace
}  // namespace panoptes::test
