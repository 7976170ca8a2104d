// How a range of boxes is parted in two: what the builder of the hierarchy does at each node.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>
#include <span>

namespace panoptes::bvh_tracer {

// Four lanes, so that compilers make one instruction of a loop over them. The last one of `low` is
// free for its user.
struct Box {
  static constexpr float kEmpty = std::numeric_limits<float>::max();
  alignas(16) float low[4] = {kEmpty, kEmpty, kEmpty, kEmpty};
  alignas(16) float high[4] = {-kEmpty, -kEmpty, -kEmpty, -kEmpty};

  void add(const float* point_low, const float* point_high) {
    for (int i = 0; i < 4; ++i) low[i] = point_low[i] < low[i] ? point_low[i] : low[i];
    for (int i = 0; i < 4; ++i) high[i] = point_high[i] > high[i] ? point_high[i] : high[i];
  }
  void add(const Box& other) { add(other.low, other.high); }
  // Half of its surface, lengths being in units of 1 / `scale`: so that none is too large or small.
  float area(float scale) const {
    const float x = (high[0] - low[0]) * scale, y = (high[1] - low[1]) * scale,
                z = (high[2] - low[2]) * scale;
    return x * y + y * z + z * x;
  }
  float longest_side() const;
};

// A triangle's box; the free lane holds the bits of its number.
struct Reference {
  Box box;
  uint32_t primitive() const { return std::bit_cast<uint32_t>(box.low[3]); }
};

// Twice the middle of a reference's box.
struct Centroid {
  alignas(16) float at[4];
  explicit Centroid(const Reference& reference) {
    for (int i = 0; i < 4; ++i) at[i] = reference.box.low[i] + reference.box.high[i];
  }
};

// Consecutive references, with the bounds of their boxes and of their centroids.
struct Range {
  uint32_t begin = 0, end = 0;
  Box bounds, centroids;

  uint32_t size() const { return end - begin; }
  void add(const Reference& reference) {
    const Centroid centroid(reference);
    bounds.add(reference.box);
    centroids.add(centroid.at, centroid.at);
  }
};

// A plane between two bins of centroids.
struct Split {
  int axis = -1;  // none: all centroids are in one place
  uint32_t bin = 0;  // the first one above it
  uint32_t bins = 0;
  // Of the children together, areas being relative to the parent's: triangles tested by a ray that
  // meets the parent.
  float cost = std::numeric_limits<float>::infinity();
};

// The best plane by the surface-area heuristic.
Split find_split(std::span<const Reference> references, const Range& range);
// Orders the references of `range` so that those below the plane come first.
void apply_split(std::span<Reference> references, const Range& range, const Split& split,
                 Range& below, Range& above);
// The same in halves of equal numbers, by centroids along the axis on which they spread most, then
// by the numbers of primitives: for what no plane parts, and where the depth is used up.
void halve(std::span<Reference> references, const Range& range, Range& below, Range& above);

}  // namespace panoptes::bvh_tracer
