// How noisy a picture still is, from the moments of its pixels' brightness.
#pragma once

#include "film/average.h"

#include <optional>

namespace panoptes::film {

// Of a pixel's brightness, summed over its samples.
struct Moments {
  double sum = 0, squares = 0;
};

// Root mean square over pixels of the standard error of their brightness, divided by the mean
// brightness; none where no pixel has two samples.
std::optional<double> relative_error(std::span<const Moments> moments, const SampleCounts& counts);

// Of each pixel's brightness, that of its mean over samples; `scale` multiplies the light.
std::vector<float> variances(std::span<const Moments> moments, const SampleCounts& counts, float scale);

// The pixels (y * width + x, ascending) that want more samples: the standard error of their
// brightness, or that of one of their eight neighbours, is above `threshold` times the brightness.
// A pixel that is darker than a hundredth of the mean is held to that: nobody sees its noise.
std::vector<uint32_t> noisy_pixels(std::span<const Moments> moments, const SampleCounts& counts,
                                   int width, int height, double threshold);

}  // namespace panoptes::film
