#include "film/sample_sums.h"

#include "base/error.h"

#include <bit>
#include <cmath>
#include <limits>
#include <span>

namespace panoptes::film {

namespace {

void accumulate(std::span<float> a, std::span<const float> b) {
  for (size_t i = 0; i < a.size(); ++i) {
    const float sum = a[i] + b[i];
    a[i] = std::fabs(sum) < std::numeric_limits<float>::min() ? 0.0f : sum;
  }
}

bool at_boundary(uint32_t sample) { return sample % kBlock == 0; }

// A whole block, or a node over several.
bool is_node(const Piece& piece) {
  return at_boundary(piece.first) && piece.count() >= kBlock;
}

// Whether `b`, which follows `a`, is added to it.
bool belong_together(const Piece& a, const Piece& b) {
  if (is_node(a)) return b.count() == a.count() && a.first % (2 * a.count()) == 0;
  // The beginning of a block grows sample by sample; single samples from within one stay alone.
  return at_boundary(a.first) && b.count() == 1;
}

}  // namespace

void accumulate(std::vector<float>& a, const std::vector<float>& b) {
  accumulate(std::span(a), std::span(b));
}

bool is_piece(uint32_t first, uint32_t last) {
  if (last <= first) return false;
  const uint32_t count = last - first;
  if (count == 1) return true;
  return count < kBlock ? at_boundary(first) : std::has_single_bit(count) && first % count == 0;
}

void SampleSums::add(Piece piece) {
  // The rest of a block is as good as its samples where nothing comes before.
  const bool rest = pieces_.empty() && piece.last > piece.first &&
                    piece.first / kBlock == (piece.last - 1) / kBlock;
  if (!rest && !is_piece(piece.first, piece.last))
    fail("samples {} to {} are no piece of a sum: render them again", piece.first, piece.last);
  if (!pieces_.empty()) {
    if (piece.first != last())
      fail("samples {} to {} do not follow on {} to {}: give ranges without gaps and overlaps",
           piece.first, piece.last, first(), last());
    if (piece.sums.size() != pieces_.back().sums.size())
      fail("samples {} to {} are of a picture of another size or with other passes: render them again",
           piece.first, piece.last);
  }
  pieces_.push_back(std::move(piece));
  while (pieces_.size() > 1 && belong_together(pieces_[pieces_.size() - 2], pieces_.back())) {
    Piece& grown = pieces_[pieces_.size() - 2];
    accumulate(grown.sums, pieces_.back().sums);
    grown.last = pieces_.back().last;
    pieces_.pop_back();
  }
}

std::vector<float> SampleSums::total(size_t begin, size_t count) const {
  if (pieces_.empty()) return std::vector<float>(count);
  const std::span<const float> start = std::span(pieces_.front().sums).subspan(begin, count);
  std::vector<float> result(start.begin(), start.end());
  for (size_t i = 1; i < pieces_.size(); ++i)
    accumulate(result, std::span(pieces_[i].sums).subspan(begin, count));
  return result;
}

}  // namespace panoptes::film
