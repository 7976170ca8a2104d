// Jobs: queueing, cancelling, live pictures, budgets, the end of an engine.
#include "still_life.h"
#include "support.h"

#include <chrono>
#include <thread>

namespace panoptes::test {
namespace {

using film::Pass;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// A frame that would take minutes.
engine::RenderRequest endless() {
  engine::RenderRequest r = request(still_life(1, {0, 0, 0}, 128).camera, {}, 1000000);
  return r;
}

TestScene soft_scene() {
  TestScene s = still_life().scene;
  s.lights = {area({0, -1, 4}, {0, 0.1f, -1}, 400, scene::AreaShape::kSquare, 2, 2)};
  return s;
}

void set_scene(engine::Engine& engine) {
  engine.edit([](scene::Scene& scene) { soft_scene().install(scene); });
}

TEST(EngineJobs, CancelReturnsSoonAndLeavesTheEngineUsable) {
  engine::Engine& engine = shared_engine();
  set_scene(engine);
  const engine::RenderRequest small = request(still_life().camera, {}, 2);
  const Picture before = render(small);
  const auto job = engine.render(endless());
  EXPECT_FALSE(job->wait(0.3));
  EXPECT_GT(job->progress(), 0);
  EXPECT_LT(job->progress(), 1);
  EXPECT_EQ(job->status().find("sample "), 0u) << job->status();
  const Clock::time_point start = Clock::now();
  job->cancel();
  EXPECT_TRUE(job->wait(10));
  EXPECT_LT(seconds_since(start), 0.5);
  EXPECT_NO_THROW(job->check());  // to be cancelled is no failure
  EXPECT_EQ(render(small)[Pass::kCombined], before[Pass::kCombined]);
}

TEST(EngineJobs, ACancelledJobInTheQueueNeverStarts) {
  engine::Engine& engine = shared_engine();
  set_scene(engine);
  const auto first = engine.render(endless()), second = engine.render(endless());
  second->cancel();
  first->cancel();
  EXPECT_TRUE(first->wait(10));
  EXPECT_TRUE(second->wait(10));
  EXPECT_EQ(second->samples_ready(), 0u);
}

TEST(EngineJobs, AllInAQueueEnd) {
  engine::Engine& engine = shared_engine();
  set_scene(engine);
  const engine::RenderRequest r = request(still_life().camera, {}, 2);
  const Picture due = render(r);
  std::vector<std::shared_ptr<engine::Job>> jobs;
  for (int i = 0; i < 20; ++i) jobs.push_back(engine.render(r));
  EXPECT_TRUE(jobs.back()->wait(60));
  for (const auto& job : jobs) {
    EXPECT_TRUE(job->wait(0)) << "the last one ended before this one";
    job->check();
    EXPECT_EQ(job->read(Pass::kCombined), due[Pass::kCombined]);
    EXPECT_EQ(job->progress(), 1);
    EXPECT_EQ(job->status(), "done");
  }
}

TEST(EngineJobs, EditsFromOtherThreadsAreSafe) {
  engine::Engine& engine = shared_engine();
  set_scene(engine);
  std::vector<std::thread> threads;
  std::atomic<int> failures{0};
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 10; ++i) {
        engine.edit([&](scene::Scene& scene) {
          scene.set_material_params(1, {glm::vec4(0.1f * float(i + 1), 0.5f, 0.5f, 1)});
          scene.set_lights({sun({0, 0.1f * float(t), -1}, 1)});
        });
        const auto job = engine.render(request(still_life().camera, {}));
        if (t == 0 && i % 3 == 0) job->cancel();
        if (!job->wait(60)) ++failures;
        try {
          job->check();
        } catch (const Error&) {
          ++failures;
        }
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(failures, 0);
}

TEST(EngineEdits, AreHandedOverWithoutWaitingForWhoHoldsTheScene) {
  engine::Engine& engine = shared_engine();
  set_scene(engine);
  std::atomic<bool> held{false}, release{false};
  std::thread holder([&] {
    engine.edit([&](scene::Scene&) {
      held = true;
      while (!release) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    });
  });
  while (!held) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  // Were they to wait, nobody would ever let go.
  engine.post([](scene::Scene& scene) { scene.set_lights({sun({0, 0, -1}, 1)}); });
  engine.post([](scene::Scene& scene) { scene.set_lights({sun({0, 0, -1}, 2), sun({0, 0, -1}, 3)}); });
  release = true;
  holder.join();
  // In their order, and before anybody sees the scene again.
  EXPECT_EQ(engine.edit([](scene::Scene& scene) { return scene.lights().size(); }), 2u);
}

TEST(EngineEdits, ThatMakeNoSenseFailWhoComesNextOnce) {
  engine::Engine& engine = shared_engine();
  set_scene(engine);
  const auto nonsense = [](scene::Scene& scene) {
    scene.set_instance_matrices(std::vector<int>{1000000}, std::vector<glm::mat4>{glm::mat4(1)});
  };
  EXPECT_THROW(engine.post(nonsense), Error);
  std::atomic<bool> held{false}, release{false};
  std::thread holder([&] {
    engine.edit([&](scene::Scene&) {
      held = true;
      while (!release) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    });
  });
  while (!held) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  engine.post(nonsense);
  engine.post([](scene::Scene& scene) { scene.set_lights({}); });
  release = true;
  holder.join();
  const engine::RenderRequest r = request(still_life().camera, {});
  const auto job = engine.render(r);
  EXPECT_TRUE(job->wait(60));
  EXPECT_THROW(job->check(), Error);
  EXPECT_NO_THROW(render(r));
  EXPECT_TRUE(engine.edit([](scene::Scene& scene) { return scene.lights().empty(); }));
}

TEST(EngineJobs, LiveOnesPublishAGrowingPicture) {
  engine::Engine& engine = shared_engine();
  set_scene(engine);
  engine::RenderRequest r = endless();
  r.live = true;
  const auto job = engine.render(r);
  uint32_t seen = 0;
  int grown = 0;
  const Clock::time_point start = Clock::now();
  while (grown < 3 && seconds_since(start) < 20) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const uint32_t ready = job->samples_ready();
    EXPECT_GE(ready, seen);
    if (ready == seen) continue;
    seen = ready;
    ++grown;
    const std::vector<float> pixels = job->read(Pass::kCombined);
    EXPECT_EQ(pixels.size(), 128u * 128 * 4);
    EXPECT_NEAR(pixels[3], 1, 1e-6);  // alpha: already divided by the samples
    EXPECT_GT(mean(pixels), 0.2);
  }
  EXPECT_EQ(grown, 3);
  job->cancel();
  EXPECT_TRUE(job->wait(10));
  // What was published stays readable.
  EXPECT_EQ(job->read(Pass::kCombined).size(), 128u * 128 * 4);
}

TEST(EngineJobs, LiveOnesTellOfThePictureThatIsThere) {
  engine::Engine& engine = shared_engine();
  set_scene(engine);
  engine::RenderRequest r = endless();
  r.live = true;
  const auto job = engine.render(r);
  const Clock::time_point start = Clock::now();
  while (job->samples_ready() == 0 && seconds_since(start) < 20)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const engine::RenderStats first = job->stats();
  EXPECT_GE(first.samples, 1u);
  EXPECT_EQ(first.width, 128);
  EXPECT_FALSE(first.effects.empty());
  EXPECT_FALSE(first.device.empty());
  const auto time = [](const engine::RenderStats& stats) {
    double ms = 0;
    for (const engine::EffectReport& effect : stats.effects) ms += effect.ms;
    return ms;
  };
  EXPECT_GT(time(first), 0);
  engine::RenderStats later = first;
  while (!later.estimated_error && seconds_since(start) < 20) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const uint32_t ready = job->samples_ready();
    later = job->stats();
    EXPECT_GE(later.samples, ready);
  }
  EXPECT_TRUE(later.estimated_error);
  EXPECT_GT(later.samples, first.samples);
  EXPECT_GT(time(later), time(first));
  job->cancel();
  EXPECT_TRUE(job->wait(10));
}

