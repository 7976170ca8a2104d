// From sums over samples to the pictures of the passes, and where the sums of each pass lie.
#pragma once

#include "film/passes.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace panoptes::film {

// Samples that went into the pixels.
struct SampleCounts {
  uint32_t all = 0;            // of every pixel, or the most that any has
  std::vector<uint32_t> each;  // a pixel; empty where all have the same

  uint32_t of(size_t pixel) const { return each.empty() ? all : each[pixel]; }
};

// The lists that SampleSums adds up: the passes that are sums in the order of `Pass`, each all its
// pixels (rows bottom to top) with the pass' channels side by side.
class Layout {
 public:
  Layout() = default;
  Layout(size_t pixels, const PassSet& passes);

  bool holds(Pass pass) const {
    return passes_[size_t(pass)] && info(pass).kind == PassKind::kSum;
  }
  // Only of passes that it holds.
  size_t begin(Pass pass) const { return begins_[size_t(pass)]; }
  size_t size(Pass pass) const { return pixels_ * size_t(info(pass).channels); }
  size_t total() const { return total_; }

 private:
  size_t pixels_ = 0, total_ = 0;
  PassSet passes_;
  std::array<size_t, kPassCount> begins_{};
};

// Divides the sums of a pass by the samples, or by the sums of the colour that is divided out of it
// (black where that is black; empty for passes without one), and scales light by `exposure`.
std::vector<float> average(Pass pass, std::vector<float> sums, std::span<const float> divisor,
                           const SampleCounts& counts, float exposure);

// The share of the most samples that each pixel got.
std::vector<float> sample_shares(const SampleCounts& counts, size_t pixels);

}  // namespace panoptes::film
