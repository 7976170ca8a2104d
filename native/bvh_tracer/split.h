// How a range of boxes is parted in two: what the builder of the hierarchy does at each node.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>
#include <span>

namespace panoptes::bvh_tracer {

// Four numbers that one instruction handles (an extension that GCC and Clang share).
using Lanes = float __attribute__((vector_size(16)));

// The last lane of `low` is free for its user.
struct Box {
  static constexpr float kEmpty = std::numeric_limits<float>::max();
  Lanes low = {kEmpty, kEmpty, kEmpty, kEmpty};
  Lanes high = {-kEmpty, -kEmpty, -kEmpty, -kEmpty};

  void add(const Box& other) {
    low = other.low < low ? other.low : low;
    high = other.high > high ? other.high : high;
  }
  // Half of its surface, lengths being in units of 1 / `scale`: so that none is too large or small.
  float area(float scale) const {
    const Lanes side = (high - low) * scale;
    return side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
  }
  float longest_side() const;
};

// A triangle's box; the free lane holds the bits of its number.
struct Reference {
  Box box;
  uint32_t primitive() const { return std::bit_cast<uint32_t>(box.low[3]); }
};

// Twice the middle of a reference's box.
inline Lanes centroid(const Reference& reference) { return reference.box.low + reference.box.high; }

// Consecutive references, with the bounds of their boxes and of their centroids.
struct Range {
  uint32_t begin = 0, end = 0;
  Box bounds, centroids;

  uint32_t size() const { return end - begin; }
  void add(const Reference& reference) {
    bounds.add(reference.box);
    const Lanes middle = centroid(reference);
    centroids.add({middle, middle});
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

struct Halves {
  Range below, above;
};
// Orders the references of `range` so that those below the plane come first.
Halves apply_split(std::span<Reference> references, const Range& range, const Split& split);
// The same with equal numbers, by centroids along the axis on which they spread most, then by the
// numbers of primitives: for what no plane parts, and where the depth is used up.
Halves halve(std::span<Reference> references, const Range& range);

}  // namespace panoptes::bvh_tracer
