#include "bvh_tracer/bvh.h"

#include "bvh_tracer/split.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <system_error>
#include <thread>

namespace panoptes::bvh_tracer {

namespace {

using shared::TracedTriangle;

constexpr uint32_t kAlwaysLeaf = 2, kMostInLeaf = 4;
static_assert(kMostInLeaf < 1u << shared::BVH_COUNT_BITS);
// What a node's visit costs, in triangle tests.
constexpr float kStepCost = 1.0f;
// Ranges of so many triangles at most are split further by the thread that has them.
constexpr uint32_t kSerial = 4096;

bool can_be_met(const TracedTriangle& t) {
  if ((t.flags & shared::TRIANGLE_SEEN_BY) == 0) return false;
  for (float x : {t.x0, t.y0, t.z0, t.x1, t.y1, t.z1, t.x2, t.y2, t.z2})
    if (!(std::abs(x) <= kFarthest)) return false;
  return true;
}

Reference reference_to(const TracedTriangle& t, uint32_t primitive) {
  Reference r;
  r.box.low[0] = std::min({t.x0, t.x1, t.x2}), r.box.high[0] = std::max({t.x0, t.x1, t.x2});
  r.box.low[1] = std::min({t.y0, t.y1, t.y2}), r.box.high[1] = std::max({t.y0, t.y1, t.y2});
  r.box.low[2] = std::min({t.z0, t.z1, t.z2}), r.box.high[2] = std::max({t.z0, t.z1, t.z2});
  r.box.low[3] = std::bit_cast<float>(primitive), r.box.high[3] = 0;
  return r;
}

int32_t leaf(uint32_t first, uint32_t count) {
  return ~int32_t(first << shared::BVH_COUNT_BITS | count);
}

scene::Bounds bounds_of(const Box& box) {
  return {{box.low[0], box.low[1], box.low[2]}, {box.high[0], box.high[1], box.high[2]}};
}

// Splits ranges until they are leaves. A node over n triangles has n - 1 places for itself and all
// below it, the first its own: so where a node goes does not depend on the order of work.
class Builder {
 public:
  Builder(std::vector<Reference> references, unsigned threads)
      : references_(std::move(references)),
        nodes_(std::make_unique_for_overwrite<Bvh::Node[]>(references_.size())),
        used_(references_.size()),
        threads_(threads) {
    // Waiting ranges overlap nowhere: with room for all, no thread runs out of memory.
    tasks_.reserve(references_.size() / kSerial + 1);
  }

  Bvh build(const Range& all) {
    const int32_t root = child(all, 0, 1);
    const size_t most_helpers = tasks_.empty() || threads_ < 2 ? 0 : threads_ - 1;
    std::vector<std::thread> helpers;
    helpers.reserve(most_helpers);
    try {
      while (helpers.size() < most_helpers) helpers.emplace_back([this] { work(); });
    } catch (const std::system_error&) {  // no more threads to be had: fewer do it too
    }
    work();
    for (std::thread& helper : helpers) helper.join();
    return result(root, all);
  }

 private:
  struct Task {
    Range range;
    uint32_t place, depth;
  };

  // Splits what is waiting until no thread can bring more.
  void work() {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [&] { return !tasks_.empty() || working_ == 0; });
      if (tasks_.empty()) return;
      const Task task = tasks_.back();
      tasks_.pop_back();
      ++working_;
      lock.unlock();
      split(task.range, task.place, task.depth, find_split(references_, task.range));
      lock.lock();
      --working_;
      changed_.notify_all();
    }
  }

  // Makes what a node at depth - 1 refers to for `range`, now or, if it is long, by and by.
  int32_t child(const Range& range, uint32_t place, uint32_t depth) {
    if (range.size() > kSerial) {
      const std::lock_guard lock(mutex_);
      tasks_.push_back({range, place, depth});
      changed_.notify_one();
      return int32_t(place);
    }
    if (range.size() <= kAlwaysLeaf) return leaf(range.begin, range.size());
    const Split best = find_split(references_, range);
    if (range.size() <= kMostInLeaf && float(range.size()) <= kStepCost + best.cost)
      return leaf(range.begin, range.size());
    split(range, place, depth, best);
    return int32_t(place);
  }

  void split(const Range& range, uint32_t place, uint32_t depth, const Split& best) {
    // Whatever the split, halving must then be able to end in time.
    const auto levels = uint32_t(std::bit_width(range.size() - 1));
    const bool may_split = best.axis >= 0 && depth + levels <= shared::BVH_DEPTH;
    const auto [below, above] =
        may_split ? apply_split(references_, range, best) : halve(references_, range);
    const int32_t child0 = child(below, place + 1, depth + 1);
    const int32_t child1 = child(above, place + below.size(), depth + 1);
    nodes_[place] = {{child0, child1}, {bounds_of(below.bounds), bounds_of(above.bounds)}};
    used_[place] = 1;
  }

  // Closes the gaps between nodes.
  Bvh result(int32_t root, const Range& all) const {
    Bvh bvh;
    bvh.order.reserve(references_.size());
    for (const Reference& reference : references_) bvh.order.push_back(reference.primitive());
    if (root < 0) {
      const scene::Bounds bounds = bounds_of(all.bounds);
      bvh.nodes = {{{root, leaf(all.end, 0)}, {bounds, bounds}}};
      return bvh;
    }
    std::vector<int32_t> moved(used_.size());
    int32_t count = 0;
    for (size_t i = 0; i < used_.size(); ++i) {
      moved[i] = count;
      count += used_[i];
    }
    bvh.nodes.reserve(size_t(count));
    for (size_t i = 0; i < used_.size(); ++i) {
      if (!used_[i]) continue;
      Bvh::Node node = nodes_[i];
      for (int32_t& child : node.children)
        if (child >= 0) child = moved[size_t(child)];
      bvh.nodes.push_back(node);
    }
    return bvh;
  }

  std::vector<Reference> references_;
  std::unique_ptr<Bvh::Node[]> nodes_;
  std::vector<uint8_t> used_;
  unsigned threads_;
  std::mutex mutex_;  // of the two below
  std::condition_variable changed_;
  std::vector<Task> tasks_;
  int working_ = 0;
};

}  // namespace

Bvh build_bvh(std::span<const TracedTriangle> triangles, unsigned threads) {
  std::vector<Reference> references;
  references.reserve(triangles.size());
  Range all;
  for (uint32_t i = 0; i < triangles.size(); ++i) {
    if (!can_be_met(triangles[i])) continue;
    references.push_back(reference_to(triangles[i], i));
    all.add(references.back());
  }
  all.end = uint32_t(references.size());
  if (references.empty()) all.bounds = Box{{}, {}};
  return Builder(std::move(references), threads).build(all);
}

}  // namespace panoptes::bvh_tracer