TEST(EngineJobs, OthersTellNothingBeforeTheirEnd) {
  engine::Engine& engine = shared_engine();
  set_scene(engine);
  const auto job = engine.render(endless());
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_EQ(job->stats().samples, 0u);
  job->cancel();
  EXPECT_TRUE(job->wait(10));
}

TEST(EngineJobs, NothingIsReadBeforeItIsThere) {
  engine::Engine& engine = shared_engine();
  set_scene(engine);
  const auto job = engine.render(endless());
  expect_error([&] { job->read(Pass::kCombined); }, "not there yet");
  job->cancel();
  EXPECT_TRUE(job->wait(10));
}

TEST(EngineJobs, ATimeBudgetEndsTheFrame) {
  set_scene(shared_engine());
  engine::RenderRequest r = endless();
  r.time_budget = 0.3;
  const Picture p = render(r);
  EXPECT_GT(p.stats.samples, 1u);
  EXPECT_LT(p.stats.samples, 1000000u);
  EXPECT_LT(p.stats.total_ms, 600);
  EXPECT_NEAR(p.value(Pass::kCombined, 0, 0, 3), 1, 1e-5);
  // At least one sample, however short the budget.
  r.time_budget = 1e-9;
  EXPECT_EQ(render(r).stats.samples, 1u);
}

