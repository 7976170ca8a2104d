// Points for the samples of a picture: where in its pixel a sample looks, which point of a lamp it
// uses. Reproducible from the seed and the sample's index alone, so that ranges of samples can be
// rendered apart.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>

namespace panoptes::film {

// The `index`-th point of Sobol's (0,2)-sequence, shuffled and scrambled by Owen's nested
// permutations (as in Burley 2020): every power of two of indices is stratified in both dimensions
// and in each alone. Another `seed` or `dimension` gives an independent sequence.
glm::vec2 sample_point(uint32_t index, uint32_t seed, uint32_t dimension);

// Maps u in [0,1) to an offset from the pixel's centre, in pixels, distributed as the
// Blackman-Harris window that spans -width .. width; Cycles' default filter has width 1.5.
float blackman_harris_offset(float u, float width);

}  // namespace panoptes::film
