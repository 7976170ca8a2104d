// The sum of a run of samples, each a list of floats, in one order of additions for every way to cut
// the run: whoever sums 0:5, 5:24 and 24:40 apart and puts the pieces together gets the bits of 0:40.
//
// Samples are counted from the first of the whole picture. Sixteen in a row from a multiple of 16 make
// a block, summed one after the other; two neighbouring blocks make a node, two neighbouring nodes of
// a size the next larger node. So no float ever takes up more than 16 terms in a row, and the error
// grows with the logarithm of the number of samples alone. What is kept of a run are its *pieces*:
// the largest nodes that lie in it, at its end the beginning of a block, and at its start, where it
// begins within a block, that block's samples one by one. The picture is the sum of the pieces from
// left to right.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace panoptes::film {

constexpr uint32_t kBlock = 16;

struct Piece {
  uint32_t first = 0, last = 0;  // samples, half-open
  std::vector<float> sums;

  uint32_t count() const { return last - first; }
};

// a += b, value by value. What is below the least normal float becomes 0, as on devices that know
// no others.
void accumulate(std::vector<float>& a, const std::vector<float>& b);

// Whether pieces may span these samples: a part of a block from its beginning, a single sample, or a
// node.
bool is_piece(uint32_t first, uint32_t last);

class SampleSums {
 public:
  // Takes up the samples that follow. A run that begins within a block may begin with the rest of
  // that block in one piece: it has the same sum, but nothing can be merged in front of it. Throws
  // Error when there is a gap, an overlap, another number of values, or no such piece.
  void add(Piece piece);

  bool empty() const { return pieces_.empty(); }
  uint32_t first() const { return pieces_.front().first; }  // not for empty ones
  uint32_t last() const { return pieces_.back().last; }
  const std::vector<Piece>& pieces() const { return pieces_; }

  // The sum of all samples, for values begin .. begin + count - 1; zeros when there are none.
  std::vector<float> total(size_t begin, size_t count) const;

 private:
  std::vector<Piece> pieces_;
};

}  // namespace panoptes::film
