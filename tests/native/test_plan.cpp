// The frame plan: which effects run for which facts, and that each says why.
#include "base/error.h"
#include "plan/plan.h"
#include "support.h"

#include <functional>
#include <set>

namespace panoptes::test {
namespace {

using plan::PlanSettings;

scene::Facts furnished() {
  scene::Facts f;
  f.triangles = 12;
  f.instances = 1;
  return f;
}

std::set<std::string> running(const plan::Effects& effects) {
  std::set<std::string> names;
  for (const plan::Effect& e : effects)
    if (e.runs) names.insert(e.name);
  return names;
}

TEST(FramePlan, RunsWhatTheSceneCallsForAndNothingElse) {
  struct Case {
    const char* label;
    std::function<void(scene::Facts&, PlanSettings&)> change;
    std::set<std::string> runs;  // besides "surfaces" and "pass_combined"
  };
  const Case cases[] = {
      {"bare geometry", [](auto&, auto&) {}, {}},
      {"alpha", [](auto& f, auto&) { f.alpha = true; }, {"alpha"}},
      {"normal map", [](auto& f, auto&) { f.normal_map = true; }, {"normal_maps"}},
      {"emission",
       [](auto& f, auto&) { f.emission = true; },
       {"emission", "emissive_light", "emissive_shadows", "filtered_penumbrae"}},
      {"glossy and rough", [](auto& f, auto&) { f.glossy = true; }, {"glossy"}},
      {"glossy and rough, with rays switched on",
       [](auto& f, auto& s) {
         f.glossy = true;
         s.specular_rays.mode = specular_rays::Mode::kOn;
       },
       {"glossy", "specular_rays"}},
      {"a mirror",
       [](auto& f, auto&) {
         f.glossy = true;
         f.least_roughness = 0.1f;
       },
       {"glossy", "specular_rays"}},
      {"glass", [](auto& f, auto&) { f.transmission = true; }, {"transmission", "specular_rays"}},
      {"glass without rays",
       [](auto& f, auto& s) {
         f.transmission = true;
         s.specular_rays.mode = specular_rays::Mode::kOff;
       },
       {"transmission"}},
      {"a coat or a sheen", [](auto& f, auto&) { f.layers = true; }, {"layers"}},
      {"a point lamp without shadow", [](auto& f, auto&) { f.lamps[0] = 1; }, {"direct_light"}},
      {"a point lamp",
       [](auto& f, auto&) { f.lamps[0] = f.shadow_lamps[0] = 1; },
       {"direct_light", "point_shadows"}},
      {"a sun",
       [](auto& f, auto&) { f.lamps[1] = f.shadow_lamps[1] = 1; },
       {"direct_light", "sun_shadows", "sun_cascades"}},
      {"spots",
       [](auto& f, auto&) { f.lamps[2] = f.shadow_lamps[2] = 5; },
       {"direct_light", "spot_shadows"}},
      {"areas, one with shadow",
       [](auto& f, auto&) {
         f.lamps[3] = 2;
         f.shadow_lamps[3] = 1;
       },
       {"direct_light", "area_shadows"}},
      {"a soft sun in one sample",
       [](auto& f, auto&) {
         f.lamps[1] = f.shadow_lamps[1] = 1;
         f.extended_lamps = true;
       },
       {"direct_light", "sun_shadows", "sun_cascades", "filtered_penumbrae"}},
      {"a soft sun whose penumbrae are filtered",
       [](auto& f, auto& s) {
         f.lamps[1] = f.shadow_lamps[1] = 1;
         f.extended_lamps = s.filter_penumbrae = true;
         s.samples = 16;
       },
       {"direct_light", "sun_shadows", "sun_cascades", "filtered_penumbrae"}},
      {"a soft sun in many samples",
       [](auto& f, auto& s) {
         f.lamps[1] = f.shadow_lamps[1] = 1;
         f.extended_lamps = true;
         s.samples = 16;
       },
       {"direct_light", "sun_shadows", "sun_cascades", "soft_shadows"}},
      {"softness switched off",
       [](auto& f, auto& s) {
         f.lamps[1] = f.shadow_lamps[1] = 1;
         f.extended_lamps = true;
         s.samples = 16;
         s.soft_shadows = false;
       },
       {"direct_light", "sun_shadows", "sun_cascades"}},
      {"a world",
       [](auto& f, auto&) { f.world = true; },
       {"world_light", "world_background", "ambient_occlusion", "occlusion_phantom_views",
        "bent_normals", "occlusion_filter"}},
      {"a world in a picture of many samples, with a lamp",
       [](auto& f, auto& s) {
         f.world = true;
         f.lamps[0] = f.shadow_lamps[0] = 1;
         s.samples = 16;
       },
       {"world_light", "world_background", "direct_light", "point_shadows", "ambient_occlusion",
        "occlusion_lamp_views", "occlusion_phantom_views", "bent_normals"}},
      {"occlusion without strength",
       [](auto& f, auto& s) {
         f.world = true;
         s.occlusion.strength = 0;
       },
       {"world_light", "world_background"}},
      {"the AO pass of a black world, by the camera alone",
       [](auto&, auto& s) {
         s.passes = pass_set({film::Pass::kAo});
         s.occlusion.phantoms = ambient_occlusion::Phantoms::kOff;
         s.occlusion.filter = ambient_occlusion::Filter::kOff;
       },
       {"pass_ao", "ambient_occlusion"}},
      {"deep shadows",
       [](auto& f, auto& s) {
         f.world = true;
         f.lamps[1] = f.shadow_lamps[1] = 1;
         s.occlusion.deep_shadows = 1;
         s.occlusion.phantoms = ambient_occlusion::Phantoms::kOff;
         s.occlusion.secondary_views = 0;
         s.samples = 16;
       },
       {"world_light", "world_background", "direct_light", "sun_shadows", "sun_cascades",
        "ambient_occlusion", "bent_normals", "deep_shadows"}},
      {"one bounce of a lamp's light",
       [](auto& f, auto& s) {
         f.lamps[0] = 1;
         s.cache.enabled = true;
         s.cache.bounces = 1;
         s.occlusion.strength = 0;
       },
       {"direct_light", "radiance_cache", "cache_first_bounce"}},
      {"one bounce by reflective shadow maps",
       [](auto& f, auto& s) {
         f.lamps[0] = 1;
         s.cache.enabled = true;
         s.cache.bounces = 1;
         s.cache.first_bounce = radiance_cache::FirstBounce::kRsm;
         s.occlusion.strength = 0;
       },
       {"direct_light", "radiance_cache", "cache_rsm"}},
      {"one bounce of the world's light",
       [](auto& f, auto& s) {
         f.world = true;
         s.cache.enabled = true;
         s.cache.bounces = 1;
         s.occlusion.strength = 0;
       },
       {"world_light", "world_background", "radiance_cache", "cache_world", "cache_bounces"}},
      {"contact of what the cache shines on, which the camera sees",
       [](auto& f, auto& s) {
         f.lamps[0] = f.shadow_lamps[0] = 1;
         s.cache.enabled = true;
         s.cache.bounces = 1;
         s.samples = 16;
       },
       {"direct_light", "point_shadows", "radiance_cache", "cache_first_bounce", "ambient_occlusion",
        "bent_normals"}},
      {"the AO pass beside it, for which all views are asked",
       [](auto& f, auto& s) {
         f.lamps[0] = f.shadow_lamps[0] = 1;
         s.cache.enabled = true;
         s.cache.bounces = 1;
         s.samples = 16;
         s.passes = pass_set({film::Pass::kAo});
       },
       {"direct_light", "point_shadows", "radiance_cache", "cache_first_bounce", "pass_ao",
        "ambient_occlusion", "occlusion_lamp_views", "occlusion_phantom_views", "bent_normals"}},
      {"a cache that nothing shines into", [](auto&, auto& s) { s.cache.enabled = true; }, {}},
      {"passes with a divisor",
       [](auto&, auto& s) {
         s.passes = pass_set({film::Pass::kDiffDir, film::Pass::kDepth});
       },
       {"pass_diffdir", "pass_diffcol", "pass_depth"}},
  };
  for (const Case& c : cases) {
    scene::Facts facts = furnished();
    PlanSettings settings;
    settings.cache.enabled = false;  // but in its own cases
    c.change(facts, settings);
    std::set<std::string> expected = c.runs;
    expected.insert({"surfaces", "pass_combined"});
    EXPECT_EQ(running(plan::make_plan(facts, settings)), expected) << c.label;
  }
}

TEST(FramePlan, RunsNoLightWithoutSurfaces) {
  scene::Facts facts;
  facts.lamps[1] = 1;
  facts.world = true;
  const std::set<std::string> names = running(plan::make_plan(facts, {}));
  EXPECT_FALSE(names.count("surfaces"));
  EXPECT_FALSE(names.count("direct_light"));
  EXPECT_FALSE(names.count("world_light"));
  EXPECT_TRUE(names.count("world_background"));
}

TEST(FramePlan, GivesAReasonForEverything) {
  for (int bits = 0; bits < 64; ++bits) {
    scene::Facts f;
    f.triangles = bits & 1 ? 5 : 0;
    f.instances = bits & 1;
    f.alpha = f.emission = f.normal_map = f.glossy = f.transmission = f.layers = bits & 2;
    for (int i = 0; i < 4; ++i) {
      f.lamps[i] = bits & 4 ? i + 1 : 0;
      f.shadow_lamps[i] = bits & 8 ? f.lamps[i] : 0;
    }
    f.extended_lamps = bits & 16;
    f.world = bits & 32;
    std::set<std::string> names;
    for (const plan::Effect& e : plan::make_plan(f, {.samples = 1 + (bits & 2), .passes = {}})) {
      EXPECT_FALSE(e.reason.empty()) << e.name;
      EXPECT_TRUE(names.insert(e.name).second) << e.name << " is there twice";
    }
    EXPECT_EQ(names.size(), 15u + 5u + 6u + 5u + 1u + size_t(film::kPassCount));
  }
}

TEST(FramePlan, ForcingRunsEverythingAndKeepsTheReason) {
  const plan::PlanSettings several{.samples = 4, .passes = {}};
  plan::PlanSettings force = several;
  force.force_all_effects = true;
  const plan::Effects plain = plan::make_plan(furnished(), several),
                      forced = plan::make_plan(furnished(), force);
  ASSERT_EQ(plain.size(), forced.size());
  for (size_t i = 0; i < plain.size(); ++i) {
    // Filtering is the other of two ways to penumbrae: forcing it would change the picture.
    EXPECT_EQ(forced[i].runs, !plain[i].by_choice || plain[i].runs) << forced[i].name;
    if (plain[i].runs || plain[i].by_choice) {
      EXPECT_EQ(forced[i].reason, plain[i].reason);
    } else {
      EXPECT_NE(forced[i].reason.find(plain[i].reason), std::string::npos) << forced[i].reason;
      EXPECT_NE(forced[i].reason.find("forced"), std::string::npos) << forced[i].reason;
    }
  }
}

TEST(FramePlan, ForcingLeavesTheArtistsChoicesAlone) {
  // One sample filters its penumbrae, and soft shadows can be switched off: both change the picture.
  for (const plan::PlanSettings& settings :
       {plan::PlanSettings{.samples = 1, .force_all_effects = true, .passes = {}},
        plan::PlanSettings{.samples = 4,
        .soft_shadows = false,
        .force_all_effects = true,
        .passes = {}}})
    EXPECT_FALSE(plan::runs(plan::make_plan(furnished(), settings), "soft_shadows"));
}

TEST(FramePlan, ADebugPictureRunsRaysInPlaceOfTheScene) {
  scene::Facts facts = furnished();
  facts.lamps[0] = facts.shadow_lamps[0] = 1;
  PlanSettings settings;
  settings.debug_picture = ray_picture::Kind::kSteps;
  settings.passes.set(size_t(film::Pass::kCombined));
  for (bool force : {false, true}) {
    settings.force_all_effects = force;
    std::set<std::string> names = running(plan::make_plan(facts, settings));
    EXPECT_EQ(names.count("pass_combined"), 1u);
    std::erase_if(names, [](const std::string& name) { return name.starts_with("pass_"); });
    EXPECT_EQ(names, (std::set<std::string>{"triangles", "structure", "rays"}));
  }
}

TEST(FramePlan, KnowsItsEffectsByName) {
  scene::Facts facts = furnished();
  facts.alpha = true;
  const plan::Effects effects = plan::make_plan(facts, {});
  EXPECT_TRUE(plan::runs(effects, "alpha"));
  EXPECT_FALSE(plan::runs(effects, "glossy"));
  expect_error([&] { plan::runs(effects, "alhpa"); }, "'alhpa'");
  expect_error([&] { plan::runs({}, "alpha"); }, "'alpha'");
}

TEST(FilmPasses, BringTheirDivisorsAndCombined) {
  using film::Pass;
  EXPECT_EQ(film::with_divisors({}), pass_set({Pass::kCombined}));
  EXPECT_EQ(film::with_divisors(pass_set({Pass::kGlossDir})),
            pass_set({Pass::kCombined, Pass::kGlossDir, Pass::kGlossCol}));
  EXPECT_EQ(film::with_divisors(pass_set({Pass::kNormal})),
            pass_set({Pass::kCombined, Pass::kNormal}));
}

TEST(FilmPasses, AreFoundByBlendersNames) {
  const std::pair<const char*, int> names[] = {{"Combined", 4}, {"Depth", 1},   {"Normal", 3},
                                               {"DiffCol", 3},  {"DiffDir", 3}, {"GlossCol", 3},
                                               {"GlossDir", 3}, {"Emit", 3},    {"Env", 3}};
  for (const auto& [name, channels] : names) {
    const film::Pass pass = film::find_pass(name);
    ASSERT_NE(pass, film::Pass::kCount) << name;
    EXPECT_EQ(film::info(pass).channels, channels);
  }
  EXPECT_EQ(film::find_pass("Diffuse"), film::Pass::kCount);
  EXPECT_EQ(film::find_pass(""), film::Pass::kCount);
}

}  // namespace
}  // namespace panoptes::test
