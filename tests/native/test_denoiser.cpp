// The denoisers, on noise that is known.
#include "denoise/denoiser.h"
#include "denoise/oidn.h"
#include "gl/context.h"
#include "lit_room.h"

#include "base/error.h"

#include <cmath>
#include <random>

namespace panoptes::test {
namespace {

constexpr int kWidth = 96, kHeight = 64;
constexpr size_t kPixels = size_t(kWidth) * kHeight;

using Values = std::vector<float>;

// A wall seen from the front, lit evenly; what the light is times the albedo, without noise.
struct Truth {
  Values light = Values(3 * kPixels, 1.0f), albedo = Values(3 * kPixels, 0.5f);
  Values unscattered = Values(3 * kPixels), normals = Values(3 * kPixels), positions = Values(3 * kPixels);

  Truth() {
    each([&](int x, int y, size_t i) {
      normals[3 * i + 2] = 1;
      positions[3 * i] = 0.1f * float(x);
      positions[3 * i + 1] = 0.1f * float(y);
    });
  }
  template <class F>
  static void each(F f) {
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) f(x, y, size_t(y) * kWidth + size_t(x));
  }
  float value(size_t i, size_t c) const { return light[3 * i + c] * albedo[3 * i + c] + unscattered[3 * i + c]; }
};

// Pixels that are the mean of `samples` numbers as skewed as light is: one of `one_in` meets it, by so much more.
struct Noisy {
  Values pixels = Values(4 * kPixels, 1.0f), variance = Values(kPixels);

  Noisy(const Truth& truth, int samples, double one_in, unsigned seed = 1) {
    std::mt19937 random(seed);
    std::bernoulli_distribution meets(1 / one_in);
    for (size_t i = 0; i < kPixels; ++i) {
      int met = 0;
      for (int s = 0; s < samples; ++s) met += meets(random);
      const double factor = one_in * met / samples, share = double(met) / samples;
      double bright = 0;
      for (size_t c = 0; c < 3; ++c) {
        const double scattered = truth.light[3 * i + c] * truth.albedo[3 * i + c];
        pixels[4 * i + c] = float(scattered * factor + truth.unscattered[3 * i + c]);
        bright += (c == 0 ? 0.2126 : c == 1 ? 0.7152 : 0.0722) * scattered;
      }
      // As the film estimates it.
      variance[i] = float(bright * bright * one_in * one_in * share * (1 - share) / (samples - 1));
    }
  }
};

class EdgeAvoiding : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    context = std::make_unique<gl::Context>();
    programs = std::make_unique<gl::ProgramCache>();
    timer = std::make_unique<gl::PassTimer>(context->device());
  }
  static void TearDownTestSuite() {
    timer.reset();
    programs.reset();
    context.reset();
  }
  static denoise::Picture picture(const Truth& t, const Noisy& n, bool positions = true) {
    return {kWidth, kHeight, n.pixels, n.variance, t.unscattered, t.albedo, t.normals, positions ? t.positions : Values()};
  }
  static denoise::Filtered filtered(const Truth& t, const Noisy& n, bool positions = true) {
    denoise::EdgeAvoidingFilter filter;
    return filter.run(picture(t, n, positions), *programs, *timer, cancelled);
  }
  static double rmse(const Truth& t, const Values& pixels, int from = 0, int to = kWidth) {
    double sum = 0;
    Truth::each([&](int x, int, size_t i) {
      if (x >= from && x < to)
        for (size_t c = 0; c < 3; ++c) sum += std::pow(double(pixels[4 * i + c]) - t.value(i, c), 2);
    });
    return std::sqrt(sum / (3.0 * kHeight * (to - from)));
  }
  static inline std::unique_ptr<gl::Context> context;
  static inline std::unique_ptr<gl::ProgramCache> programs;
  static inline std::unique_ptr<gl::PassTimer> timer;
  static inline std::atomic<bool> cancelled{false};
};

