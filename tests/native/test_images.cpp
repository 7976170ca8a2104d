// Image textures as Cycles filters them: codes are filtered, then linearised.
#include "gpu_scene/gpu_scene.h"
#include "gl/counters.h"
#include "support.h"

#include <fmt/ranges.h>

#include <glm/gtc/packing.hpp>

#include <array>
#include <cmath>
#include <chrono>
#include <thread>

namespace panoptes::test {
namespace {

using film::Pass;
using scene::AlphaMode;
using Extension = scene::TextureUse::Extension;

// Bytes are interpolated with eight bits here and there: one code, and its slope in linear light.
constexpr double kCode = 1.0 / 255, kLinear = 2.3 / 255;

double linear(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

// uv * param(0).xy + param(0).zw; the texel's colour and alpha as emission.
std::string show(bool unassociate, bool alpha = false) {
  return fmt::format("void evaluate_material(const Hit hit, inout Surface surface) {{\n"
                     "  vec2 uv = hit_uv(hit, UV_DEFAULT) * param(0).xy + param(0).zw;\n"
                     "  vec4 texel = sample_image(hit, 0, uv, {});\n"
                     "  closure_emission(surface, vec3(1.0), {});\n"
                     "}}\n",
                     unassociate, alpha ? "texel.aaa" : "texel.rgb");
}

// A square that fills the picture and shows image 1; uv run over `scale` from `offset`.
TestScene shown(scene::Image image, const std::string& code, scene::TextureUse use = {},
                glm::vec2 scale = {1, 1}, glm::vec2 offset = {0, 0}) {
  TestScene s;
  use.image = s.add_image(std::move(image));
  scene::Material m =
      material(code, {glm::vec4(scale, offset)}, {.emission = true, .glossy = false});
  m.textures = {use};
  s.add_object(floor_at(0, 1), {s.add_material(m)});
  return s;
}

const gpu_scene::Camera kAbove = orthographic({0, 0, 2}, {0, 0, 0}, 1, 32, 32);

Picture picture_of(const TestScene& s) { return render(s, request(kAbove, {Pass::kEmit})); }

scene::Image bytes(int width, int height, const std::vector<uint8_t>& rgba, bool srgb,
                   AlphaMode mode = AlphaMode::kNone) {
  return scene::make_image("image", width, height, std::span<const uint8_t>(rgba), srgb, mode);
}

scene::Image floats(int width, int height, const std::vector<float>& rgba,
                    AlphaMode mode = AlphaMode::kNone) {
  return scene::make_image("image", width, height, std::span<const float>(rgba), false, mode);
}

std::vector<float> uniform(const std::vector<float>& rgba, int texels) {
  std::vector<float> all;
  for (int i = 0; i < texels; ++i) all.insert(all.end(), rgba.begin(), rgba.end());
  return all;
}

TEST(Images, FirstRowIsTheBottom) {
  const std::vector<float> pixels{1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1, 1, 1, 1, 1};
  const Picture p = picture_of(shown(floats(2, 2, pixels), show(false), {.closest = true}));
  EXPECT_EQ(p.rgb(Pass::kEmit, 4, 4), glm::dvec3(1, 0, 0));
  EXPECT_EQ(p.rgb(Pass::kEmit, 28, 4), glm::dvec3(0, 1, 0));
  EXPECT_EQ(p.rgb(Pass::kEmit, 4, 28), glm::dvec3(0, 0, 1));
  EXPECT_EQ(p.rgb(Pass::kEmit, 28, 28), glm::dvec3(1, 1, 1));
}

TEST(Images, SrgbCodesAreLinearisedAfterFiltering) {
  // Black and white: the midpoint is code one half, .2140 in linear light (.2159 for code 128).
  const TestScene s = shown(bytes(2, 1, {0, 0, 0, 255, 255, 255, 255, 255}, true), show(false));
  const Picture p = picture_of(s);
  Worst worst;
  for (int x = 8; x < 24; ++x) {  // between the two texel centres, at u = .25 and .75
    const double code = ((x + 0.5) / 32 - 0.25) / 0.5;
    worst.compare(p.value(Pass::kEmit, x, 16), linear(code), 1, x, 16);
  }
  EXPECT_WORST_BELOW(worst, kLinear);
}

TEST(Images, DataIsNotDecoded) {
  const Picture p = picture_of(shown(bytes(1, 1, {128, 64, 255, 255}, false), show(false)));
  EXPECT_NEAR(p.value(Pass::kEmit, 16, 16, 0), 128 / 255.0, 1e-6);
  EXPECT_NEAR(p.value(Pass::kEmit, 16, 16, 1), 64 / 255.0, 1e-6);
}

TEST(Images, EveryCodeIsDecoded) {
  std::vector<uint8_t> ramp;
  for (int i = 0; i < 256; ++i)
    ramp.insert(ramp.end(), {uint8_t(i), uint8_t(255 - i), uint8_t(i), 255});
  TestScene s = shown(bytes(256, 1, ramp, true), show(false), {.closest = true});
  const Picture p =
      render(s, request(orthographic({0, 0, 2}, {0, 0, 0}, 1, 256, 256), {Pass::kEmit}));
  Worst worst;
  for (int x = 0; x < 256; ++x)
    worst.compare(p.value(Pass::kEmit, x, 100), linear(x / 255.0), 1e-3, x, 0);
  EXPECT_WORST_BELOW(worst, 1e-4);
}

TEST(Images, LinearFilterAndExtensions) {
  const std::vector<float> row{1, 0, 0, 1, 0, 2, 0, 1, 0, 0, 4, 1, 3, 3, 3, 1};
  for (const Extension extension : {Extension::kRepeat, Extension::kExtend, Extension::kClip})
    for (bool closest : {false, true}) {
      // u runs from -1 to 2.
      const Picture p =
          picture_of(shown(floats(4, 1, row), show(false),
                           {.closest = closest, .extension = extension}, {3, 0}, {-1, 0.5f}));
      Worst worst;
      const auto fetch = [&](int i, int c) {
        if (extension == Extension::kClip && (i < 0 || i > 3)) return 0.0;
        i = extension == Extension::kRepeat ? ((i % 4) + 4) % 4 : std::clamp(i, 0, 3);
        return double(row[size_t(i * 4 + c)]);
      };
      for (int x = 0; x < 32; ++x) {
        const double u = ((x + 0.5) / 32 * 3 - 1) * 4;
        for (int c = 0; c < 3; ++c) {
          const int i = int(std::floor(closest ? u : u - 0.5));
          const double t = u - 0.5 - i;
          const double due = closest ? fetch(i, c) : (1 - t) * fetch(i, c) + t * fetch(i + 1, c);
          worst.compare(p.value(Pass::kEmit, x, 16, c), due, 1, x, c);
        }
      }
      EXPECT_WORST_BELOW(worst, 1e-5) << "extension " << int(extension) << " closest " << closest;
    }
}

TEST(Images, StraightAlphaIsPremultipliedInCodes) {
  // (.5, .25, 1, .25) -> .01444 .00518 .0513: linear(code * alpha), as measured.
  const std::vector<uint8_t> texel{128, 64, 255, 64};
  const double a = 64 / 255.0;
  const Picture p = picture_of(shown(bytes(1, 1, texel, true, AlphaMode::kStraight), show(false)));
  EXPECT_NEAR(p.value(Pass::kEmit, 16, 16, 0), linear(128 / 255.0 * a), kCode * 0.1);
  EXPECT_NEAR(p.value(Pass::kEmit, 16, 16, 1), linear(64 / 255.0 * a), kCode * 0.1);
  EXPECT_NEAR(p.value(Pass::kEmit, 16, 16, 2), linear(a), kCode * 0.5);
}

TEST(Images, UnassociatedColourIsThatOfTheFile) {
  const std::vector<uint8_t> texel{128, 64, 255, 64};
  const Picture p = picture_of(shown(bytes(1, 1, texel, true, AlphaMode::kStraight), show(true)));
  // Premultiplied codes are whole numbers: half a code over alpha, times the slope.
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(p.value(Pass::kEmit, 16, 16, c), linear(texel[size_t(c)] / 255.0),
                0.5 * kLinear * 4);
  const Picture alpha =
      picture_of(shown(bytes(1, 1, texel, true, AlphaMode::kStraight), show(true, true)));
  EXPECT_NEAR(alpha.value(Pass::kEmit, 16, 16), 64 / 255.0, 1e-6);
}

TEST(Images, AlphaIsFilteredWithoutChangingTheColour) {
  // White from alpha 1 to alpha 0: colour stays 1 while alpha falls linearly.
  const std::vector<uint8_t> row{255, 255, 255, 255, 255, 255, 255, 0};
  const Picture color = picture_of(shown(bytes(2, 1, row, true, AlphaMode::kStraight), show(true))),
                alpha = picture_of(
                    shown(bytes(2, 1, row, true, AlphaMode::kStraight), show(true, true)));
  for (int x = 9; x < 23; ++x) {
    EXPECT_NEAR(color.value(Pass::kEmit, x, 16), 1, 0.02) << x;
    EXPECT_NEAR(alpha.value(Pass::kEmit, x, 16), 1 - ((x + 0.5) / 32 - 0.25) / 0.5, 1.5 * kCode)
        << x;
  }
}

TEST(Images, OtherAlphaModes) {
  const std::vector<uint8_t> texel{128, 64, 255, 64};
  for (const AlphaMode mode :
       {AlphaMode::kChannelPacked, AlphaMode::kNone, AlphaMode::kPremultiplied}) {
    const Picture color = picture_of(shown(bytes(1, 1, texel, true, mode), show(false))),
                  alpha = picture_of(shown(bytes(1, 1, texel, true, mode), show(false, true)));
    EXPECT_NEAR(color.value(Pass::kEmit, 16, 16), linear(128 / 255.0), 1e-4);
    EXPECT_NEAR(alpha.value(Pass::kEmit, 16, 16), mode == AlphaMode::kNone ? 1 : 64 / 255.0, 1e-6);
  }
}

TEST(Images, FloatsKeepTheirRange) {
  const Picture p = picture_of(shown(floats(1, 1, {1e-5f, 1234.5f, 70000, 1}), show(false)));
  EXPECT_EQ(p.rgb(Pass::kEmit, 16, 16), glm::dvec3(1e-5f, 1234.5f, 70000));
}

TEST(Images, MissingOnesAreMagenta) {
  TestScene s = shown(floats(1, 1, {1, 1, 1, 1}), show(false));
  s.images.clear();
  EXPECT_EQ(picture_of(s).rgb(Pass::kEmit, 16, 16), glm::dvec3(1, 0, 1));
  // And shown again when they are found.
  s.add_image(floats(1, 1, {0.5f, 0.25f, 2, 1}));
  EXPECT_EQ(picture_of(s).rgb(Pass::kEmit, 16, 16), glm::dvec3(0.5, 0.25, 2));
}

TEST(Images, ThatAreTooLargeAreScaledDownWithAWarning) {
  const int side = shared_engine().device().max_texture_size + 1;
  TestScene s = shown(floats(side, 1, uniform({1, 0.5f, 3, 1}, side)), show(false));
  s.images[0].name = "Panorama";
  Picture p = picture_of(s);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(p.value(Pass::kEmit, 16, 16, c), (std::array{1.0, 0.5, 3.0})[size_t(c)], 1e-6);
  ASSERT_EQ(p.stats.warnings.size(), 1u);
  EXPECT_NE(p.stats.warnings[0].find("'Panorama'"), std::string::npos) << p.stats.warnings[0];
  // Replaced by a smaller one, the warning goes with it.
  shared_engine().edit([&](scene::Scene& scene) {
    scene.set_image(1, floats(1, 1, {0.5f, 0.25f, 2, 1}));
  });
  p = render(request(kAbove, {Pass::kEmit}));
  EXPECT_EQ(p.rgb(Pass::kEmit, 16, 16), glm::dvec3(0.5, 0.25, 2));
  EXPECT_TRUE(p.stats.warnings.empty()) << p.stats.warnings[0];
}

// An image of one texel of any type, filled with the bits of `values`.
template <class T>
scene::Image texel(scene::PixelType type, const std::vector<T>& values, bool srgb = false) {
  scene::Image image = scene::new_image("image", 1, 1, type, int(values.size()), srgb);
  std::copy(values.begin(), values.end(), image.pixels<T>().begin());
  scene::finish_image(image, AlphaMode::kChannelPacked);
  return image;
}

TEST(Images, OfEveryTypeAndLayoutAreShown) {
  using scene::PixelType;
  const auto half = [](float v) { return glm::packHalf1x16(v); };
  struct Case {
    scene::Image image;
    glm::dvec3 color;
    double alpha;
    int64_t texel_bytes;
  };
  const Case cases[] = {
      {texel<uint8_t>(PixelType::kByte, {51}), glm::dvec3(0.2), 1, 1},
      {texel<uint8_t>(PixelType::kByte, {51, 102}), glm::dvec3(0.2), 0.4, 2},
      {texel<uint8_t>(PixelType::kByte, {51, 102, 153, 204}), {0.2, 0.4, 0.6}, 0.8, 4},
      {texel<uint8_t>(PixelType::kByte, {51}, true), glm::dvec3(linear(0.2)), 1, 1},
      {texel<uint16_t>(PixelType::kShort, {13107}), glm::dvec3(0.2), 1, 2},
      {texel<uint16_t>(PixelType::kShort, {13107, 26214}), glm::dvec3(0.2), 0.4, 4},
      {texel<uint16_t>(PixelType::kShort, {1, 26214, 65535, 65535}), {1 / 65535.0, 0.4, 1}, 1, 8},
      {texel<uint16_t>(PixelType::kHalf, {half(100)}), glm::dvec3(100), 1, 2},
      {texel<uint16_t>(PixelType::kHalf, {half(0.5), half(0.25)}), glm::dvec3(0.5), 0.25, 4},
      {texel<uint16_t>(PixelType::kHalf, {half(6e4f), half(-2), 0x7c00, half(1)}),
       {glm::unpackHalf1x16(half(6e4f)), -2, 0},
       1,
       8},  // infinite is nothing
      {texel<float>(PixelType::kFloat, {0.125f}), glm::dvec3(0.125), 1, 4},
      {texel<float>(PixelType::kFloat, {0.125f, 0.5f}), glm::dvec3(0.125), 0.5, 8},
      {texel<float>(PixelType::kFloat, {1e6f, NAN, -1, 1}), {1e6, 0, -1}, 1, 16},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(fmt::format("type {}, {} channels", int(c.image.type), c.image.channels));
    const Picture color = picture_of(shown(c.image, show(false)));
    EXPECT_LE(glm::length(color.rgb(Pass::kEmit, 16, 16) - c.color), 2e-6 * glm::length(c.color));
    EXPECT_NEAR(picture_of(shown(c.image, show(false, true))).value(Pass::kEmit, 16, 16), c.alpha,
                1e-6);
    EXPECT_EQ(int64_t(c.image.bytes()), c.texel_bytes);
  }
}

TEST(Images, OfGreyAreTransparentWhereTheyAreClipped) {
  const TestScene s = shown(texel<uint8_t>(scene::PixelType::kByte, {51}), show(false, true),
                            {.closest = true, .extension = Extension::kClip}, {3, 1}, {-1, 0});
  const Picture p = picture_of(s);
  EXPECT_EQ(p.value(Pass::kEmit, 2, 16), 0);
  EXPECT_EQ(p.value(Pass::kEmit, 30, 16), 0);
  EXPECT_EQ(p.value(Pass::kEmit, 16, 16), 1);
}

TEST(Images, ReleaseTheirPixelsWhenTheyCanBeMadeAgain) {
  int made = 0;
  const std::function<scene::Image()> make = [&] {
    ++made;
    return floats(1, 1, {0.5f, 0.25f, 2, 1});
  };
  scene::Image image = make();
  image.reload = make;
  const TestScene s = shown(image, show(false));
  EXPECT_EQ(picture_of(s).rgb(Pass::kEmit, 16, 16), glm::dvec3(0.5, 0.25, 2));
  shared_engine().edit(
      [](scene::Scene& scene) { EXPECT_TRUE(scene.images().at(1).levels.empty()); });
  EXPECT_EQ(made, 1) << "once for the test, and never for the frame";
  // Out of use it leaves the GPU; used again it is made again.
  const auto with_table = [&](std::vector<Id> table) {
    shared_engine().edit([&](scene::Scene& scene) { scene.set_instances(s.instances, table); });
    return render(request(kAbove, {Pass::kEmit})).rgb(Pass::kEmit, 16, 16);
  };
  EXPECT_EQ(with_table({}), glm::dvec3(0));
  EXPECT_EQ(with_table(s.table), glm::dvec3(0.5, 0.25, 2));
  EXPECT_EQ(made, 2);
}

TEST(Images, ThatCannotBeMadeAgainAreMagentaWithAWarning) {
  scene::Image image = floats(1, 1, {1, 1, 1, 1});
  image.levels.clear();
  image.reload = []() -> scene::Image { fail("image 'Lost' cannot be opened: find the file"); };
  const Picture p = picture_of(shown(image, show(false)));
  EXPECT_EQ(p.rgb(Pass::kEmit, 16, 16), glm::dvec3(1, 0, 1));
  ASSERT_EQ(p.stats.warnings.size(), 1u);
  EXPECT_NE(p.stats.warnings[0].find("'Lost'"), std::string::npos);
}

TEST(Images, AreUploadedAheadOfTheFrame) {
  const TestScene s = shown(floats(2, 2, uniform({0.5f, 0.25f, 2, 1}, 4)), show(false));
  render(TestScene{}, request(kAbove, {Pass::kEmit}));
  const int64_t before = gl::counters().uploaded_bytes, textures = gl::counters().textures;
  shared_engine().edit([&](scene::Scene& scene) { scene.set_image(1, s.images[0]); });
  shared_engine().upload_images();
  // The render thread takes its time; both levels are 5 texels of 16 bytes.
  const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (gl::counters().uploaded_bytes - before < 5 * 16 && std::chrono::steady_clock::now() < limit)
    std::this_thread::yield();
  EXPECT_GE(gl::counters().uploaded_bytes - before, 5 * 16);
  EXPECT_EQ(gl::counters().textures, textures + 1);
  EXPECT_EQ(picture_of(s).rgb(Pass::kEmit, 16, 16), glm::dvec3(0.5, 0.25, 2));
}

TEST(Images, TooManyInOneMaterialWarn) {
  const int limit = shared_engine().device().max_texture_units - gpu_scene::kImageUnit;
  for (int count : {limit, limit + 1, limit + 9}) {
    TestScene s;
    std::string code =
        "void evaluate_material(const Hit hit, inout Surface surface) {\n  vec3 sum = vec3(0.0);\n";
    scene::Material m;
    for (int i = 0; i < count; ++i) {
      m.textures.push_back({s.add_image(floats(1, 1, {1, 0.5f, 0.25f, 1}))});
      code += fmt::format("  sum += sample_image(hit, {}, vec2(0.5), false).rgb;\n", i);
    }
    m.name = "Patchwork";
    m.code = code + "  closure_emission(surface, vec3(1.0), sum);\n}\n";
    m.facts = {.emission = true, .glossy = false};
    s.add_object(floor_at(0, 1), {s.add_material(m)});
    const Picture p = picture_of(s);
    if (count <= limit) {
      EXPECT_NEAR(p.value(Pass::kEmit, 16, 16, 1), 0.5 * count, 1e-5);
      EXPECT_TRUE(p.stats.warnings.empty());
    } else {
      EXPECT_EQ(p.stats.warnings.size(), 1u)
          << fmt::format("{}", fmt::join(p.stats.warnings, "\n"));
      EXPECT_NE(p.stats.warnings[0].find("'Patchwork'"), std::string::npos);
      EXPECT_GT(p.value(Pass::kEmit, 16, 16, 1), 0.5 * (limit - 1) - 1e-3)
          << "the images within the limit are shown: " << p.stats.warnings[0];
    }
  }
}

TEST(Images, KeepTheirLightWhenTheyAreSmall) {
  // A checkerboard of black and white far away is half as bright as white, not code one half.
  std::vector<uint8_t> board;
  for (int i = 0; i < 64 * 64; ++i) {
    const uint8_t code = (i + i / 64) % 2 ? 255 : 0;
    board.insert(board.end(), {code, code, code, 255});
  }
  const TestScene s = shown(bytes(64, 64, board, true), show(false), {}, {8, 8});
  const Picture p = render(s, request(orthographic({0, 0, 2}, {0, 0, 0}, 1, 8, 8), {Pass::kEmit}));
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) EXPECT_NEAR(p.value(Pass::kEmit, x, y), 0.5, kLinear);
}

TEST(Images, FinerLevelsAreUsedWithMoreSamples) {
  // What many samples average is the unfiltered picture: a stripe two pixels wide keeps its edges.
  std::vector<float> stripes;
  for (int i = 0; i < 64; ++i)
    for (int c = 0; c < 4; ++c) stripes.push_back(c == 3 || i / 2 % 2 ? 1.0f : 0.0f);
  const TestScene s = shown(floats(64, 1, stripes), show(false), {}, {1, 1});
  engine::RenderRequest r =
      request(orthographic({0, 0, 2}, {0, 0, 0}, 1, 32, 32), {Pass::kEmit}, 64);
  r.filter_width = 0.5f;
  const Picture p = render(s, r);
  // Blackman-Harris of half width .5 lies within its pixel, which is one stripe, blurred by a
  // texel.
  for (int x = 4; x < 28; ++x) EXPECT_NEAR(p.value(Pass::kEmit, x, 16), x % 2 ? 1 : 0, 0.15) << x;
}

}  // namespace
}  // namespace panoptes::test
