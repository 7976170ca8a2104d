// Sums the samples of a picture, one layer of a float image a pass, and makes the passes of it.
#pragma once

#include "film/passes.h"
#include "gl/handles.h"
#include "gl/program.h"

#include <optional>
#include <vector>

namespace panoptes::film {

class Film {
 public:
  // (Re)allocates for the passes (completed by what they are divided by) and clears all sums.
  // `moments` keeps squares as well, for the estimated error.
  void start(int width, int height, const PassSet& passes, bool moments);

  // Gives a program the layers of the passes that there are.
  void add_defines(gl::ProgramSource& source) const;
  void bind() const;  // to the units of film/film.glsl

  // The pass after `samples` samples, channels a pixel, rows bottom to top; colour is divided out
  // and light is scaled by `exposure`. Throws Error for a pass that was not asked for.
  std::vector<float> read(Pass pass, int samples, float exposure) const;

  // Root mean square over pixels of the standard error of their brightness, divided by the mean
  // brightness; none without moments or below two samples.
  std::optional<double> estimated_error(int samples) const;

  int width() const { return width_; }
  int height() const { return height_; }

 private:
  std::vector<float> layer(int index) const;

  int width_ = 0, height_ = 0;
  PassSet passes_;
  bool moments_ = false;
  int layers_[kPassCount] = {};
  int moments_layer_ = 0;
  gl::Texture sums_;
};

}  // namespace panoptes::film
