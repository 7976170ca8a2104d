// Light followed path by path: analytic answers, and what must not change the picture.
#include "support.h"

#include <cmath>

namespace panoptes::test {
namespace {

using film::Pass;

constexpr scene::MaterialFacts kGlowing{.emission = true, .emission_varies = false, .glossy = false};
constexpr scene::MaterialFacts kGlassy{.glossy = true, .transmission = true};

engine::RenderRequest paths(const gpu_scene::Camera& camera, const std::vector<Pass>& passes,
                            uint32_t samples) {
  engine::RenderRequest r = request(camera, passes, samples);
  r.method = engine::Method::kPrimitive;
  r.filter_width = 0;
  r.paths.bounces = {1024, 1024, 1024, 1024, 1024};
  r.paths.filter_glossy = 0;
  return r;
}

// A material by its code, of parameters.
Id add(TestScene& s, const std::string& code, std::vector<glm::vec4> params,
       scene::MaterialFacts facts) {
  return s.add_material(material("void evaluate_material(const Hit hit, inout Surface surface) {\n" +
                                     code + "}\n",
                                 std::move(params), facts));
}

gpu_scene::Camera in_front(int size = 16) {
  return perspective({0, -4, 0}, {0, 0, 0}, 0.4, size, size);
}

// The mean of a pass and its standard error by the spread of pixels, which all have one expectation.
struct Mean {
  double value, error;
};
Mean mean_of(const std::vector<float>& rgba, int channel = 0, int channels = 4) {
  double sum = 0, squares = 0;
  const size_t n = rgba.size() / size_t(channels);
  for (size_t i = 0; i < n; ++i) {
    const double v = rgba[i * size_t(channels) + size_t(channel)];
    sum += v;
    squares += v * v;
  }
  const double m = sum / double(n);
  return {m, std::sqrt(std::max(squares / double(n) - m * m, 0.0) / double(n))};
}

TEST(Paths, AFurnaceGivesTheGeometricSeries) {
  // Inside a closed box that emits 1 and reflects half, light that was scattered k times is 2^-k.
  for (int bounces : {0, 1, 3, 1024}) {
    TestScene s;
    s.add_object(box({0, 0, 0}, glm::vec3(1)),
                 {add(s, "  closure_diffuse(surface, vec3(1.0), vec3(0.5), 0.0, hit.normal);\n"
                         "  closure_emission(surface, vec3(1.0), vec3(1.0));\n",
                      {}, kGlowing)});
    engine::RenderRequest r = paths(perspective({0, -0.5, 0}, {0, 0.5, 0.1}, 1.2, 16, 16), {}, 64);
    r.paths.bounces.total = bounces;
    const Mean m = mean_of(render(s, r)[Pass::kCombined]);
    EXPECT_NEAR(m.value, 2 - std::exp2(-(bounces + 1)), 4 * m.error + 1e-4) << bounces << " bounces";
    EXPECT_LT(m.error, 0.01);
  }
}

TEST(Paths, SmoothGlassAndWhiteSurfacesVanishInAWhiteWorld) {
  const std::pair<std::string, scene::MaterialFacts> cases[] = {
      {"  closure_glass(hit, surface, vec3(1.0), vec3(1.0), 0.0, 1.5, hit.normal);\n", kGlassy},
      {"  closure_glass(hit, surface, vec3(1.0), vec3(1.0), 0.0, 1.0, hit.normal);\n", kGlassy},
      {"  closure_refraction(hit, surface, vec3(1.0), vec3(1.0), 0.0, 1.0, hit.normal);\n", kGlassy},
      {"  closure_glossy(surface, vec3(1.0), vec3(1.0), 0.0, hit.normal);\n", {.glossy = true}},
      {"  closure_diffuse(surface, vec3(1.0), vec3(1.0), 0.0, hit.normal);\n", {.glossy = false}},
      {"  closure_transparent(surface, vec3(1.0), vec3(1.0));\n", {.alpha = true, .glossy = false}}};
  for (const auto& [code, facts] : cases) {
    TestScene s;
    // Facets: what leaves one never meets its neighbours.
    s.add_object(sphere({0, 0, 0}, 0.7f, 12, false), {add(s, code, {}, facts)});
    s.world = constant_world(glm::vec3(1));
    const Picture p = render(s, paths(in_front(), {}, 4));
    Worst worst;
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) worst.compare(p.value(Pass::kCombined, x, y), 1, 1, x, y);
    EXPECT_WORST_BELOW(worst, 1e-4) << code;
  }
}

TEST(Paths, LampsLightAFloorAsTheirFormulasSay) {
  struct Case {
    scene::Light lamp;
    std::function<double(glm::dvec3)> due;
  };
  const glm::dvec3 at(0.3f, 0.2f, 2);
  const Case cases[] = {
      {sun({0.3f, 0.2f, -1}, float(kPi)), [](glm::dvec3) { return 1 / std::sqrt(1.13); }},
      {point(glm::vec3(at), 100), [&](glm::dvec3 p) {
         const glm::dvec3 d = at - p;
         return 100 / (4 * kPi * kPi) * d.z / std::pow(glm::length(d), 3);
       }}};
  for (const Case& c : cases)
    for (bool maps : {false, true}) {
      TestScene s;
      s.add_object(floor_at(0, 3), {s.add_material(lambert())});
      s.lights = {c.lamp};
      const gpu_scene::Camera camera = perspective({0, -2, 3}, {0, 0, 0}, 0.6, 16, 16);
      engine::RenderRequest r = paths(camera, {Pass::kDiffDir}, 1);
      r.paths.bounces.total = 0;
      r.paths.shadow_maps = maps;
      expect_on_floor(render(s, r), camera, c.due, 2e-4);
    }
}

TEST(Paths, LightArrivesFromASurfaceThatLiesNearlyInTheSamePlane) {
  // A glowing square 5 mm above a floor, seen by the floor beside it at less than a degree.
  constexpr double kHeight = 0.005, kHalf = 0.5;
  TestScene s;
  s.add_object(floor_at(0, 3), {s.add_material(lambert())});
  s.add_object(floor_at(float(kHeight), float(kHalf)), {s.add_material(emitter(glm::vec3(1000)))});
  const gpu_scene::Camera camera = orthographic({0.9, 0, 3}, {0.9, 0, 0}, 0.02, 4, 4);
  engine::RenderRequest r = paths(camera, {Pass::kDiffDir}, 256);
  r.paths.bounces.total = 0;
  const glm::dvec2 at(0.9, 0);
  constexpr int n = 400;
  double due = 0;
  for (int i = 0; i < n * n; ++i) {
    const glm::dvec2 d = at + kHalf - 2 * kHalf / n * (glm::dvec2(i % n, i / n) + 0.5);
    const double squared = glm::dot(d, d) + kHeight * kHeight;
    due += 1000 / kPi * kHeight * kHeight / (squared * squared) * 4 * kHalf * kHalf / (n * n);
  }
  const Mean m = mean_of(render(s, r)[Pass::kDiffDir], 0, 3);
  EXPECT_NEAR(m.value / due, 1, 0.05);
}

TEST(Paths, PassesAddUpToCombined) {
  TestScene s;
  const Id mixed = add(s,
                       "  closure_diffuse(surface, vec3(0.5), vec3(0.8, 0.6, 0.4), 0.0, hit.normal);\n"
                       "  closure_glass(hit, surface, vec3(0.5), vec3(0.9, 0.8, 1.0), 0.3, 1.4, hit.normal);\n"
                       "  closure_emission(surface, vec3(1.0), vec3(0.1, 0.2, 0.05));\n",
                       {}, {.emission = true, .emission_varies = false, .transmission = true});
  s.add_object(sphere({0, 0, 0.2f}, 0.6f, 16), {mixed});
  s.add_object(floor_at(-0.5f, 3), {mixed});
  s.lights = {sun({0.3f, 0.2f, -1}, 2), area({0, -1, 2}, {0, 0, -1}, 30, scene::AreaShape::kDisk, 1, 1)};
  s.world = world("vec3 evaluate_world(vec3 d) { return d * 0.5 + 0.5; }\n");
  const Picture p = render(s, paths(in_front(), {Pass::kDiffDir, Pass::kDiffInd, Pass::kGlossDir,
                                                 Pass::kGlossInd, Pass::kTransDir, Pass::kTransInd,
                                                 Pass::kDiffCol, Pass::kGlossCol, Pass::kTransCol,
                                                 Pass::kEmit, Pass::kEnv},
                                    4));
  Worst worst;
  double each[8] = {};
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x)
      for (int c = 0; c < 3; ++c) {
        const auto v = [&](Pass pass) { return p.value(pass, x, y, c); };
        const double parts[8] = {v(Pass::kDiffDir) * v(Pass::kDiffCol),
                                 v(Pass::kDiffInd) * v(Pass::kDiffCol),
                                 v(Pass::kGlossDir) * v(Pass::kGlossCol),
                                 v(Pass::kGlossInd) * v(Pass::kGlossCol),
                                 v(Pass::kTransDir) * v(Pass::kTransCol),
                                 v(Pass::kTransInd) * v(Pass::kTransCol),
                                 v(Pass::kEmit),
                                 v(Pass::kEnv)};
        double sum = 0;
        for (int i = 0; i < 8; ++i) sum += parts[i], each[i] += parts[i];
        worst.compare(sum, v(Pass::kCombined), 0.01, x, y);
      }
  EXPECT_WORST_BELOW(worst, 1e-4);
  for (int i = 0; i < 8; ++i) EXPECT_GT(each[i], 0) << "part " << i;
}

