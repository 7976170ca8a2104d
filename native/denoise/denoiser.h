// Takes the noise out of pictures by paths. What a denoiser gives is mixed with the noisy picture by the error that each
// has (film/mixture.h): where detail is blurred or light is lost the samples show through, and with more and more of them
// the picture becomes theirs.
#pragma once

#include "denoise/edge_avoiding.h"
#include "denoise/settings.h"
#include "film/mixture.h"

namespace panoptes::denoise {

class Denoise {
 public:
  // Throws Cancelled when `cancelled` says so.
  film::Mixture run(const Settings& settings, const Picture& picture, gl::ProgramCache& programs, gl::PassTimer& timer,
                    const std::atomic<bool>& cancelled);
  // Why another denoiser ran than was asked for, with the remedy; empty otherwise.
  const std::string& warning() const { return warning_; }
  // Frees all that run() allocated.
  void release();

 private:
  EdgeAvoidingFilter filter_;
  std::string warning_;
};

}  // namespace panoptes::denoise
