#include "scene/image.h"

#include "base/error.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>
#include <new>

namespace panoptes::scene {

namespace {

// One of each type: what is opaque, and a product of two values.
struct Byte {
  using Value = uint8_t;
  static constexpr Value kOne = 255;
  static Value finite(Value v) { return v; }
  static Value times(Value v, Value a) { return Value((unsigned(v) * a + 127) / 255); }
};
struct Short {
  using Value = uint16_t;
  static constexpr Value kOne = 65535;
  static Value finite(Value v) { return v; }
  static Value times(Value v, Value a) { return Value((uint64_t(v) * a + 32767) / 65535); }
};
struct Half {
  using Value = uint16_t;  // bits of a half float
  static constexpr Value kOne = 0x3c00;
  static Value finite(Value v) { return (v & 0x7c00) == 0x7c00 ? Value(0) : v; }
  static Value times(Value v, Value a) {
    return glm::packHalf1x16(glm::unpackHalf1x16(v) * glm::unpackHalf1x16(a));
  }
};
struct Float {
  using Value = float;
  static constexpr Value kOne = 1.0f;
  static Value finite(Value v) { return std::isfinite(v) ? v : 0.0f; }
  static Value times(Value v, Value a) { return v * a; }
};

template <class Type>
void finish_pixels(Image& image, AlphaMode alpha) {
  using Value = typename Type::Value;
  const std::span<Value> values = image.pixels<Value>();
  if constexpr (std::is_same_v<Type, Half> || std::is_same_v<Type, Float>)
    for (Value& value : values) value = Type::finite(value);
  const size_t channels = size_t(image.channels);
  if (channels % 2 != 0) return;  // no alpha
  // Data that is no colour is never premultiplied.
  const bool premultiply = image.srgb && alpha == AlphaMode::kStraight;
  if (alpha != AlphaMode::kNone && !premultiply) return;
  for (size_t i = 0; i < values.size(); i += channels) {
    Value* p = &values[i];
    Value& a = p[channels - 1];
    if (alpha == AlphaMode::kNone) a = Type::kOne;
    if (premultiply && a != Type::kOne)
      for (size_t c = 0; c + 1 < channels; ++c) p[c] = Type::times(p[c], a);
  }
}

template <class T>
Image filled(std::string name, int width, int height, PixelType type, std::span<const T> rgba,
             bool srgb, AlphaMode alpha) {
  if (width < 1 || height < 1 || rgba.size() != size_t(width) * size_t(height) * 4)
    fail("image '{}' has no pixels or a broken size ({}x{}): reload it or replace it", name, width,
         height);
  Image image = new_image(std::move(name), width, height, type, 4, srgb);
  std::copy(rgba.begin(), rgba.end(), image.pixels<T>().begin());
  finish_image(image, alpha);
  return image;
}

}  // namespace

size_t bytes_of(PixelType type) {
  switch (type) {
    case PixelType::kByte: return 1;
    case PixelType::kFloat: return 4;
    default: return 2;
  }
}

Image new_image(std::string name, int width, int height, PixelType type, int channels, bool srgb) {
  if (width < 1 || height < 1)
    fail("image '{}' has no pixels or a broken size ({}x{}): reload it or replace it", name, width,
         height);
  Image image;
  image.name = std::move(name);
  image.width = width;
  image.height = height;
  image.type = type;
  image.channels = channels;
  image.srgb = srgb;
  try {
    image.levels = {{width, height, std::make_shared_for_overwrite<std::byte[]>(image.bytes())}};
  } catch (const std::bad_alloc&) {
    fail("image '{}' ({}x{}) does not fit into memory: scale it down", image.name, width, height);
  }
  return image;
}

void finish_image(Image& image, AlphaMode alpha) {
  switch (image.type) {
    case PixelType::kByte: finish_pixels<Byte>(image, alpha); break;
    case PixelType::kShort: finish_pixels<Short>(image, alpha); break;
    case PixelType::kHalf: finish_pixels<Half>(image, alpha); break;
    case PixelType::kFloat: finish_pixels<Float>(image, alpha); break;
  }
  make_levels(image);
}

Image make_image(std::string name, int width, int height, std::span<const uint8_t> rgba, bool srgb,
                 AlphaMode alpha) {
  return filled(std::move(name), width, height, PixelType::kByte, rgba, srgb, alpha);
}

Image make_image(std::string name, int width, int height, std::span<const float> rgba, bool srgb,
                 AlphaMode alpha) {
  return filled(std::move(name), width, height, PixelType::kFloat, rgba, srgb, alpha);
}

}  // namespace panoptes::scene
