#include "scene/image.h"

#include "base/error.h"

#include <cmath>

namespace panoptes::scene {

namespace {

void check_size(const std::string& name, int width, int height, size_t values) {
  if (width < 1 || height < 1 || values != size_t(width) * size_t(height) * 4)
    fail("image '{}' has no pixels or a broken size ({}x{}): reload it or replace it", name, width,
         height);
}

uint8_t multiplied(uint8_t value, uint8_t alpha) {
  return uint8_t((int(value) * alpha + 127) / 255);
}

}  // namespace

Image make_image(std::string name, int width, int height, std::span<const uint8_t> rgba, bool srgb,
                 AlphaMode alpha) {
  check_size(name, width, height, rgba.size());
  Image image{std::move(name), width, height, srgb, {rgba.begin(), rgba.end()}, {}};
  // Data that is no colour is never premultiplied.
  const bool premultiply = srgb && alpha == AlphaMode::kStraight;
  for (size_t i = 0; i < image.bytes.size(); i += 4) {
    uint8_t* p = &image.bytes[i];
    if (alpha == AlphaMode::kNone) p[3] = 255;
    if (premultiply && p[3] != 255)
      for (int c = 0; c < 3; ++c) p[c] = multiplied(p[c], p[3]);
  }
  return image;
}

Image make_image(std::string name, int width, int height, std::span<const float> rgba, bool srgb,
                 AlphaMode alpha) {
  check_size(name, width, height, rgba.size());
  Image image{std::move(name), width, height, srgb, {}, {rgba.begin(), rgba.end()}};
  for (size_t i = 0; i < image.floats.size(); i += 4) {
    float* p = &image.floats[i];
    for (int c = 0; c < 4; ++c)
      if (!std::isfinite(p[c])) p[c] = 0.0f;
    if (alpha == AlphaMode::kNone) p[3] = 1.0f;
    if (alpha == AlphaMode::kStraight && srgb)
      for (int c = 0; c < 3; ++c) p[c] *= p[3];
  }
  return image;
}

}  // namespace panoptes::scene
