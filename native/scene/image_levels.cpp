#include "scene/image.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace panoptes::scene {

namespace {

double light_of_code(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

double code_of_light(double light) {
  return light <= 0.0031308 ? light * 12.92 : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

// sRGB codes to light in 16 bits and back, by tables. The way back has as many bits as tell all codes
// apart: 13 for 8-bit codes, whose table then stays in the processor's first cache.
template <class Code>
struct LightTables {
  static constexpr double kMax = double(std::numeric_limits<Code>::max());
  static constexpr int kDropped = sizeof(Code) == 1 ? 3 : 0;  // bits of the 16
  std::vector<uint16_t> light;
  std::vector<Code> code;

  LightTables() : light(size_t(kMax) + 1), code(65536 >> kDropped) {
    for (size_t i = 0; i < light.size(); ++i)
      light[i] = uint16_t(std::lround(light_of_code(double(i) / kMax) * 65535));
    // Each entry stands for the middle of the light that leads to it.
    const double middle = 0.5 * ((1 << kDropped) - 1);
    for (size_t i = 0; i < code.size(); ++i)
      code[i] = Code(std::lround(
          code_of_light((double(i << kDropped) + middle) / 65535) * kMax));
  }
  static const LightTables& get() {
    static const LightTables tables;
    return tables;
  }
};

// How values are averaged: `in` gives a number to sum, `out` the value of such a mean, and
// `of_four` the mean of four values.
template <class Code>
struct AsCodes {
  static float in(Code code) { return float(code); }
  static Code out(float mean) { return Code(mean + 0.5f); }
  static Code of_four(Code a, Code b, Code c, Code d) {
    return Code((uint32_t(a) + b + c + d + 2) / 4);
  }
};
template <class Code>
struct AsLight {
  const LightTables<Code>& tables = LightTables<Code>::get();
  float in(Code code) const { return float(tables.light[code]); }
  Code out(float mean) const {
    return tables.code[size_t(mean + 0.5f) >> LightTables<Code>::kDropped];
  }
  Code of_four(Code a, Code b, Code c, Code d) const {
    const uint16_t* light = tables.light.data();
    const uint32_t sum = uint32_t(light[a]) + light[b] + light[c] + light[d] + 2;
    return tables.code[sum >> (2 + LightTables<Code>::kDropped)];
  }
};
struct AsFloats {
  static float in(float value) { return value; }
  static float out(float mean) { return mean; }
  // Shares before sums: four large floats would overflow.
  static float of_four(float a, float b, float c, float d) {
    return 0.25f * a + 0.25f * b + 0.25f * c + 0.25f * d;
  }
};
struct AsHalves {
  static float in(uint16_t bits) { return glm::unpackHalf1x16(bits); }
  static uint16_t out(float mean) { return glm::packHalf1x16(mean); }
  static uint16_t of_four(uint16_t a, uint16_t b, uint16_t c, uint16_t d) {
    return out(AsFloats::of_four(in(a), in(b), in(c), in(d)));
  }
};

// The texels that one texel of the next level covers along an axis, with their shares: two, or
// three where the number is odd.
struct Taps {
  int first = 0, count = 1;
  std::array<float, 3> share{1, 0, 0};
};

std::vector<Taps> taps_of(int size, int next) {
  std::vector<Taps> taps{size_t(next)};
  for (int i = 0; i < next; ++i) {
    Taps& t = taps[size_t(i)];
    const double low = double(i) * size / next, high = double(i + 1) * size / next;
    t.first = int(low);
    t.count = std::min(int(std::ceil(high - 1e-9)), size) - t.first;
    for (int k = 0; k < t.count; ++k)
      t.share[size_t(k)] =
          float((std::min(high, double(t.first + k + 1)) - std::max(low, double(t.first + k))) /
                (high - low));
  }
  return taps;
}

// Colour goes through `color`, alpha (the last of an even number of channels) through `alpha`.
template <class T, int kChannels, class Color, class Alpha>
void average(const ImageLevel& fine, const ImageLevel& coarse, const Color& color,
             const Alpha& alpha) {
  const auto* from = reinterpret_cast<const T*>(fine.pixels.get());
  auto* to = reinterpret_cast<T*>(coarse.pixels.get());
  const std::vector<Taps> columns = taps_of(fine.width, coarse.width),
                          rows = taps_of(fine.height, coarse.height);
  constexpr int kColors = kChannels % 2 ? kChannels : kChannels - 1;
  const size_t pitch = size_t(fine.width) * kChannels;
  const bool halves = fine.width == 2 * coarse.width && fine.height == 2 * coarse.height;
  for (int y = 0; y < coarse.height; ++y) {
    const Taps& v = rows[size_t(y)];
    const T* p = from + size_t(v.first) * pitch;
    if (halves) {
      const T* q = p + pitch;
      for (int x = 0; x < coarse.width;
           ++x, to += kChannels, p += 2 * kChannels, q += 2 * kChannels) {
        const auto mean = [&](const auto& as, int c) {
          return as.of_four(p[c], p[c + kChannels], q[c], q[c + kChannels]);
        };
        for (int c = 0; c < kColors; ++c) to[c] = mean(color, c);
        if constexpr (kColors < kChannels) to[kColors] = mean(alpha, kColors);
      }
      continue;
    }
    for (int x = 0; x < coarse.width; ++x, to += kChannels) {
      const Taps& h = columns[size_t(x)];
      const auto mean = [&](const auto& as, int c) {
        float sum = 0;
        for (int j = 0; j < v.count; ++j)
          for (int i = 0; i < h.count; ++i)
            sum += v.share[size_t(j)] * h.share[size_t(i)] *
                   as.in(p[size_t(j) * pitch + size_t((h.first + i) * kChannels + c)]);
        return as.out(sum);
      };
      for (int c = 0; c < kColors; ++c) to[c] = mean(color, c);
      if constexpr (kColors < kChannels) to[kColors] = mean(alpha, kColors);
    }
  }
}

template <class T, class Color, class Alpha>
void average(int channels, const ImageLevel& fine, const ImageLevel& coarse, const Color& color,
             const Alpha& alpha) {
  switch (channels) {
    case 1: return average<T, 1>(fine, coarse, color, alpha);
    case 2: return average<T, 2>(fine, coarse, color, alpha);
    default: return average<T, 4>(fine, coarse, color, alpha);
  }
}

template <class Code>
void average_codes(const Image& image, bool light, const ImageLevel& fine,
                   const ImageLevel& coarse) {
  const AsCodes<Code> codes;
  if (light)
    average<Code>(image.channels, fine, coarse, AsLight<Code>{}, codes);
  else
    average<Code>(image.channels, fine, coarse, codes, codes);
}

template <class T>
bool opaque(const Image& image) {
  if (image.channels % 2 != 0) return true;
  const std::span<const T> values = image.pixels<T>();
  const size_t channels = size_t(image.channels), row = size_t(image.width) * channels;
  for (size_t first = 0; first < values.size(); first += row) {
    // All bits of all alphas at once: without an exit in the middle the compiler makes vectors of it.
    T common = std::numeric_limits<T>::max();
    for (size_t i = first + channels - 1; i < first + row; i += channels) common &= values[i];
    if (common != std::numeric_limits<T>::max()) return false;
  }
  return true;
}

// True where levels have to be averages of light. Where codes are multiplied by alpha, only an
// average of codes can be divided by the average of alpha again.
bool averages_light(const Image& image) {
  if (!image.srgb) return false;
  if (image.type == PixelType::kByte) return opaque<uint8_t>(image);
  return image.type == PixelType::kShort && opaque<uint16_t>(image);
}

}  // namespace

void make_levels(Image& image) {
  image.levels.resize(1);
  const bool light = averages_light(image);
  while (image.levels.back().width > 1 || image.levels.back().height > 1) {
    const ImageLevel fine = image.levels.back();
    ImageLevel coarse{std::max(fine.width / 2, 1), std::max(fine.height / 2, 1), {}};
    coarse.pixels = std::make_shared_for_overwrite<std::byte[]>(
        size_t(coarse.width) * size_t(coarse.height) * image.texel_bytes());
    switch (image.type) {
      case PixelType::kByte: average_codes<uint8_t>(image, light, fine, coarse); break;
      case PixelType::kShort: average_codes<uint16_t>(image, light, fine, coarse); break;
      case PixelType::kHalf:
        average<uint16_t>(image.channels, fine, coarse, AsHalves{}, AsHalves{});
        break;
      case PixelType::kFloat:
        average<float>(image.channels, fine, coarse, AsFloats{}, AsFloats{});
        break;
    }
    image.levels.push_back(std::move(coarse));
  }
}

}  // namespace panoptes::scene