TEST(Paths, AreTheSameBitsWhateverTheStructureAndTwice) {
  TestScene s;
  s.add_object(sphere({0, 0, 0.2f}, 0.6f, 16), {s.add_material(lambert(glm::vec3(0.7f)))});
  s.add_object(floor_at(-0.5f, 3), {s.add_material(lambert(glm::vec3(0.5f)))});
  s.add_object(floor_at(1.5f, 0.3f), {s.add_material(emitter(glm::vec3(20)))});
  s.add_object(floor_at(0.9f, 0.5f), {s.add_material(alpha_card({0.2f, 0.5f, 0.3f, 0.5f}))});
  engine::RenderRequest r = paths(in_front(), {}, 3);
  r.structure.structure = engine::Structure::kBvh;
  const Picture due = render(s, r);
  for (auto structure : {engine::Structure::kBvh, engine::Structure::kOrthographic}) {
    r.structure.structure = structure;
    EXPECT_TRUE(render(s, r)[Pass::kCombined] == due[Pass::kCombined])
        << engine::kStructureNames[size_t(structure)];
  }
}

TEST(Paths, RasterisedPrimaryHitsAndShadowMapsConvergeToTheSamePicture) {
  TestScene s;
  s.add_object(box({0, 0, -0.2f}, glm::vec3(0.4f)), {s.add_material(lambert(glm::vec3(0.7f)))});
  s.add_object(floor_at(-0.6f, 3), {s.add_material(lambert(glm::vec3(0.5f)))});
  s.lights = {sun({0.4f, 0.3f, -1}, 3)};
  s.world = constant_world(glm::vec3(0.2f));
  engine::RenderRequest r = paths(perspective({1, -4, 1}, {0, 0, -0.2}, 0.4, 24, 24), {}, 32);
  r.filter_width = 1.5f;
  const Picture traced = render(s, r);
  r.paths.raster_primary = r.paths.shadow_maps = true;
  const Picture raster = render(s, r);
  EXPECT_NEAR(mean(raster[Pass::kCombined]) / mean(traced[Pass::kCombined]), 1, 5e-3);
  EXPECT_LT(relative_rmse(raster[Pass::kCombined], traced[Pass::kCombined]), 0.06);
}

