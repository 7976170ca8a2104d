// An edge-avoiding wavelet filter (Dammertz et al. 2010, "Edge-Avoiding A-Trous Wavelet Transform for fast Global
// Illumination Filtering") that is guided by the variance of each pixel (Schied et al. 2017, "Spatiotemporal
// Variance-Guided Filtering").
//
// What is filtered is light before the first surface scatters it, so that textures stay sharp. Neighbours count as far as
// they lie on the same smooth surface, scatter alike, and differ by no more than their noise explains: while samples
// are added the noise falls, and the filter fades by itself. Weights are the same both ways, and outliers are spread rather
// than cut off: the picture keeps its brightness.
#pragma once

#include "denoise/picture.h"
#include "gl/handles.h"
#include "gl/pass_timer.h"
#include "gl/program.h"

#include <atomic>

namespace panoptes::denoise {

struct Filtered {
  std::vector<float> pixels;    // RGBA, alpha as it was
  std::vector<float> variance;  // of their brightness, what is left of the noise: at most what it was
};

class EdgeAvoidingFilter {
 public:
  // Throws Cancelled when `cancelled` says so.
  Filtered run(const Picture& picture, gl::ProgramCache& programs, gl::PassTimer& timer,
               const std::atomic<bool>& cancelled);
  // Frees all that run() allocated.
  void release();

 private:
  void upload(const Picture& picture);

  gl::Texture light_[2];  // RGB, before the first surface scatters it; A: its variance
  gl::Texture normals_, positions_, albedo_;
};

// For the validation of shaders too. `smooths`: the variance alone, for the first level.
gl::ProgramSource filter_program(bool smooths, bool positions);

}  // namespace panoptes::denoise
