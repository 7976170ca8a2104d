// One pass in place of Combined, as 3D Views show it: the same as that of a whole render, by less work.
#include "film/display.h"
#include "still_life.h"
#include "support.h"

#include <chrono>
#include <set>
#include <thread>

namespace panoptes::test {
namespace {

using film::Pass;

const Pass kShown[] = {Pass::kNormal, Pass::kDiffCol, Pass::kDiffDir, Pass::kDiffInd,
                       Pass::kEmit,   Pass::kEnv,     Pass::kAo};

TestScene lamps_and_sky() {
  TestScene s = still_life().scene;
  s.world = world("vec3 evaluate_world(vec3 d) { return d * 0.5 + 0.5; }\n");
  s.add_object(box({-1, -1, 0.25f}, glm::vec3(0.25f)), {s.add_material(emitter(glm::vec3(2, 1, 0.5f)))});
  s.add_object(floor_at(1.5f, 1), {s.add_material(alpha_card({1, 1, 1, 0.5f}))});
  return s;
}

engine::RenderRequest showing(const engine::RenderRequest& whole, Pass pass) {
  engine::RenderRequest r = whole;
  r.passes.set(size_t(pass));
  r.shown_pass = pass;
  return r;
}

std::set<std::string> running(const engine::RenderStats& stats) {
  std::set<std::string> names;
  for (const engine::EffectReport& effect : stats.effects)
    if (effect.runs) names.insert(effect.name);
  return names;
}

void expect_same(const TestScene& scene, engine::RenderRequest r, const std::string& label, double bound) {
  for (Pass pass : kShown) {
    r.passes = pass_set({Pass::kCombined, pass});
    const Picture whole = render(scene, r);
    const Picture shown = render(scene, showing(r, pass));
    const std::vector<float> expected = film::display(pass, whole[pass]);
    EXPECT_GT(mean(expected), 0.01) << label << ", " << film::info(pass).name;
    EXPECT_LE(relative_rmse(shown[Pass::kCombined], expected), bound) << label << ", " << film::info(pass).name;
    // The pass itself stays what it is.
    EXPECT_LE(relative_rmse(shown[pass], whole[pass]), bound) << label << ", " << film::info(pass).name;
  }
}

TEST(ShownPass, OfRealtimeIsThatOfAWholePicture) {
  const gpu_scene::Camera camera = still_life().camera;
  for (uint32_t samples : {1u, 4u}) {
    engine::RenderRequest r = request(camera, {}, samples);
    r.cache.enabled = true;
    expect_same(lamps_and_sky(), r, fmt::format("with the cache, {} samples", samples), 1e-4);
    // Without a world direct light needs neither the cache nor occlusion.
    TestScene night = lamps_and_sky();
    night.world = constant_world(glm::vec3(0));
    for (const TestScene& scene : {lamps_and_sky(), night})
      for (Pass pass : {Pass::kDiffDir, Pass::kAo}) {
        r.cache.enabled = scene.world.code == night.world.code;
        r.passes = pass_set({Pass::kCombined, pass});
        const Picture whole = render(scene, r), shown = render(scene, showing(r, pass));
        EXPECT_LE(relative_rmse(shown[Pass::kCombined], film::display(pass, whole[pass])), 1e-4)
            << film::info(pass).name << (r.cache.enabled ? " at night" : " without the cache");
      }
  }
}

TEST(ShownPass, OfPathsIsThatOfAWholePicture) {
  engine::RenderRequest r = request(still_life().camera, {}, 4);
  r.method = engine::Method::kPrimitive;
  expect_same(lamps_and_sky(), r, "paths", 1e-4);
}

TEST(ShownPass, OfALiveJobIsThereBeforeItsEnd) {
  engine::Engine& engine = shared_engine();
  engine.edit([](scene::Scene& scene) { lamps_and_sky().install(scene); });
  engine::RenderRequest r = showing(request(still_life().camera, {}, 1000000), Pass::kDiffCol);
  r.live = r.viewport = true;
  const auto job = engine.render(r);
  for (int i = 0; i < 2000 && job->samples_ready() == 0; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_FALSE(job->wait(0));
  const std::vector<float> pixels = job->read(Pass::kCombined);
  job->cancel();
  EXPECT_TRUE(job->wait(10));
  ASSERT_EQ(pixels.size(), 48u * 48 * 4);
  // The floor in the lower corner, in its flat colour.
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(pixels[size_t(c)], 0.75f, 1e-5);
  EXPECT_EQ(pixels[3], 1);
}

TEST(ShownPass, LeavesOutWhatItDoesNotNeed) {
  engine::RenderRequest r = request(still_life().camera, {}, 2);
  r.cache.enabled = true;
  const auto effects_of = [&](Pass pass) {
    const Picture p = render(lamps_and_sky(), showing(r, pass));
    for (const engine::EffectReport& e : p.stats.effects)
      if (!e.runs) {
        EXPECT_EQ(e.ms, 0) << e.name << " was left out and took time";
      }
    return running(p.stats);
  };
  for (Pass pass : {Pass::kNormal, Pass::kDiffCol, Pass::kEmit})
    for (const std::string& name : effects_of(pass))
      EXPECT_TRUE(name == "surfaces" || name == "alpha" || name == "emission" || name == "glossy" ||
                  name.starts_with("pass_"))
          << film::info(pass).name << " runs " << name;
  const std::set<std::string> direct = effects_of(Pass::kDiffDir), indirect = effects_of(Pass::kDiffInd),
                              occlusion = effects_of(Pass::kAo), sky = effects_of(Pass::kEnv);
  EXPECT_TRUE(direct.count("direct_light") && direct.count("sun_shadows") && !direct.count("world_background"));
  EXPECT_TRUE(indirect.count("radiance_cache") && indirect.count("direct_light") &&
              !indirect.count("world_background"));
  EXPECT_TRUE(occlusion.count("ambient_occlusion") && !occlusion.count("radiance_cache") &&
              !occlusion.count("world_light"));
  EXPECT_TRUE(sky.count("world_background") && !sky.count("direct_light") && !sky.count("ambient_occlusion"));
}

TEST(ShownPass, HasNoEstimateOfItsError) {
  const engine::RenderRequest r = request(still_life().camera, {}, 4);
  EXPECT_TRUE(render(lamps_and_sky(), r).stats.estimated_error);
  EXPECT_FALSE(render(lamps_and_sky(), showing(r, Pass::kDiffCol)).stats.estimated_error);
}

}  // namespace
}  // namespace panoptes::test
