#include "bvh_tracer/split.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace panoptes::bvh_tracer {

namespace {

constexpr uint32_t kMostBins = 16;

// Which bin along each axis a centroid is in. The same arithmetic counts and parts, so that no
// triangle is taken for being on the other side.
struct Binning {
  alignas(16) float origin[4], scale[4];

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
  uint32_t bin(const Centroid& centroid, int axis) const {
    return uint32_t(int((centroid.at[axis] - origin[axis]) * scale[axis]));
  }
};

struct Bin {
  Box box;
  uint32_t count = 0;
};

// Fewer for few triangles, where looking through bins would cost more than filling them.
uint32_t bins_for(uint32_t count) { return std::clamp(count, 4u, kMostBins); }

}  // namespace

float Box::longest_side() const {
  return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
}

Split find_split(std::span<const Reference> references, const Range& range) {
  Split best;
  best.bins = bins_for(range.size());
  const Binning binning(range.centroids, best.bins);
  std::array<std::array<Bin, kMostBins>, 3> bins;
  for (const Reference& reference : references.subspan(range.begin, range.size())) {
    const Centroid centroid(reference);
    for (int axis = 0; axis < 3; ++axis) {
      Bin& bin = bins[size_t(axis)][binning.bin(centroid, axis)];
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
    std::array<float, kMostBins> above;
    Box box;
    uint32_t count = 0;
    for (uint32_t i = best.bins - 1; i > 0; --i) {
      box.add(along[i].box);
      count += along[i].count;
      above[i] = count ? float(count) * box.area(scale) : 0;
    }
    box = Box();
    count = 0;
    for (uint32_t i = 1; i < best.bins; ++i) {
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

void apply_split(std::span<Reference> references, const Range& range, const Split& split,
                 Range& below, Range& above) {
  const Binning binning(range.centroids, split.bins);
  const auto is_below = [&](const Reference& reference) {
    return binning.bin(Centroid(reference), split.axis) < split.bin;
  };
  below = above = Range();
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
}

void halve(std::span<Reference> references, const Range& range, Range& below, Range& above) {
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (range.centroids.high[i] - range.centroids.low[i] >
        range.centroids.high[axis] - range.centroids.low[axis])
      axis = i;
  const uint32_t middle = range.begin + range.size() / 2;
  const auto first = references.begin();
  std::nth_element(first + range.begin, first + middle, first + range.end,
                   [&](const Reference& a, const Reference& b) {
                     const float at_a = Centroid(a).at[axis], at_b = Centroid(b).at[axis];
                     return at_a < at_b || (at_a == at_b && a.primitive() < b.primitive());
                   });
  below = above = Range();
  below.begin = range.begin;
  below.end = above.begin = middle;
  above.end = range.end;
  for (uint32_t i = range.begin; i < middle; ++i) below.add(references[i]);
  for (uint32_t i = middle; i < range.end; ++i) above.add(references[i]);
}

}  // namespace panoptes::bvh_tracer
