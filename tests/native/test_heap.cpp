// The bookkeeping of what lies where on the GPU, against naive models.
#include "gpu_scene/heap.h"
#include "gpu_scene/placement.h"
#include "support.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

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

TEST(RangeAllocator, GrowsByHalfOrByWhatIsNeeded) {
  RangeAllocator allocator;
  EXPECT_EQ(allocator.allocate_or_grow(10).count, 10u);
  EXPECT_EQ(allocator.capacity(), 10u);
  EXPECT_EQ(allocator.allocate_or_grow(2).first, 10u);
  EXPECT_EQ(allocator.capacity(), 15u);
  EXPECT_EQ(allocator.allocate_or_grow(100).count, 100u);
  EXPECT_EQ(allocator.capacity(), 115u);
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

// --- placement
// ---------------------------------------------------------------------------------------

// The elements in which two arrays differ, one by one.
std::vector<size_t> differences(const std::vector<uint32_t>& a, const std::vector<uint32_t>& b) {
  std::vector<size_t> found;
  for (size_t i = 0; i < a.size(); ++i)
    if (a[i] != b[i]) found.push_back(i);
  return found;
}

// Elements of `now` that are not what `before` had there.
size_t rewritten(const std::vector<uint32_t>& before, const std::vector<uint32_t>& now) {
  size_t count = 0;
  for (size_t i = 0; i < now.size(); ++i) count += i >= before.size() || before[i] != now[i];
  return count;
}

TEST(Placement, HoldsJustTheItemsWhereItSays) {
  std::mt19937 random(5);
  std::vector<uint32_t> placed;
  for (int step = 0; step < 300; ++step) {
    std::vector<uint32_t> items(random() % 40);
    for (uint32_t& item : items) item = random() % 50;  // with equal ones
    const std::vector<uint32_t> before = placed, places = gpu_scene::place(items, placed);
    ASSERT_EQ(placed.size(), items.size());
    std::vector<bool> taken(items.size(), false);
    for (size_t i = 0; i < items.size(); ++i) {
      ASSERT_EQ(placed[places[i]], items[i]);
      ASSERT_FALSE(taken[places[i]]);
      taken[places[i]] = true;
    }
    // Whatever could stay, stays: an item moves only into a place whose own item is gone.
    std::multiset<uint32_t> all(items.begin(), items.end());
    size_t may_stay = 0;
    for (size_t i = 0; i < std::min(before.size(), items.size()); ++i)
      if (const auto found = all.find(before[i]); found != all.end()) {
        all.erase(found);
        ++may_stay;
      }
    EXPECT_EQ(rewritten(before, placed), items.size() - may_stay);
  }
}

TEST(Placement, AnEditRewritesOneItem) {
  std::vector<uint32_t> items(1000), placed;
  for (uint32_t i = 0; i < 1000; ++i) items[i] = i * 7;
  const std::vector<uint32_t> identity = gpu_scene::place(items, placed);
  EXPECT_EQ(placed, items);
  std::vector<uint32_t> before = placed;
  items.erase(items.begin() + 3);  // all that follow move up in the list
  gpu_scene::place(items, placed);
  EXPECT_EQ(rewritten(before, placed), 1u);
  before = placed;
  items.insert(items.begin() + 500, 1u);
  gpu_scene::place(items, placed);
  EXPECT_EQ(rewritten(before, placed), 1u);
  before = placed;
  std::reverse(items.begin(), items.end());
  gpu_scene::place(items, placed);
  EXPECT_EQ(rewritten(before, placed), 0u);
}

// --- runs
// --------------------------------------------------------------------------------------------

using RunList = std::vector<Run>;  // tests have a Run of their own

TEST(Runs, CoverAllDifferencesAndLittleElse) {
  std::mt19937 random(11);
  for (size_t gap : {0, 1, 5, 300}) {
    for (int step = 0; step < 100; ++step) {
      std::vector<uint32_t> a(random() % 2000);
      std::vector<uint32_t> b = a;
      for (size_t edits = random() % 20; edits > 0 && !a.empty(); --edits)
        b[random() % b.size()] = 1;
      const RunList runs =
          differing_runs(std::span<const uint32_t>(a), std::span<const uint32_t>(b), gap);
      const std::vector<size_t> due = differences(a, b);
      size_t next = 0, end = 0;
      for (const auto& run : runs) {
        ASSERT_GT(run.count, 0u);
        if (end > 0) {
          ASSERT_GT(run.first, end + gap) << "closer runs are one";
        }
        end = run.first + run.count;
        ASSERT_LT(next, due.size());
        EXPECT_EQ(run.first, due[next]) << "a run begins and ends with a difference";
        while (next < due.size() && due[next] < end) ++next;
        EXPECT_EQ(end, due[next - 1] + 1);
      }
      EXPECT_EQ(next, due.size()) << "gap " << gap;
    }
  }
}

TEST(Runs, CompareBits) {
  const float nan = std::nanf("");
  const std::vector<float> a{0.0f, nan, 1.0f}, b{-0.0f, nan, 1.0f};
  const RunList due{{0, 1}};
  EXPECT_EQ(differing_runs(std::span<const float>(a), std::span<const float>(b), 0), due);
}

TEST(Runs, MergeWhateverTheirOrder) {
  RunList runs{{10, 2}, {0, 3}, {2, 4}, {15, 0}, {13, 1}, {30, 1}};
  merge_runs(runs, 1);
  EXPECT_EQ(runs, (RunList{{0, 6}, {10, 4}, {30, 1}}));
}

}  // namespace
}  // namespace panoptes::test
