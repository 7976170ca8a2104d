#include "denoise/decide.h"

namespace panoptes::denoise {

plan::Effects decide(const DecideSettings& settings) {
  const bool off = settings.denoise.denoiser == Denoiser::kOff, few = settings.samples < 2;
  const bool other = settings.shown_pass != film::Pass::kCombined;
  const bool runs = !off && settings.path_tracing && !few && !other;
  const char* reason = runs                     ? "takes the noise of paths out of Combined"
                       : off                    ? "switched off in the settings"
                       : !settings.path_tracing ? "Real-time's pictures have too little noise for it"
                       : few                    ? "one sample does not tell its noise"
                                                : "only Combined is denoised";
  return {{"denoiser", runs, reason, true}};
}

}  // namespace panoptes::denoise