TEST_F(EdgeAvoiding, TakesTheNoiseFromAnEvenWallAndTellsWhatIsLeft) {
  const Truth truth;
  for (int samples : {4, 16, 64}) {
    const Noisy n(truth, samples, 4);
    for (bool positions : {true, false}) {
      const denoise::Filtered f = filtered(truth, n, positions);
      const double left = rmse(truth, f.pixels);
      EXPECT_LT(left, 0.15 * rmse(truth, n.pixels)) << samples;
      double told = 0;
      for (float v : f.variance) told += v / double(kPixels);
      // Neighbours' noise is alike after the first level, which makes it look smaller than it is.
      EXPECT_GT(std::sqrt(told), 0.3 * left) << samples;
      EXPECT_LT(std::sqrt(told), 1.5 * left) << samples;
    }
  }
}

TEST_F(EdgeAvoiding, KeepsTheBrightness) {
  const Truth truth;
  // A few outliers hold most of the light.
  for (double one_in : {2.0, 20.0}) {
    double before = 0, after = 0;
    for (unsigned seed = 0; seed < 8; ++seed) {
      const Noisy n(truth, 8, one_in, seed);
      const denoise::Filtered f = filtered(truth, n);
      for (size_t i = 0; i < kPixels; ++i) before += n.pixels[4 * i], after += f.pixels[4 * i];
    }
    EXPECT_NEAR(after / before, 1, 0.01) << one_in;
  }
}

TEST_F(EdgeAvoiding, TexturesStaySharp) {
  Truth truth;
  Truth::each([&](int x, int y, size_t i) {
    for (size_t c = 0; c < 3; ++c) truth.albedo[3 * i + c] = (x / 4 + y / 4) % 2 ? 0.6f : 0.4f;
  });
  const Noisy n(truth, 16, 4);
  const denoise::Filtered f = filtered(truth, n);
  EXPECT_LT(rmse(truth, f.pixels), 0.15 * rmse(truth, n.pixels));
}

TEST_F(EdgeAvoiding, LightThatNoSurfaceScattersStays) {
  Truth truth;
  // Half the picture is the sky; a lamp glows in the other.
  Truth::each([&](int x, int y, size_t i) {
    const bool sky = x < kWidth / 2;
    for (size_t c = 0; c < 3; ++c) {
      truth.unscattered[3 * i + c] = sky ? 3.0f + 0.1f * float(y) : (x % 8 == 0 ? 50.0f : 0.0f);
      if (sky) truth.albedo[3 * i + c] = truth.light[3 * i + c] = truth.normals[3 * i + c] = 0;
    }
  });
  const Noisy n(truth, 16, 4);
  const denoise::Filtered f = filtered(truth, n);
  EXPECT_LT(rmse(truth, f.pixels, 0, kWidth / 2), 1e-6);
  EXPECT_LT(rmse(truth, f.pixels, kWidth / 2, kWidth), 0.15 * rmse(truth, n.pixels, kWidth / 2, kWidth));
}

TEST_F(EdgeAvoiding, WithoutNoiseNothingIsBlurred) {
  Truth truth;
  Truth::each([&](int x, int, size_t i) {
    for (size_t c = 0; c < 3; ++c) truth.light[3 * i + c] = 1 + std::sin(0.5f * float(x));
  });
  const denoise::Filtered f = filtered(truth, Noisy(truth, 2, 1));
  EXPECT_LT(rmse(truth, f.pixels), 1e-3);
}

TEST_F(EdgeAvoiding, LightDoesNotCrossCornersNorSteps) {
  for (bool step : {false, true}) {
    Truth truth;
    Truth::each([&](int x, int, size_t i) {
      if (x < kWidth / 2) return;
      for (size_t c = 0; c < 3; ++c) truth.light[3 * i + c] = 0.05f;
      if (step)
        truth.positions[3 * i + 2] = 20;
      else
        truth.normals[3 * i] = 1, truth.normals[3 * i + 2] = 0;
    });
    const Noisy n(truth, 16, 4);
    const denoise::Filtered f = filtered(truth, n);
    EXPECT_LT(rmse(truth, f.pixels, kWidth / 2, kWidth), 0.5 * rmse(truth, n.pixels, kWidth / 2, kWidth)) << step;
    EXPECT_LT(rmse(truth, f.pixels, 0, kWidth / 2), 0.2 * rmse(truth, n.pixels, 0, kWidth / 2)) << step;
  }
}

