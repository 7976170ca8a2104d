// Paths of light over fragments, beside those over exact triangles: the light that pixels, a single view or a single
// layer lose, and geometry that moves.
#include "lit_room.h"

namespace panoptes::test {
namespace {

using fragment_tracer::Settings;
using fragment_tracer::Storage;
using fragment_tracer::Views;
using film::Pass;

// The room, with a box that nobody sees from behind, and light that comes from the side.
TestScene room_with_a_box() {
  TestScene scene = lit_room();
  const Id grey = scene.add_material(lambert(glm::vec3(0.6f)));
  scene.add_object(quad({-0.5f, 0.8f, 0.8f}, {0.6f, 0, 0}, {0, 0, 0.8f}), {grey});
  scene.add_object(quad({-0.5f, 1.4f, 0.8f}, {0.6f, 0, 0}, {0, 0, 0.8f}), {grey});
  return scene;
}

class FragmentPaths : public testing::Test {
 protected:
  void SetUp() override {
    shared_engine().edit([](scene::Scene& scene) { room_with_a_box().install(scene); });
  }
  static engine::RenderRequest request(engine::Method method) {
    engine::RenderRequest r;
    r.camera = into_the_room(64, 48);
    r.method = method;
    r.last_sample = 16;
    r.passes.set(size_t(Pass::kCombined)).set(size_t(Pass::kDiffInd)).set(size_t(Pass::kAo));
    r.paths.bounces.total = 4;
    return r;
  }
  static engine::RenderRequest fragments(const Settings& settings = {}) {
    engine::RenderRequest r = request(engine::Method::kFragment);
    r.structure.fragments = settings;
    return r;
  }
  // Of all channels but alpha.
  static double light(const engine::Job& job, Pass pass) {
    const std::vector<float> pixels = job.read(pass);
    const size_t channels = size_t(film::info(pass).channels);
    double sum = 0;
    for (size_t i = 0; i < pixels.size(); ++i) sum += channels == 4 && i % 4 == 3 ? 0 : pixels[i];
    return sum;
  }
};

TEST_F(FragmentPaths, GiveTheLightOfExactOnes) {
  const auto exact = finished(request(engine::Method::kPrimitive)), found = finished(fragments());
  for (Pass pass : {Pass::kCombined, Pass::kDiffInd})
    EXPECT_NEAR(light(*found, pass) / light(*exact, pass), 1, 0.02) << film::info(pass).name;
  constexpr double kValues = 3 * 64 * 48;
  // Most paths are the same, so that their noise is.
  EXPECT_LT(apart(found->read(Pass::kCombined), exact->read(Pass::kCombined)),
            0.1 * light(*exact, Pass::kCombined) / kValues);
}

TEST_F(FragmentPaths, LetOneRayOfAHundredThroughWhereWallsMeet) {
  // The AO pass is the share of rays that leave the room. Where walls meet within a pixel, it shows but one of them, and
  // rays slip through the other; how many depends on how the edges lie to the pixels, too.
  const double exact = light(*finished(request(engine::Method::kPrimitive)), Pass::kAo);
  for (int side : {128, 512}) {
    Settings settings;
    settings.side = side;
    const double lost = (light(*finished(fragments(settings)), Pass::kAo) - exact) / (3 * 64 * 48);
    EXPECT_GT(lost, 0);
    EXPECT_LT(lost, 0.01) << side;
  }
}

TEST_F(FragmentPaths, MoreViewsAndLayersLoseLess) {
  const double exact = light(*finished(request(engine::Method::kPrimitive)), Pass::kDiffInd);
  const auto share = [&](Views views, int layers) {
    Settings settings;
    settings.views = views;
    settings.layers = layers;
    settings.storage = Storage::kDoubleList;
    return light(*finished(fragments(settings)), Pass::kDiffInd) / exact;
  };
  const double least = share(Views::kCamera, 1), deep = share(Views::kCamera, 0);
  const double wide = share(Views::kCubeAndCamera, 1), all = share(Views::kCubeAndCamera, 0);
  fmt::print("bounced light: one view and layer {:.3f}, one view {:.3f}, one layer {:.3f}, all {:.3f}\n", least,
             deep, wide, all);
  EXPECT_NEAR(all, 1, 0.02);
  EXPECT_GT(std::abs(wide - 1), std::abs(all - 1));
  EXPECT_GT(std::abs(deep - 1), std::abs(all - 1));
  EXPECT_GT(std::abs(least - 1), 0.05);
}

TEST_F(FragmentPaths, ShowWhatHasMoved) {
  finished(fragments());
  shared_engine().edit([](scene::Scene& scene) {
    TestScene moved = room_with_a_box();
    moved.add_object(floor_at(1.0f, 0.5f), {moved.add_material(lambert({0.9f, 0.2f, 0.2f}))});
    moved.install(scene);
  });
  const auto found = finished(fragments()), exact = finished(request(engine::Method::kPrimitive));
  EXPECT_NEAR(light(*found, Pass::kCombined) / light(*exact, Pass::kCombined), 1, 0.02);
}

TEST_F(FragmentPaths, AnOrthographicCameraHasTheCubeAlone) {
  engine::RenderRequest r = fragments(), exact = request(engine::Method::kPrimitive);
  r.camera = exact.camera = orthographic({0, -4, 1.5}, {0, 0, 1.5}, 4, 64, 48);
  EXPECT_NEAR(light(*finished(r), Pass::kCombined) / light(*finished(exact), Pass::kCombined), 1, 0.03);
}

}  // namespace
}  // namespace panoptes::test
