// Pixels of a texture, rows bottom to top as OpenGL and Blender have them, with all the coarser
// levels that a texture has: made on the host by whoever decodes, so that many images are made at
// once, and averaged as light where the driver would average codes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace panoptes::scene {

// What Blender's alpha mode says of the pixels as stored in the file.
enum class AlphaMode { kStraight, kPremultiplied, kChannelPacked, kNone };

// How a channel is stored, as the file has it: 8 bits stay 8 bits.
enum class PixelType : uint32_t { kByte, kShort, kHalf, kFloat };
size_t bytes_of(PixelType type);

struct ImageLevel {
  int width = 0, height = 0;
  // width * height texels without gaps; shared by copies, so nobody writes once an image is made.
  std::shared_ptr<std::byte[]> pixels;
};

struct Image {
  std::string name;
  int width = 0, height = 0;
  PixelType type = PixelType::kByte;
  int channels = 4;   // 1: grey, 2: grey and alpha, 4: colour and alpha
  bool srgb = false;  // the values are sRGB codes; else linear
  // Finest first, down to one texel; empty once released. Colour is premultiplied by alpha, in
  // codes where they are codes, as Cycles filters it.
  std::vector<ImageLevel> levels;
  int64_t serial = 0;  // tells what a scene was handed under one id apart; set by the scene
  // Makes the same image again, so that its pixels may be released meanwhile; empty when there is
  // no other source. Throws Error when the source is gone.
  std::function<Image()> reload;

  size_t texel_bytes() const { return bytes_of(type) * size_t(channels); }
  size_t bytes() const { return texel_bytes() * size_t(width) * size_t(height); }
  template <class T = std::byte>
  std::span<T> pixels() {
    return {reinterpret_cast<T*>(levels[0].pixels.get()), bytes() / sizeof(T)};
  }
  template <class T = std::byte>
  std::span<const T> pixels() const {
    return {reinterpret_cast<const T*>(levels[0].pixels.get()), bytes() / sizeof(T)};
  }
};

// An image whose finest level waits to be filled. Throws Error on a size that no image has or that
// does not fit into memory.
Image new_image(std::string name, int width, int height, PixelType type, int channels, bool srgb);

// Brings what was filled in to the stored form: values that are not finite become 0, colour is
// multiplied by alpha where `alpha` calls for it, and the coarser levels are made.
void finish_image(Image& image, AlphaMode alpha);

// Both at once, from four channels a pixel. Throws Error when the sizes do not fit.
Image make_image(std::string name, int width, int height, std::span<const uint8_t> rgba, bool srgb,
                 AlphaMode alpha);
Image make_image(std::string name, int width, int height, std::span<const float> rgba, bool srgb,
                 AlphaMode alpha);

// The coarser levels alone (scene/image_levels.cpp): each texel is the mean of those that it
// covers.
void make_levels(Image& image);

}  // namespace panoptes::scene
