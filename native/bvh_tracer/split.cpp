#include "bvh_tracer/split.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace panoptes::bvh_tracer {

namespace {

// Which bin along each axis a centroid is in. The same arithmetic counts and parts, so that no
// triangle is taken for being on the other side.
struct Binning {
  Lanes origin, scale;

  Binning(const Box& centroids, uint32_t bins) {
    for (int i = 0; i < 4; ++i) {
      const float extent = centroids.high[i] - centroids.low[i];
      // Less than the number of bins, so that rounding cannot reach it.
      const float per_unit = float(bins) * (1 - 1e-6f) / extent;
      origin[i] = centroids.low[i];
      scale[i] = i < 3 && extent > 0 && std::isfinite(per_unit) ? per_unit : 0;
    }
  }
  bool parts(int axis) const { return scale[axis] > 0; }
  uint32_t bin(const Reference& reference, int axis) const {
    const float middle = reference.box.low[axis] + reference.box.high[axis];
    return uint32_t(int((middle - origin[axis]) * scale[axis]));
  }
};

struct Bin {
  Box box;
  uint32_t count = 0;
};

template <uint32_t kBins>
Split find_split_in(std::span<const Reference> references, const Range& range) {
  Split best;
  best.bins = kBins;
  const Binning binning(range.centroids, kBins);
  std::array<std::array<Bin, kBins>, 3> bins;
  for (const Reference& reference : references.subspan(range.begin, range.size())) {
    for (int axis = 0; axis < 3; ++axis) {
      Bin& bin = bins[size_t(axis)][binning.bin(reference, axis)];
      bin.box.add(reference.box);
      ++bin.count;
    }
  }
  const float scale = 1 / range.bounds.longest_side();
  const float whole = range.bounds.area(scale);
  for (int axis = 0; axis < 3; ++axis) {
    if (!binning.parts(axis)) continue;
    const auto& along = bins[size_t(axis)];
    // What lies above each plane costs, then what lies below it.
    std::array<float, kBins> above;
    Box box;
    uint32_t count = 0;
    for (uint32_t i = kBins - 1; i > 0; --i) {
      box.add(along[i].box);
      count += along[i].count;
      above[i] = count ? float(count) * box.area(scale) : 0;
    }
    box = Box();
    count = 0;
    for (uint32_t i = 1; i < kBins; ++i) {
      box.add(along[i - 1].box);
      count += along[i - 1].count;
      if (count == 0 || count == range.size()) continue;
      const float cost = (float(count) * box.area(scale) + above[i]) / whole;
      if (cost < best.cost) {
        best.cost = cost;
        best.axis = axis;
        best.bin = i;
      }
    }
  }
  return best;
}

}  // namespace

float Box::longest_side() const {
  return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
}

// Fewer bins for few triangles, where looking through them would cost more than filling them.
Split find_split(std::span<const Reference> references, const Range& range) {
  if (range.size() <= 4) return find_split_in<4>(references, range);
  if (range.size() <= 8) return find_split_in<8>(references, range);
  return find_split_in<16>(references, range);
}

Halves apply_split(std::span<Reference> references, const Range& range, const Split& split) {
  const Binning binning(range.centroids, split.bins);
  const auto is_below = [&](const Reference& reference) {
    return binning.bin(reference, split.axis) < split.bin;
  };
  Range below, above;
  below.begin = range.begin;
  above.end = range.end;
  uint32_t low = range.begin, high = range.end;
  while (true) {
    while (low < high && is_below(references[low])) below.add(references[low++]);
    while (low < high && !is_below(references[high - 1])) above.add(references[--high]);
    if (low >= high) break;
    std::swap(references[low], references[high - 1]);
    below.add(references[low++]);
    above.add(references[--high]);
  }
  below.end = above.begin = low;
  return {below, above};
}

Halves halve(std::span<Reference> references, const Range& range) {
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (range.centroids.high[i] - range.centroids.low[i] >
        range.centroids.high[axis] - range.centroids.low[axis])
      axis = i;
  const uint32_t middle = range.begin + range.size() / 2;
  const auto first = references.begin();
  std::nth_element(first + range.begin, first + middle, first + range.end,
                   [&](const Reference& a, const Reference& b) {
                     const float at_a = centroid(a)[axis], at_b = centroid(b)[axis];
                     return at_a < at_b || (at_a == at_b && a.primitive() < b.primitive());
                   });
  Range below, above;
  below.begin = range.begin;
  below.end = above.begin = middle;
  above.end = range.end;
  for (uint32_t i = range.begin; i < middle; ++i) below.add(references[i]);
  for (uint32_t i = middle; i < range.end; ++i) above.add(references[i]);
  return {below, above};
}

}  // namespace panoptes::bvh_tracer
