// Where two arrays differ, as runs of elements: what has to be sent to make one out of the other.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace panoptes {

struct Run {
  size_t first = 0, count = 0;
  bool operator==(const Run&) const = default;
};

// Sorts `runs` and joins those that overlap or lie closer than `gap` elements: a transfer of its
// own costs more than a few elements that are there already.
inline void merge_runs(std::vector<Run>& runs, size_t gap) {
  std::sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.first < b.first; });
  size_t kept = 0;
  for (const Run& run : runs) {
    if (run.count == 0) continue;
    if (kept > 0 && run.first <= runs[kept - 1].first + runs[kept - 1].count + gap) {
      Run& last = runs[kept - 1];
      last.count = std::max(last.first + last.count, run.first + run.count) - last.first;
    } else {
      runs[kept++] = run;
    }
  }
  runs.resize(kept);
}

// Runs of `count` elements of `size` bytes that differ between `a` and `b`, joined as merge_runs()
// does. Bits count: -0 differs from 0, and a NaN equals itself.
inline std::vector<Run> differing_runs(const void* a, const void* b, size_t count, size_t size,
                                       size_t gap) {
  const auto *p = static_cast<const std::byte*>(a), *q = static_cast<const std::byte*>(b);
  constexpr size_t kBlock = 256;  // elements that one comparison skips when they are equal
  std::vector<Run> runs;
  for (size_t block = 0; block < count; block += kBlock) {
    const size_t end = std::min(block + kBlock, count);
    if (std::memcmp(p + block * size, q + block * size, (end - block) * size) == 0) continue;
    for (size_t i = block; i < end; ++i) {
      if (std::memcmp(p + i * size, q + i * size, size) == 0) continue;
      if (!runs.empty() && i <= runs.back().first + runs.back().count + gap)
        runs.back().count = i + 1 - runs.back().first;
      else
        runs.push_back({i, 1});
    }
  }
  return runs;
}

template <class T>
std::vector<Run> differing_runs(std::span<const T> a, std::span<const T> b, size_t gap) {
  return differing_runs(a.data(), b.data(), a.size(), sizeof(T), gap);
}

}  // namespace panoptes
