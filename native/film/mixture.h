// A picture between two of the same view: one that is smooth but leaves light out, and one that is right on average
// but noisy. Where either is nearer to the truth it counts for more, so that nothing jumps while noise falls.
#pragma once

#include <span>
#include <vector>

namespace panoptes::film {

struct Mixture {
  std::vector<float> pixels;  // RGBA, rows bottom to top
  // Estimated: root mean square over pixels, divided by the mean brightness. A bias well below the noise shows in it
  // as about half of that noise.
  double error = 0;
  // Of each pixel's brightness: the mean square of what it is expected to be off by.
  std::vector<float> variance;
};

// `smooth` and `noisy`: RGBA a pixel, linear light; `variance`: of the brightness of `noisy`, that of its mean over
// samples. All have width * height pixels, finite.
//
// What `smooth` is off by is estimated about each pixel: the mean square of the difference, less the part of it that is
// noise or may be. With a bias b and a noise of variance v, b^2 / (b^2 + v) is the weight of `noisy` that has the least mean
// square error, b^2 v / (b^2 + v). Neither depends on a pixel's own noise alone, which would make bright outliers count
// for less and darken the picture. Colours are as noisy as they are bright.
//
// `shared` is the variance of `smooth`, where that was made of `noisy`: the noise that they have in common tells nothing of
// which is better, and is left in the mixture. Empty for none.
Mixture mix_by_error(int width, int height, std::span<const float> smooth, std::span<const float> noisy,
                     std::span<const float> variance, std::span<const float> shared = {});

}  // namespace panoptes::film
