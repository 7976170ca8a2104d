// Sums the samples of a picture and makes its passes. The device sums sixteen samples at a time, one
// layer of a float image a pass; each block that is complete goes to the host, into SampleSums, whose
// order of additions is the same for every range of samples.
#pragma once

#include "film/average.h"
#include "film/noise.h"
#include "film/pieces.h"
#include "gl/handles.h"
#include "gl/program.h"

#include <optional>
#include <vector>

namespace panoptes::film {

struct FilmOptions {
  bool moments = false;  // of brightness, for the estimated error
  bool pieces = false;   // take_pieces() can be merged with what comes before
  // Pixels get no more samples once their noise is below this (see noise.h), after at least one
  // block; 0: all get all samples. Needs moments, and an integrator that asks for active_pixels().
  double noise_threshold = 0;
};

class Film {
 public:
  // (Re)allocates for the passes (completed by what they are divided by) and forgets all samples.
  void start(int width, int height, const PassSet& passes, const FilmOptions& options = {});

  // Gives a program the layers of the passes that there are.
  void add_defines(gl::ProgramSource& source) const;
  void bind() const;  // to the units of film/film.glsl

  // Every integrator's every sample is followed by this; their numbers follow on each other.
  void end_sample(uint32_t index);
  uint32_t samples() const { return counts_.all; }

  // The pixels that want the next sample (uint, y * width + x, ascending). They change only when a
  // block is complete. Without a noise threshold there is no buffer: all pixels do.
  bool all_active() const { return !active_; }
  const gl::Buffer& active_pixels() const { return active_; }
  int active_count() const { return active_count_; }

  // The pass so far, channels a pixel, rows bottom to top; colour is divided out and light is scaled
  // by `exposure`. Throws Error for a pass that was not asked for.
  std::vector<float> read(Pass pass, float exposure) const;

  // See noise.h; none without moments or below two samples.
  std::optional<double> estimated_error() const;
  // Of each pixel's brightness, that of its mean; empty without moments or below two samples.
  std::vector<float> variance(float exposure) const;
  // Samples of pixels that were infinite or no number, and count as black.
  uint32_t spoiled_samples() const;

  // All samples, for merging; the film has none from then on.
  Pieces take_pieces(float exposure);

  int width() const { return width_; }
  int height() const { return height_; }

 private:
  void allocate();
  void clear_block();
  void finish_block();
  void choose_active();
  // `channels` a pixel of a layer, as the device has them.
  std::vector<float> layer(int index, int channels) const;
  std::vector<float> total(Pass pass) const;
  std::vector<Moments> moments() const;
  SampleCounts counts() const;  // with those of the block under way

  int width_ = 0, height_ = 0;
  PassSet passes_;
  FilmOptions options_;
  Layout layout_;
  int layers_[kPassCount] = {};
  int moments_layer_ = 0;
  int summed_layers_ = 0;  // the first so many hold sums, the rest the first sample
  gl::Texture sums_;
  gl::Buffer spoiled_;

  uint32_t next_sample_ = 0;
  uint32_t block_samples_ = 0;  // in the device's sums
  SampleSums blocks_;
  std::vector<Moments> block_moments_;  // of blocks_
  SampleCounts counts_;                 // `each` without the block under way
  gl::Buffer active_;
  int active_count_ = 0;
  std::vector<uint32_t> active_list_;
};

}  // namespace panoptes::film