TEST_F(EdgeAvoiding, ShadowEdgesSurviveWhereTheNoiseAllows) {
  Truth truth;
  Truth::each([&](int x, int, size_t i) {
    if (x >= kWidth / 2)
      for (size_t c = 0; c < 3; ++c) truth.light[3 * i + c] = 0.02f;
  });
  const Noisy n(truth, 256, 2);
  const denoise::Filtered f = filtered(truth, n);
  const int at = kWidth / 2;
  EXPECT_LT(rmse(truth, f.pixels, at - 3, at + 3), 0.7 * rmse(truth, n.pixels, at - 3, at + 3));
}

TEST_F(EdgeAvoiding, ADenoisedPictureBecomesThatOfTheSamples) {
  // Light that no guide tells of, finer than the filter and without a period.
  Truth truth;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> light(0.6f, 1.4f);
  Values blocks(kPixels);
  for (float& b : blocks) b = light(random);
  Truth::each([&](int x, int y, size_t i) {
    for (size_t c = 0; c < 3; ++c) truth.light[3 * i + c] = blocks[size_t(y / 2 * kWidth + x / 2)];
  });
  denoise::Denoise denoiser;
  double before = 1e9;
  for (int samples : {4, 64, 1024, 16384}) {
    const Noisy n(truth, samples, 2);
    const film::Mixture m = denoiser.run({denoise::Denoiser::kEdgeAvoiding}, picture(truth, n), *programs, *timer, cancelled);
    const double off = rmse(truth, m.pixels), noise = rmse(truth, n.pixels);
    EXPECT_LT(off, 1.05 * noise) << samples;
    EXPECT_LT(off, before);
    // The filter adapts to the noise: its bias stays about as large, where it is hard to see.
    EXPECT_GT(m.error / (off / 0.5), 0.3) << samples;
    EXPECT_LT(m.error / (off / 0.5), 1.5) << samples;
    before = off;
  }
}

TEST_F(EdgeAvoiding, PicturesOfOnePixelAndOfOtherSizesFollowEachOther) {
  denoise::EdgeAvoidingFilter filter;
  const Truth truth;
  const Noisy n(truth, 4, 2);
  const Values first = filter.run(picture(truth, n), *programs, *timer, cancelled).pixels;
  const Values pixel{1, 2, 3, 0.5f}, variance{0.1f}, none(3), albedo(3, 0.5f), normal{0, 0, 1};
  const denoise::Filtered one = filter.run({1, 1, pixel, variance, none, albedo, normal, none}, *programs, *timer, cancelled);
  for (size_t c = 0; c < 4; ++c) EXPECT_NEAR(one.pixels[c], pixel[c], 1e-5);
  EXPECT_EQ(filter.run(picture(truth, n), *programs, *timer, cancelled).pixels, first);
}

// --- OpenImageDenoise: the stand-in of fake_oidn.cpp, which rendering_main.cpp names -------------------------------

struct Small {
  Values noisy{1, 2, 3, 0.25f, 4, 5, 6, 0.75f}, variance{1, 1};
  denoise::Picture picture() const {
    return {2, 1, noisy, variance, Values(6), {0.1f, 0.2f, 0.3f, 1.5f, -1, 0}, {0, 0, 1, 0, 1, 0}, {}};
  }
};

TEST(Oidn, GetsThePictureItsAlbedoAndNormals) {
  ASSERT_TRUE(denoise::has_oidn());
  const Small small;
  const Values expected{0.6f, 1.2f, 0.8f, 0.25f, 3, 1.5f, 3, 0.75f};
  const Values found = denoise::denoise_with_oidn(small.picture());
  for (size_t i = 0; i < 8; ++i) EXPECT_FLOAT_EQ(found[i], expected[i]) << i;
}

TEST(Oidn, SaysWhyItFailed) {
  Small small;
  small.noisy[0] = -1;
  expect_error([&] { denoise::denoise_with_oidn(small.picture()); }, "a negative colour");
}

// --- whole renders --------------------------------------------------------------------------------------------------