TEST(EngineJobs, ANoiseThresholdEndsTheFrame) {
  set_scene(shared_engine());
  engine::RenderRequest r = request(still_life().camera, {}, 1000);
  r.shadow_resolution = 64;
  r.noise_threshold = 0.08;
  const Picture coarse = render(r);
  EXPECT_LT(coarse.stats.samples, 1000u);
  ASSERT_TRUE(coarse.stats.estimated_error);
  EXPECT_LT(*coarse.stats.estimated_error, 0.08);
  r.noise_threshold = 0.04;  // half the error takes four times the samples
  const Picture fine = render(r);
  EXPECT_GT(fine.stats.samples, 2 * coarse.stats.samples);
  EXPECT_LT(fine.stats.samples, 8 * coarse.stats.samples) << coarse.stats.samples;
  EXPECT_LT(*fine.stats.estimated_error, 0.04);
}

TEST(EngineJobs, ANoiseThresholdInASceneWithoutNoiseDoesNotEndItEarly) {
  // Light everywhere in shadow: the picture is black so far, and black is not "without noise" when
  // there is light to come; but nothing must hang or divide by zero.
  TestScene s;
  s.add_object(floor_at(0, 4), {s.add_material(lambert())});
  shared_engine().edit([&](scene::Scene& scene) { s.install(scene); });
  engine::RenderRequest r = request(still_life().camera, {}, 16);
  r.noise_threshold = 0.01;
  const Picture p = render(r);
  ASSERT_TRUE(p.stats.estimated_error);
  EXPECT_EQ(*p.stats.estimated_error, 0);
}

TEST(EngineJobs, StatisticsAddUp) {
  set_scene(shared_engine());
  const Picture p = render(request(still_life().camera, {Pass::kDepth}, 3));
  EXPECT_EQ(p.stats.device, shared_engine().device().renderer);
  EXPECT_EQ(p.stats.samples, 3u);
  EXPECT_EQ(p.stats.width, 48);
  EXPECT_GT(p.stats.trace_ms, 0);
  EXPECT_GE(p.stats.total_ms, p.stats.build_ms + p.stats.trace_ms - 1e-3);
  EXPECT_GT(p.stats.memory_bytes, 48 * 48 * 16);
  EXPECT_TRUE(p.stats.estimated_error);
  EXPECT_TRUE(p.stats.warnings.empty());
  const Picture one = render(request(still_life().camera, {}));
  EXPECT_FALSE(one.stats.estimated_error);
}

TEST(EngineJobs, ClosingDuringARenderEndsItSoon) {
  engine::Engine engine;
  set_scene(engine);
  const auto running = engine.render(endless()), queued = engine.render(endless());
  EXPECT_FALSE(running->wait(0.3));
  const Clock::time_point start = Clock::now();
  engine.close();
  EXPECT_LT(seconds_since(start), 1.0);
  EXPECT_TRUE(running->wait(0));
  EXPECT_TRUE(queued->wait(0));
  EXPECT_NO_THROW(running->check());
  engine.close();  // idempotent
}

TEST(EngineJobs, ADriverWithoutMemorySpoilsTheEngineAlone) {
  engine::Engine engine;
  set_scene(engine);
  engine::RenderRequest huge = request(still_life().camera, {});
  const auto before = engine.render(huge);
  EXPECT_TRUE(before->wait(60));
  EXPECT_FALSE(engine.spoiled());
  huge.camera.width = huge.camera.height = engine.device().max_texture_size;
  huge.passes.set();
  const auto job = engine.render(huge);
  ASSERT_TRUE(job->wait(60));
  EXPECT_THROW(job->check(), Error);
  EXPECT_TRUE(engine.spoiled());
  engine.close();
  engine::Engine another;
  set_scene(another);
  const auto after = another.render(request(still_life().camera, {}));
  EXPECT_TRUE(after->wait(60));
  EXPECT_EQ(after->read(Pass::kCombined), before->read(Pass::kCombined));
}

TEST(EngineJobs, CallsAfterCloseThrow) {
  engine::Engine engine;
  engine.close();
  expect_error([&] { engine.render(request(still_life().camera, {})); }, "closed");
  expect_error([&] { engine.edit([](scene::Scene&) {}); }, "closed");
  EXPECT_FALSE(engine.device().renderer.empty());
}

TEST(EngineJobs, EnginesComeAndGo) {
  for (int i = 0; i < 5; ++i) {
    engine::Engine engine;
    set_scene(engine);
    const auto job = engine.render(request(still_life().camera, {}));
    if (i % 2) {
      ASSERT_TRUE(job->wait(60));
      job->check();
    }
  }
}

}  // namespace
}  // namespace panoptes::test
