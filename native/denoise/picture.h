// What a denoiser works on: a noisy picture, how noisy it is, and what its first surfaces look like.
#pragma once

#include "film/film.h"

#include <span>
#include <vector>

namespace panoptes::denoise {

// All have width * height pixels, rows bottom to top; light is scene-linear.
struct Picture {
  int width = 0, height = 0;
  std::span<const float> noisy;     // RGBA
  std::span<const float> variance;  // of noisy's brightness, that of its mean over samples
  std::vector<float> unscattered;   // RGB: the part of `noisy` that no surface has scattered, nearly without noise
  std::vector<float> albedo;        // RGB: what share of light the first surfaces scatter
  std::vector<float> normals;       // XYZ, world, averaged over samples: shorter than 1 at edges, 0 without a surface
  std::vector<float> positions;     // XYZ, world, of the first surface in one sample; empty where a lens blurs them
};

// What a film has to hold beside Combined and the moments of its brightness; `blurred`: by a lens.
film::PassSet features(bool blurred);

// Of a film that holds them. `noisy` and `variance` must outlive the picture.
Picture gather(const film::Film& film, std::span<const float> noisy, std::span<const float> variance, float exposure,
               bool blurred);

}  // namespace panoptes::denoise
