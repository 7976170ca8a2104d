// Denoising of pictures by paths, as an artist may choose it.
#pragma once

#include <array>
#include <string_view>

namespace panoptes::denoise {

enum class Denoiser {
  kOff,
  kAuto,          // OpenImageDenoise where the computer has it, else kEdgeAvoiding
  kEdgeAvoiding,  // edge_avoiding.h
  kOidn,          // OpenImageDenoise, loaded at run time (oidn.h); kEdgeAvoiding where it is not found
};
constexpr std::array<std::string_view, 4> kDenoiserNames{"off", "auto", "edge_avoiding", "oidn"};

struct Settings {
  Denoiser denoiser = Denoiser::kOff;

  // Throws Error with a sentence when a value is out of range.
  void check() const;
};

}  // namespace panoptes::denoise
