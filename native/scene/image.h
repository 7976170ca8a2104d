// Pixels of a texture, rows bottom to top as OpenGL and Blender have them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace panoptes::scene {

// What Blender's alpha mode says of the pixels as stored in the file.
enum class AlphaMode { kStraight, kPremultiplied, kChannelPacked, kNone };

struct Image {
  std::string name;
  int width = 0, height = 0;
  bool srgb = false;  // the values are sRGB codes, 0..1 or 0..255; else linear
  // Exactly one of the two is filled, four channels a pixel. Colour is premultiplied by alpha, in
  // codes where they are codes, as Cycles filters it.
  std::vector<uint8_t> bytes;
  std::vector<float> floats;

  bool is_float() const { return !floats.empty(); }
};

// Makes the stored form from four channels a pixel. Floats that are not finite become 0. Throws
// Error when the sizes do not fit.
Image make_image(std::string name, int width, int height, std::span<const uint8_t> rgba, bool srgb,
                 AlphaMode alpha);
Image make_image(std::string name, int width, int height, std::span<const float> rgba, bool srgb,
                 AlphaMode alpha);

}  // namespace panoptes::scene
