#include "denoise/denoiser.h"

#include "base/choices.h"
#include "base/error.h"
#include "denoise/oidn.h"

namespace panoptes::denoise {

void Settings::check() const { check_choice(kDenoiserNames, denoiser, "denoiser"); }

film::Mixture Denoise::run(const Settings& settings, const Picture& picture, gl::ProgramCache& programs,
                           gl::PassTimer& timer, const std::atomic<bool>& cancelled) {
  warning_.clear();
  const auto mixed = [&](std::span<const float> smooth, std::span<const float> shared) {
    return film::mix_by_error(picture.width, picture.height, smooth, picture.noisy, picture.variance, shared);
  };
  const bool asked = settings.denoiser == Denoiser::kOidn;
  if (asked && !has_oidn())
    warning_ = "OpenImageDenoise was not found, and the edge-avoiding denoiser is used: install it, or choose that one";
  if ((asked || settings.denoiser == Denoiser::kAuto) && has_oidn()) {
    try {
      gl::PassScope scope(timer, "denoiser");
      return mixed(denoise_with_oidn(picture), {});
    } catch (const Error& error) {
      warning_ = error.what();
    }
  }
  const Filtered filtered = filter_.run(picture, programs, timer, cancelled);
  return mixed(filtered.pixels, filtered.variance);
}

void Denoise::release() { filter_.release(); }

}  // namespace panoptes::denoise