class DenoisedRender : public ::testing::Test {
 protected:
  DenoisedRender() {
    shared_engine().edit([](scene::Scene& scene) { lit_room().install(scene); });
  }
  static engine::RenderRequest paths(uint32_t first, uint32_t last, denoise::Denoiser denoiser) {
    engine::RenderRequest r = request(into_the_room(64, 48), {}, last);
    r.first_sample = first;
    r.method = engine::Method::kPrimitive;
    r.denoise.denoiser = denoiser;
    r.passes.set(size_t(film::Pass::kNoisyImage));
    return r;
  }
  static engine::EffectReport effect(const engine::Job& job) {
    for (const engine::EffectReport& e : job.stats().effects)
      if (e.name == "denoiser") return e;
    ADD_FAILURE() << "the denoiser is not in the plan";
    return {};
  }
};

using denoise::Denoiser;
using film::Pass;

TEST_F(DenoisedRender, IsNearerToTheTruthAndKeepsTheNoisyImage) {
  const Values right = finished(paths(5000, 5600, Denoiser::kOff))->read(Pass::kCombined);
  for (uint32_t samples : {2u, 8u, 32u}) {
    const auto job = finished(paths(0, samples, Denoiser::kEdgeAvoiding));
    const Values noisy = finished(paths(0, samples, Denoiser::kOff))->read(Pass::kCombined);
    EXPECT_EQ(job->read(Pass::kNoisyImage), noisy);
    EXPECT_LT(apart(job->read(Pass::kCombined), right), 0.6 * apart(noisy, right)) << samples;
    EXPECT_TRUE(effect(*job).runs);
    ASSERT_TRUE(job->stats().estimated_error.has_value());
  }
}

TEST_F(DenoisedRender, TellsWhyItDoesNotRun) {
  const auto one = finished(paths(0, 1, Denoiser::kEdgeAvoiding));
  EXPECT_EQ(effect(*one).reason, "one sample does not tell its noise");
  EXPECT_EQ(one->read(Pass::kCombined), one->read(Pass::kNoisyImage));
  engine::RenderRequest r = paths(0, 2, Denoiser::kEdgeAvoiding);
  r.method = engine::Method::kRealtime;
  EXPECT_EQ(effect(*finished(r)).reason, "Real-time's pictures have too little noise for it");
  EXPECT_EQ(effect(*finished(paths(0, 2, Denoiser::kOff))).reason, "switched off in the settings");
}

TEST_F(DenoisedRender, AutomaticTakesOidnAndAFailureLeavesTheOther) {
  // The stand-in's picture is far off: the samples show through.
  const auto job = finished(paths(0, 64, Denoiser::kAuto));
  const Values noisy = job->read(Pass::kNoisyImage), ours = finished(paths(0, 64, Denoiser::kEdgeAvoiding))->read(Pass::kCombined);
  EXPECT_NE(job->read(Pass::kCombined), ours);
  EXPECT_LT(apart(job->read(Pass::kCombined), noisy), 0.3 * apart(noisy, Values(noisy.size())));
  // The light is negative.
  engine::RenderRequest r = paths(0, 4, Denoiser::kOidn);
  r.exposure = -1;
  const auto failed = finished(r);
  ASSERT_EQ(failed->stats().warnings.size(), 1u);
  EXPECT_NE(failed->stats().warnings[0].find("OpenImageDenoise failed (a negative colour)"), std::string::npos);
}

TEST_F(DenoisedRender, OfWhatALensBlurs) {
  engine::RenderRequest r = paths(0, 8, Denoiser::kEdgeAvoiding);
  r.camera.lens.radius = 0.05;
  r.camera.lens.focus_distance = 2;
  const auto job = finished(r);
  EXPECT_TRUE(effect(*job).runs);
  EXPECT_NE(job->read(Pass::kCombined), job->read(Pass::kNoisyImage));
}

TEST_F(DenoisedRender, PartsOfPicturesAreRefused) {
  engine::RenderRequest r = paths(0, 4, Denoiser::kAuto);
  r.pieces = true;
  expect_error([&] { r.check(); }, "to be merged cannot be denoised");
  r.pieces = false;
  r.denoise.denoiser = Denoiser(9);
  expect_error([&] { r.check(); }, "no denoiser number 9");
}

}  // namespace
}  // namespace panoptes::test
