// The host's half of base/packing.glsl.
#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace panoptes::scene {

// Octahedral map in 2 x 16 bits, the same as pack_unit() of base/packing.glsl. `n` need not be unit;
// a vector that is zero or not finite becomes +Z.
inline uint32_t pack_unit(glm::vec3 n) {
  const float sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  if (!(sum > 0) || !std::isfinite(sum)) n = {0, 0, 1};
  else n /= sum;
  glm::vec2 o{n.x, n.y};
  if (n.z < 0)
    o = {(1 - std::abs(n.y)) * (n.x >= 0 ? 1.0f : -1.0f),
         (1 - std::abs(n.x)) * (n.y >= 0 ? 1.0f : -1.0f)};
  // Truncation after half a step rounds like lround(), which is a call for each number.
  const auto snorm = [](float v) {
    const float scaled = std::clamp(v, -1.0f, 1.0f) * 32767.0f;
    return uint32_t(uint16_t(int16_t(scaled + std::copysign(0.5f, scaled))));
  };
  return snorm(o.x) | snorm(o.y) << 16;
}

}  // namespace panoptes::scene
