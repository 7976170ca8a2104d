// What is kept of a render so that its samples can be merged with others'.
#pragma once

#include "film/average.h"
#include "film/sample_sums.h"

#include <map>

namespace panoptes::film {

struct Pieces {
  int width = 0, height = 0;
  float exposure = 1;
  PassSet passes;   // completed by what they are divided by
  SampleSums sums;  // of layout()
  // Passes of the range's first sample, channels a pixel, rows bottom to top.
  std::map<Pass, std::vector<float>> firsts;

  Layout layout() const { return {size_t(width) * size_t(height), passes}; }
};

}  // namespace panoptes::film
