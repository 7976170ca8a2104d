// Images as they are stored: premultiplied, finite, with all their levels.
#include "base/error.h"
#include "support.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

namespace panoptes::test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

TEST(MakeImage, PremultipliesStraightColoursInTheirCodes) {
  const uint8_t rgba[8] = {128, 64, 255, 64, 255, 0, 7, 255};
  const auto bytes = [&](bool srgb, scene::AlphaMode mode) {
    const scene::Image image =
        scene::make_image("i", 2, 1, std::span<const uint8_t>(rgba), srgb, mode);
    const std::span<const uint8_t> stored = image.pixels<uint8_t>();
    return std::vector<uint8_t>(stored.begin(), stored.end());
  };
  using Bytes = std::vector<uint8_t>;
  EXPECT_EQ(bytes(true, scene::AlphaMode::kStraight), (Bytes{32, 16, 64, 64, 255, 0, 7, 255}));
  EXPECT_EQ(bytes(true, scene::AlphaMode::kPremultiplied), (Bytes(rgba, rgba + 8)));
  EXPECT_EQ(bytes(true, scene::AlphaMode::kChannelPacked), (Bytes(rgba, rgba + 8)));
  EXPECT_EQ(bytes(true, scene::AlphaMode::kNone), (Bytes{128, 64, 255, 255, 255, 0, 7, 255}));
  EXPECT_EQ(bytes(false, scene::AlphaMode::kStraight), (Bytes(rgba, rgba + 8)));  // no colour
}

TEST(MakeImage, KeepsFloatsFinite) {
  const float rgba[4] = {kNaN, 2, std::numeric_limits<float>::infinity(), 0.5f};
  const scene::Image image =
      scene::make_image("i", 1, 1, std::span<const float>(rgba), true, scene::AlphaMode::kStraight);
  const std::span<const float> stored = image.pixels<float>();
  EXPECT_EQ(std::vector<float>(stored.begin(), stored.end()), (std::vector<float>{0, 1, 0, 0.5f}));
}

double light(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

// A byte image of noise.
scene::Image noise(int width, int height, bool srgb, scene::AlphaMode alpha) {
  std::vector<uint8_t> rgba(size_t(width * height * 4));
  std::mt19937 random(unsigned(width * 100 + height));
  for (uint8_t& value : rgba) value = uint8_t(random());
  return scene::make_image("noise", width, height, std::span<const uint8_t>(rgba), srgb, alpha);
}

TEST(ImageLevels, EndAtOneTexelThatIsTheMeanOfAll) {
  // Codes are rounded once a level.
  for (const auto& [width, height] : {std::pair(8, 8), {7, 5}, {1, 9}, {13, 1}, {64, 3}, {1, 1}}) {
    const scene::Image data = noise(width, height, false, scene::AlphaMode::kChannelPacked),
                       lit = noise(width, height, true, scene::AlphaMode::kNone);
    ASSERT_EQ(data.levels.back().width * data.levels.back().height, 1);
    double mean = 0, mean_light = 0;
    const std::span<const uint8_t> codes = data.pixels<uint8_t>();
    for (size_t i = 0; i < codes.size(); i += 4) {
      mean += codes[i];
      mean_light += light(codes[i] / 255.0);
    }
    const double texels = width * height, levels = double(data.levels.size());
    EXPECT_NEAR(double(data.levels.back().pixels[0]), mean / texels, levels)
        << width << "x" << height;
    const double last = light(double(lit.levels.back().pixels[0]) / 255);
    EXPECT_NEAR(last, mean_light / texels, 0.01 * levels) << width << "x" << height;
    if (width * height > 30) {
      EXPECT_GT(std::abs(last - light(mean / texels / 255)), 0.05) << "light and codes differ";
    }
  }
}

TEST(ImageLevels, OfColourTimesAlphaAreMeansOfCodes) {
  const uint8_t rgba[16] = {255, 255, 255, 255, 255, 255, 255, 0,
                            255, 255, 255, 255, 255, 255, 255, 0};
  const scene::Image image = scene::make_image("i", 2, 2, std::span<const uint8_t>(rgba), true,
                                               scene::AlphaMode::kStraight);
  for (size_t c = 0; c < 4; ++c) EXPECT_EQ(int(image.levels[1].pixels[std::ptrdiff_t(c)]), 128);
}

TEST(ImageLevels, OfHugeFloatsStayFinite) {
  const float huge = std::numeric_limits<float>::max();
  const std::vector<float> rgba(16, huge);
  const scene::Image image = scene::make_image("i", 2, 2, std::span<const float>(rgba), false,
                                               scene::AlphaMode::kPremultiplied);
  float value;
  std::memcpy(&value, image.levels[1].pixels.get(), sizeof value);
  EXPECT_EQ(value, huge);
}

TEST(MakeImage, RefusesSizesThatDoNotFit) {
  const uint8_t rgba[8] = {};
  for (const auto& [w, h] : {std::pair(0, 1), {1, 0}, {-1, -2}, {1, 1}, {3, 1}})
    expect_error(
        [&, w = w, h = h] {
          scene::make_image("wood", w, h, std::span<const uint8_t>(rgba), true,
                            scene::AlphaMode::kNone);
        },
        "'wood'");
}

}  // namespace
}  // namespace panoptes::test
