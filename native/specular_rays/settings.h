// Traced reflections and refractions of Real-time: one ray a pixel from mirrors and glass.
#pragma once

#include <array>
#include <string_view>

namespace panoptes::specular_rays {

enum class Mode {
  kAuto,  // where the scene has surfaces that are smooth enough to tell
  kOff,
  kOn,    // from all glossy surfaces, whatever their roughness
};
constexpr std::array<std::string_view, 3> kModeNames{"auto", "off", "on"};

struct Settings {
  Mode mode = Mode::kAuto;
  float roughness = 0.3f;  // 0 .. 1: rougher surfaces show the cache and the world, with kAuto

  // Throws Error with a sentence when a value is out of range.
  void check() const;
};

}  // namespace panoptes::specular_rays