TEST(Paths, TransparentLayersTintAndCount) {
  // Two red veils that let half of red and all of green pass, before a white wall that glows.
  TestScene s;
  const Id veil = add(s, "  closure_transparent(surface, vec3(1.0), vec3(0.5, 1.0, 0.0));\n", {},
                      {.alpha = true, .glossy = false});
  for (float y : {-1.0f, -0.5f}) s.add_object(quad({0, y, 0}, {3, 0, 0}, {0, 0, 3}), {veil});
  s.add_object(quad({0, 1, 0}, {3, 0, 0}, {0, 0, 3}), {s.add_material(emitter(glm::vec3(1)))});
  engine::RenderRequest r = paths(in_front(), {}, 256);
  r.filter_width = 1;  // rays through the edge between two triangles meet both
  const Picture p = render(s, r);
  const double due[3] = {0.25, 1, 0};
  for (int c = 0; c < 3; ++c) {
    const Mean m = mean_of(p[Pass::kCombined], c);
    EXPECT_NEAR(m.value, due[c], 4 * m.error + 1e-4) << "channel " << c;
  }
  r.paths.bounces.transparent = 0;  // the path ends behind the first veil
  EXPECT_EQ(mean_of(render(s, r)[Pass::kCombined], 1).value, 0);
}

