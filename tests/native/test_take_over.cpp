// Paths that take over the picture that Real-time has made of a 3D View.
#include "lit_room.h"

#include "base/error.h"

namespace panoptes::test {
namespace {

using film::Pass;

constexpr int kWidth = 48, kHeight = 36;

class TakeOver : public ::testing::Test {
 protected:
  TakeOver() {
    shared_engine().edit([](scene::Scene& scene) { lit_room().install(scene); });
  }

  static engine::RenderRequest look(uint32_t first, uint32_t last) {
    engine::RenderRequest r = request(into_the_room(kWidth, kHeight), {}, last);
    r.first_sample = first;
    r.live = r.viewport = true;
    return r;
  }
  static engine::RenderRequest paths(uint32_t first, uint32_t last) {
    engine::RenderRequest r = look(first, last);
    r.method = engine::Method::kPrimitive;
    return r;
  }
  static std::vector<float> quick() {
    engine::RenderRequest r = look(0, 4);
    r.cache.enabled = true;
    return finished(r)->read(Pass::kCombined);
  }
};

TEST_F(TakeOver, ShowsWhatIsNearerToTheTruthThanEither) {
  const std::vector<float> smooth = quick(), right = finished(paths(1000, 1600))->read(Pass::kCombined);
  for (uint32_t samples : {2u, 8u, 64u}) {
    const auto job = finished(paths(0, samples), {.smooth = smooth});
    const std::vector<float> shown = job->read_shown(), noisy = job->read(Pass::kCombined);
    ASSERT_EQ(shown.size(), noisy.size());
    EXPECT_LT(apart(shown, right), 1.05 * std::min(apart(noisy, right), apart(smooth, right))) << samples;
    ASSERT_TRUE(job->stats().estimated_error.has_value());
  }
}

TEST_F(TakeOver, DenoisedPathsAreNearerStill) {
  const std::vector<float> smooth = quick(), right = finished(paths(1000, 1600))->read(Pass::kCombined);
  for (uint32_t samples : {2u, 8u, 32u}) {
    engine::RenderRequest r = paths(0, samples);
    const double noisy = apart(finished(r, {.smooth = smooth})->read_shown(), right);
    r.denoise.denoiser = denoise::Denoiser::kEdgeAvoiding;
    const auto job = finished(r, {.smooth = smooth});
    EXPECT_LT(apart(job->read_shown(), right), 0.95 * noisy) << samples;
    // What a later job goes on from has its noise.
    r.denoise.denoiser = denoise::Denoiser::kOff;
    EXPECT_EQ(job->read(Pass::kCombined), finished(r)->read(Pass::kCombined));
  }
}

TEST_F(TakeOver, APictureThatIsContinuedIsThatOfAllItsSamples) {
  const std::vector<float> smooth = quick();
  const std::vector<float> whole = finished(paths(0, 48), {.smooth = smooth})->read_shown();
  const std::vector<float> first = finished(paths(0, 16), {.smooth = smooth})->read(Pass::kCombined);
  const std::vector<float> continued = finished(paths(16, 48), {smooth, first, 16})->read_shown();
  // Only what the noise is taken for differs.
  EXPECT_LT(apart(continued, whole), 0.3 * apart(whole, smooth));
}

TEST_F(TakeOver, OneSampleDoesNotTellItsNoise) {
  EXPECT_TRUE(finished(paths(0, 1), {.smooth = quick()})->read_shown().empty());
  EXPECT_TRUE(finished(paths(0, 4))->read_shown().empty()) << "there is nothing to take over";
}

TEST_F(TakeOver, RefusesPicturesOfAnotherSize) {
  EXPECT_THROW(shared_engine().render(paths(0, 2), {.smooth = std::vector<float>(7)}), Error);
  EXPECT_THROW(shared_engine().render(paths(0, 2), {quick(), quick(), 0}), Error);
}

}  // namespace
}  // namespace panoptes::test
