// Only what a scene calls for: leaving an effect out must not change the picture, and must save its
// programs, textures and memory.
#include "gl/counters.h"
#include "still_life.h"
#include "support.h"

#include <set>

namespace panoptes::test {
namespace {

using film::Pass;

struct Case {
  std::string name;
  TestScene scene;
  gpu_scene::Camera camera;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  const StillLife life = still_life();
  all.push_back({"lamps", life.scene, life.camera});
  all.push_back({"empty", TestScene(), life.camera});
  TestScene dark = life.scene;
  dark.lights.clear();
  all.push_back({"no lamps", dark, life.camera});
  TestScene sky = dark;
  sky.world = constant_world(glm::vec3(0.5f, 0.75f, 1));
  all.push_back({"sky alone", sky, life.camera});
  TestScene silent = life.scene;
  for (scene::Light& lamp : silent.lights) lamp.cast_shadow = false;
  all.push_back({"lamps without shadows", silent, life.camera});
  TestScene soft = life.scene;
  soft.lights.push_back(area({0, -1, 4}, {0, 0, -1}, 200, scene::AreaShape::kSquare, 1, 1));
  soft.lights[0].angle = 0.1f;
  all.push_back({"soft lamps", soft, life.camera});
  TestScene rich = life.scene;
  rich.world = world("vec3 evaluate_world(vec3 d) { return d * 0.5 + 0.5; }\n");
  rich.materials[1] = emitter(glm::vec3(2));
  rich.materials.push_back(alpha_card({1, 1, 1, 0.5f}));
  rich.add_object(floor_at(1.5f, 1), {3});
  all.push_back({"sky, alpha and emission", rich, life.camera});
  TestScene grey = life.scene;
  for (Id& id : grey.table) id = 0;  // the default material, which reflects
  all.push_back({"reflecting", grey, life.camera});
  return all;
}

TEST(SkippedEffects, DoNotChangeThePicture) {
  for (uint32_t samples : {1u, 4u})
    for (const Case& c : cases()) {
      engine::RenderRequest r =
          request(c.camera,
                  {Pass::kDiffDir, Pass::kDiffCol, Pass::kNormal, Pass::kDepth, Pass::kEnv},
                  samples);
      const Picture planned = render(c.scene, r);
      r.force_all_effects = true;
      const Picture forced = render(c.scene, r);
      for (const auto& [pass, pixels] : planned.passes)
        EXPECT_TRUE(pixels == forced[pass])
            << c.name << ", " << samples << " samples, pass " << film::info(pass).name
            << ": relative RMSE " << relative_rmse(forced[pass], pixels);
    }
}

TEST(SkippedEffects, AreNamedWithTheirReason) {
  const StillLife life = still_life();
  const Picture p = render(life.scene, request(life.camera, {}));
  std::set<std::string> skipped;
  for (const engine::EffectReport& e : p.stats.effects) {
    EXPECT_FALSE(e.reason.empty());
    if (e.runs) continue;
    skipped.insert(e.name);
    EXPECT_EQ(e.ms, 0) << e.name << " was skipped and took time";
  }
  for (const char* name : {"alpha", "normal_maps", "emission", "glossy", "area_shadows",
                           "soft_shadows", "world_light", "world_background", "pass_depth"})
    EXPECT_TRUE(skipped.count(name)) << name;
}

TEST(SkippedEffects, RunningEffectsTakeTime) {
  const StillLife life = still_life();
  const Picture p = render(life.scene, request(life.camera, {}));
  for (const engine::EffectReport& e : p.stats.effects)
    for (const char* name : {"surfaces", "sun_shadows", "point_shadows", "direct_light"})
      if (e.name == name) {
        EXPECT_GT(e.ms, 0) << name;
      }
  double sum = 0;
  for (const auto& [name, ms] : p.stats.passes) sum += ms;
  EXPECT_LE(sum, p.stats.total_ms * 1.01);
  EXPECT_GT(sum, 0.5 * p.stats.trace_ms) << "most of the time must be accounted for";
}

// Resources of a new engine after one frame.
struct Cost {
  int64_t programs, textures, memory;
};

Cost cost_of(const TestScene& s, engine::RenderRequest r) {
  const gl::Counters& c = gl::counters();
  const Cost before{c.programs, c.textures, c.memory_bytes};
  engine::Engine engine;
  engine.edit([&](scene::Scene& scene) { s.install(scene); });
  const auto job = engine.render(r);
  while (!job->wait(60)) throw Error("the render did not end");
  job->check();
  return {c.programs - before.programs, c.textures - before.textures,
          c.memory_bytes - before.memory};
}

TEST(SkippedEffects, CostNeitherProgramsNorMemory) {
  const StillLife life = still_life();
  engine::RenderRequest r = request(life.camera, {});
  r.shadow_resolution = 512;
  TestScene plain = life.scene;
  plain.lights.clear();
  const Cost bare = cost_of(plain, r);

  // Each effect alone adds what it needs.
  TestScene silent = life.scene;
  for (scene::Light& lamp : silent.lights) lamp.cast_shadow = false;
  const Cost lamps = cost_of(silent, r), shadows = cost_of(life.scene, r);
  EXPECT_GT(lamps.programs, bare.programs);
  EXPECT_GT(lamps.textures, bare.textures);
  EXPECT_GT(shadows.programs, lamps.programs);
  EXPECT_EQ(shadows.textures, lamps.textures + 1);
  // A sun, a narrow spot, and a cube without the face that looks up over everything: seven maps of
  // 512 x 512 floats.
  EXPECT_GE(shadows.memory - lamps.memory, 7 * 512 * 512 * 4);
  EXPECT_LT(shadows.memory - lamps.memory, 8 * 512 * 512 * 4);

  TestScene glowing = plain;
  glowing.materials[1] = emitter(glm::vec3(1));
  const Cost emission = cost_of(glowing, r);
  EXPECT_EQ(emission.textures, bare.textures + 3);  // radiance seen, light on others, shadow maps

  TestScene sky = plain;
  sky.world = constant_world(glm::vec3(1));
  EXPECT_GT(cost_of(sky, r).programs, bare.programs);

  r.force_all_effects = true;
  const Cost forced = cost_of(plain, r);
  EXPECT_GT(forced.textures, bare.textures);
  EXPECT_GT(forced.memory, bare.memory);
}

TEST(SkippedEffects, GiveTheirMemoryBack) {
  const StillLife life = still_life();
  TestScene plain = life.scene;
  plain.lights.clear();
  const gl::Counters& c = gl::counters();
  engine::RenderRequest r = request(life.camera, {});
  render(plain, r);
  const Cost before{0, c.textures, c.memory_bytes};
  render(life.scene, r);
  EXPECT_GT(c.textures, before.textures);
  render(plain, r);
  EXPECT_EQ(c.textures, before.textures);
  // Buffers for lists of lamps may stay; the pictures and maps must not.
  EXPECT_LT(c.memory_bytes - before.memory, 16 << 10);
}

TEST(SkippedEffects, AnEngineLeavesNothingBehind) {
  const gl::Counters& c = gl::counters();
  const int64_t buffers = c.buffers, textures = c.textures, memory = c.memory_bytes;
  const StillLife life = still_life();
  cost_of(life.scene, request(life.camera, {Pass::kDepth}, 2));
  EXPECT_EQ(c.buffers, buffers);
  EXPECT_EQ(c.textures, textures);
  EXPECT_EQ(c.memory_bytes, memory);
}

}  // namespace
}  // namespace panoptes::test