TEST(Paths, LimitsOfAKindEndPathsOfThatKind) {
  // A mirror shows a mirror that shows a glow: two glossy turns.
  TestScene s;
  const Id mirror = add(s, "  closure_glossy(surface, vec3(1.0), vec3(1.0), 0.0, hit.normal);\n", {},
                        {.glossy = true});
  s.add_object(quad({0, 0, 0}, {1, 1, 0}, {0, 0, 2}), {mirror});
  s.add_object(quad({3, 0, 0}, {-1, 1, 0}, {0, 0, 2}), {mirror});
  s.add_object(quad({3, -8, 0}, {4, 0, 0}, {0, 0, 4}), {s.add_material(emitter(glm::vec3(1)))});
  const gpu_scene::Camera camera = perspective({0, -4, 0}, {0, 0, 0}, 0.05, 8, 8);
  engine::RenderRequest r = paths(camera, {}, 1);
  for (int turns = 0; turns < 3; ++turns) {
    r.paths.bounces.glossy = turns;
    // The glow is seen after two turns; the last may be one more than the limit.
    EXPECT_NEAR(mean_of(render(s, r)[Pass::kCombined]).value, turns >= 1 ? 1 : 0, 1e-6) << turns;
  }
}

TEST(Paths, ClampingLimitsASampleAndIsOffByDefault) {
  TestScene s;
  s.add_object(floor_at(0, 3), {s.add_material(lambert())});
  s.lights = {sun({0, 0, -1}, float(10 * kPi))};
  engine::RenderRequest r = paths(perspective({0, -2, 3}, {0, 0, 0}, 0.3, 8, 8), {}, 1);
  EXPECT_NEAR(mean_of(render(s, r)[Pass::kCombined]).value, 10, 1e-3);
  r.paths.clamp_direct = 2;
  EXPECT_NEAR(mean_of(render(s, r)[Pass::kCombined]).value, 2, 1e-3);
  EXPECT_EQ(engine::RenderRequest().paths.clamp_indirect, 0);
}

TEST(Paths, AnApertureBlursWhatIsOutOfFocus) {
  // A glowing square of .1 m at twice the focus' distance: each of its points becomes the aperture's
  // picture, (d - f) / f of its size there.
  TestScene s;
  s.add_object(quad({0, 0, 0}, {0.1f, 0, 0}, {0, 0, 0.1f}), {s.add_material(emitter(glm::vec3(1)))});
  gpu_scene::Camera camera = orthographic({0, -4, 0}, {0, 0, 0}, 1, 41, 41);
  const auto lit = [&](const Picture& p) {
    int count = 0;
    for (int x = 0; x < 41; ++x) count += p.value(Pass::kCombined, x, 20) > 0;
    return count;
  };
  const double due = 0.1 * 0.1;  // the square's share of the picture
  camera.lens = {.radius = 0.4, .focus_distance = 2};
  const Picture blurred = render(s, paths(camera, {}, 256));
  EXPECT_NEAR(mean_of(blurred[Pass::kCombined]).value / due, 1, 0.05);
  EXPECT_NEAR(lit(blurred), 2 * (0.4 + 0.1) / 2 * 41, 2);
  camera.lens.focus_distance = 4;
  const Picture focused = render(s, paths(camera, {}, 256));
  EXPECT_NEAR(lit(focused), 0.2 / 2 * 41, 2);
  camera.lens.blades = 4;
  camera.lens.focus_distance = 2;
  const Picture square = render(s, paths(camera, {}, 256));
  EXPECT_NEAR(mean_of(square[Pass::kCombined]).value / due, 1, 0.05);
  EXPECT_LT(lit(square), lit(blurred) + 2);
}

TEST(Paths, DepthPositionAndOcclusionOfACorner) {
  TestScene s;
  s.add_object(floor_at(0, 50), {s.add_material(lambert())});
  s.add_object(quad({0, 0, 25}, {50, 0, 0}, {0, 0, 25}), {s.add_material(lambert())});
  const gpu_scene::Camera camera = perspective({0, -4, 1}, {0, 0, 1}, 0.01, 4, 4);
  engine::RenderRequest r = paths(camera, {Pass::kDepth, Pass::kPosition, Pass::kAo}, 1024);
  r.paths.ao_distance = 1e6f;
  const Picture p = render(s, r);
  EXPECT_NEAR(p.value(Pass::kDepth, 2, 2), 4, 1e-4);
  EXPECT_NEAR(p.value(Pass::kPosition, 2, 2, 1), 0, 1e-4);
  EXPECT_NEAR(p.value(Pass::kPosition, 2, 2, 2), 1, 0.02);
  // Half of the wall's view is floor, but for what reaches beyond its 50 m.
  const Mean m = mean_of(p[Pass::kAo], 0, 3);
  EXPECT_NEAR(m.value, 0.5, 0.02);
  r.paths.ao_distance = 0.5f;
  EXPECT_NEAR(mean_of(render(s, r)[Pass::kAo], 0, 3).value, 1, 1e-6);
}

TEST(Paths, ATransparentFilmLeavesTheWorldOut) {
  TestScene s;
  s.add_object(quad({0, 0, 0}, {0.3f, 0, 0}, {0, 0, 0.3f}), {s.add_material(lambert())});
  s.world = constant_world(glm::vec3(1));
  engine::RenderRequest r = paths(in_front(), {Pass::kEnv}, 4);
  r.transparent_film = true;
  const Picture p = render(s, r);
  EXPECT_EQ(p.value(Pass::kCombined, 0, 0, 3), 0);
  EXPECT_EQ(p.value(Pass::kCombined, 0, 0, 0), 0);
  EXPECT_EQ(p.value(Pass::kEnv, 0, 0, 0), 1);
  EXPECT_EQ(p.value(Pass::kCombined, 8, 8, 3), 1);
  EXPECT_NEAR(p.value(Pass::kCombined, 8, 8, 0), 1, 1e-4);
}

TEST(Paths, ANoiseThresholdStopsPixelsWhereNothingIsNoisy) {
  // Half of the picture is a glow, the other is lit through noise.
  TestScene s;
  s.add_object(quad({-2, 0, 0}, {2, 0, 0}, {0, 0, 3}), {s.add_material(emitter(glm::vec3(1)))});
  s.add_object(quad({2, 0, 0}, {2, 0, 0}, {0, 0, 3}), {s.add_material(lambert())});
  s.lights = {area({2, -3, 3}, {0, 0.7f, -0.7f}, 60, scene::AreaShape::kSquare, 3, 3)};
  engine::RenderRequest r = paths(in_front(), {Pass::kSampleCount}, 64);
  r.noise_threshold = 0.02;
  const Picture p = render(s, r);
  // As Cycles gives it, over the most that any pixel could have.
  EXPECT_LE(p.value(Pass::kSampleCount, 2, 8), 16.0 / 64);
  EXPECT_GT(p.value(Pass::kSampleCount, 13, 8), 16.0 / 64);
  EXPECT_NEAR(p.value(Pass::kCombined, 2, 8), 1, 1e-5);
}

TEST(Paths, ForcedEffectsChangeNothingThatCanBeSeen) {
  TestScene s;
  s.add_object(sphere({0, 0, 0.2f}, 0.6f, 16), {s.add_material(lambert(glm::vec3(0.7f)))});
  s.add_object(floor_at(-0.5f, 3), {s.add_material(lambert(glm::vec3(0.5f)))});
  s.lights = {sun({0.3f, 0.2f, -1}, 2)};
  engine::RenderRequest r = paths(in_front(), {}, 4);
  const Picture planned = render(s, r);
  r.force_all_effects = true;
  const Picture forced = render(s, r);
  // Other lobes in the program round differently, so that a path may turn elsewhere.
  EXPECT_LT(relative_rmse(forced[Pass::kCombined], planned[Pass::kCombined]), 1e-3);
  for (const engine::EffectReport& e : planned.stats.effects) {
    EXPECT_FALSE(e.reason.empty()) << e.name;
    EXPECT_TRUE(e.runs || e.ms == 0) << e.name << " was skipped and took time";
  }
  EXPECT_GT(planned.stats.rays, 16 * 16 * 4);
}

}  // namespace
}  // namespace panoptes::test
