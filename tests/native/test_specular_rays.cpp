// What mirrors and glass show in Real-time: by geometry that has the answer elsewhere in the picture,
// by the path tracer, and by what it costs where nothing is smooth.
#include "gl/counters.h"
#include "still_life.h"
#include "support.h"

namespace panoptes::test {
namespace {

using film::Pass;
using Mode = specular_rays::Mode;

const std::vector<Pass> kLightPasses{Pass::kDiffDir,  Pass::kDiffCol,  Pass::kGlossCol,
                                     Pass::kGlossDir, Pass::kGlossInd, Pass::kTransCol,
                                     Pass::kTransDir, Pass::kTransInd, Pass::kEmit};

// A material of closures in GLSL.
scene::Material closures(const std::string& statements, scene::MaterialFacts facts) {
  return material("void evaluate_material(const Hit hit, inout Surface surface) {\n" + statements +
                      "\n}\n",
                  {glm::vec4(0)}, facts);
}

scene::Material mirror(double reflectance = 1, double roughness = 0) {
  return closures(fmt::format("closure_glossy(surface, vec3(1.0), vec3({:f}), {:f}, hit.normal);",
                              reflectance, roughness),
                  {.glossy = true, .least_roughness = float(roughness)});
}

scene::Material glass(double ior, double roughness = 0) {
  return closures(fmt::format("closure_glass(hit, surface, vec3(1.0), vec3(1.0), {:f}, {:f}, hit.normal);",
                              roughness, ior),
                  {.glossy = true, .transmission = true, .least_roughness = float(roughness)});
}

// A wall that glows in bands, and reflects nothing.
scene::Material bands() {
  return closures(
      "vec2 uv = hit_uv(hit, UV_DEFAULT);\n"
      "closure_emission(surface, vec3(1.0), vec3(1.0 + sin(20.0 * uv.x), 0.5 + uv.y, 1.5 - uv.x));",
      {.emission = true, .glossy = false});
}

engine::RenderRequest light_request(const gpu_scene::Camera& camera, uint32_t samples = 1,
                                    Mode mode = Mode::kAuto) {
  engine::RenderRequest r = request(camera, kLightPasses, samples);
  r.specular_rays.mode = mode;
  r.cache.enabled = false;
  r.occlusion.strength = 0;
  return r;
}

bool ran(const Picture& picture, const std::string& effect) {
  for (const engine::EffectReport& e : picture.stats.effects)
    if (e.name == effect) return e.runs;
  throw Error("there is no such effect: " + effect);
}

constexpr int kSize = 32;

// A lit wall at y = -6, a box that casts a shadow on it, and (id 3) a mirror at y = 0 that faces it.
TestScene wall_and_mirror() {
  TestScene s;
  const Id grey = s.add_material(lambert({0.75f, 0.5f, 0.25f}));
  s.add_object(quad({0, -6, 0}, {-5, 0, 0}, {0, 0, 5}), {grey});
  s.add_object(box({0.5f, -5, 0.5f}, glm::vec3(0.5f)), {grey});
  s.add_object(quad({0, 0, 0}, {3, 0, 0}, {0, 0, 3}), {s.add_material(mirror(0.75))});
  s.lights = {point({1.5f, -2.5f, 2}, 500)};
  return s;
}

TEST(SpecularRays, AFlatMirrorShowsWhatTheMirroredCameraSees) {
  TestScene s = wall_and_mirror();
  const Picture seen = render(s, light_request(perspective({0.25, -2, 0.5}, {0.25, 0, 0.5}, 0.8, kSize, kSize)));
  // From behind, where the mirror stays part of the scene but is met by nothing that looks.
  s.instances[2].visibility = shared::SEEN_BY_VOLUME_SCATTER;
  const Picture direct = render(s, light_request(perspective({0.25, 2, 0.5}, {0.25, 0, 0.5}, 0.8, kSize, kSize)));
  EXPECT_TRUE(ran(seen, "specular_rays"));
  Worst worst;
  double shadowed = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const glm::dvec3 expected = 0.75 * direct.rgb(Pass::kCombined, kSize - 1 - x, y);
      const glm::dvec3 found = seen.rgb(Pass::kGlossInd, x, y);
      for (int c = 0; c < 3; ++c) worst.compare(found[c], expected[c], 0.01, x, y);
      shadowed += expected.x < 0.01;
    }
  EXPECT_GT(shadowed, 20) << "the box casts no shadow on what is seen";
  // Normals have 16 bits an axis, so the ray is off by as much.
  EXPECT_WORST_BELOW(worst, 3e-3);
}

TEST(SpecularRays, GlassThatBendsNothingIsNotThere) {
  TestScene s;
  const Id grey = s.add_material(lambert({0.75f, 0.5f, 0.25f})), glow = s.add_material(bands());
  s.add_object(quad({-2, 2, 0}, {2, 0, 0}, {0, 0, 4}), {grey});
  s.add_object(quad({2, 2, 0}, {2, 0, 0}, {0, 0, 4}), {glow});
  s.lights = {point({0, -1, 1}, 100)};
  s.world = world("vec3 evaluate_world(vec3 d) { return d * 0.5 + 0.5; }\n");
  const gpu_scene::Camera camera = perspective({0, -3, 0}, {0, 0, 0}, 1.2, kSize, kSize);
  const Picture bare = render(s, light_request(camera));
  s.add_object(box({0, 0, 0}, {2, 0.25f, 2}), {s.add_material(glass(1))});
  s.instances[2].visibility = shared::SEEN_BY_ALL & ~shared::SEEN_BY_SHADOW;
  const Picture through = render(s, light_request(camera));
  Worst worst;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      for (int c = 0; c < 3; ++c)
        worst.compare(through.rgb(Pass::kCombined, x, y)[c], bare.rgb(Pass::kCombined, x, y)[c], 0.01, x, y);
  EXPECT_WORST_BELOW(worst, 2e-3);
  EXPECT_GT(mean(through[Pass::kTransInd]), 0.01);
}

// Emitters and the world alone, around surfaces of all kinds that reflect nothing diffusely: all that
// there is to see comes by specular paths.
TestScene cabinet(const std::vector<scene::Material>& materials) {
  TestScene s;
  const Id glow = s.add_material(bands());
  s.add_object(quad({0, 4, 0}, {4, 0, 0}, {0, 0, 4}), {glow});
  s.add_object(quad({0, -6, 0}, {-6, 0, 0}, {0, 0, 6}), {glow});
  s.add_object(quad({0, 0, -1.5f}, {3, 0, 0}, {0, 3, 0}), {s.add_material(mirror(0.5))});
  s.world = world("vec3 evaluate_world(vec3 d) { return 0.25 + 0.25 * d; }\n");
  for (size_t i = 0; i < materials.size(); ++i)
    s.add_object(sphere({float(i) * 2 - float(materials.size() - 1), 0, 0}, 0.9f, 48),
                 {s.add_material(materials[i])});
  return s;
}

// Light of a pass with the colour that was divided out of it, as means of blocks of 12 x 12 pixels.
std::vector<float> blocks(const Picture& picture, Pass pass) {
  const Pass divisor = film::info(pass).divisor;
  const int across = picture.width / 12, down = picture.height / 12;
  std::vector<float> means(size_t(across * down) * 3);
  for (int y = 0; y < down * 12; ++y)
    for (int x = 0; x < across * 12; ++x) {
      glm::dvec3 light = picture.rgb(pass, x, y);
      if (divisor != pass) light *= picture.rgb(divisor, x, y);
      for (int c = 0; c < 3; ++c) means[size_t(y / 12 * across + x / 12) * 3 + size_t(c)] += float(light[c]) / 144;
    }
  return means;
}

TEST(SpecularRays, AgreeWithThePathTracer) {
  const scene::MaterialFacts coated{.glossy = true, .layers = true, .least_roughness = 0};
  const TestScene s = cabinet(
      {mirror(0.9, 0.25), glass(1.5),
       closures("closure_glossy(surface, vec3(0.5), vec3(0.9, 0.6, 0.3), 0.3, hit.normal);\n"
                "add_coat(surface, 0.8, 0.0, hit.normal);",
                coated)});
  engine::RenderRequest r = light_request(perspective({0, -5, 1}, {0, 0, -0.2}, 0.75, 36, 24), 64);
  const Picture found = render(s, r);
  r.method = engine::Method::kPrimitive;
  r.paths.filter_glossy = 0;
  const Picture expected = render(s, r);
  for (Pass pass : {Pass::kCombined, Pass::kGlossDir, Pass::kGlossInd, Pass::kTransInd}) {
    const std::vector<float> one = blocks(found, pass), another = blocks(expected, pass);
    EXPECT_GT(mean(another), 0.005) << film::info(pass).name;
    EXPECT_LT(relative_rmse(one, another), 0.05) << film::info(pass).name;
  }
}

TEST(SpecularRays, LoseNoLightInAWhiteFurnace) {
  TestScene s;
  s.add_object(sphere({0, 0, 0}, 1, 64), {s.add_material(glass(1.5))});
  s.add_object(sphere({0.4f, 0, 0}, 0.4f, 64), {s.add_material(glass(2.4))});
  s.add_object(quad({0, 0, -1}, {3, 0, 0}, {0, 3, 0}), {s.add_material(mirror())});
  s.world = constant_world(glm::vec3(1));
  const Picture p = render(s, light_request(perspective({0, -4, 1}, {0, 0, 0}, 0.8, kSize, kSize), 4));
  Worst worst;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) worst.compare(p.value(Pass::kCombined, x, y), 1, 1, x, y);
  EXPECT_WORST_BELOW(worst, 2e-3);
}

TEST(SpecularRays, EndBetweenFacingMirrors) {
  TestScene s;
  const Id id = s.add_material(mirror());
  s.add_object(quad({0, 2, 0}, {4, 0, 0}, {0, 0, 4}), {id});
  s.add_object(quad({0, -2, 0}, {-4, 0, 0}, {0, 0, 4}), {id});
  s.add_object(box({0, 0.5f, 0}, glm::vec3(0.5f)), {s.add_material(emitter(glm::vec3(2)))});
  const Picture p = render(s, light_request(perspective({1, -1.5, 0.5}, {0, 2, 0}, 1, kSize, kSize), 2));
  EXPECT_GT(mean(p[Pass::kGlossDir]), 0.01);
  EXPECT_GT(mean(p[Pass::kGlossInd]), 0.01) << "mirrors in mirrors are black";
}

TEST(SpecularRays, ComeToTheSamePictureTwice) {
  const TestScene s = cabinet({mirror(0.9, 0.2), glass(1.5, 0.1)});
  const engine::RenderRequest r = light_request(perspective({0, -5, 1}, {0, 0, 0}, 0.75, kSize, kSize), 2);
  const Picture once = render(s, r), again = render(s, r);
  for (const auto& [pass, pixels] : once.passes) EXPECT_TRUE(pixels == again[pass]) << film::info(pass).name;
}

TEST(SpecularRays, SeePartlyTransparentSurfacesInTheirColor) {
  TestScene s;
  s.add_object(quad({0, 0, 0}, {3, 0, 0}, {0, 0, 3}), {s.add_material(mirror())});
  s.add_object(quad({0, -4, 0}, {-9, 0, 0}, {0, 0, 9}), {s.add_material(emitter(glm::vec3(2)))});
  // Behind the camera: half red, through which the emitter is seen.
  s.add_object(quad({0, -3, 0}, {-9, 0, 0}, {0, 0, 9}),
               {s.add_material(closures("closure_transparent(surface, vec3(1.0), vec3(0.5, 0.25, 0.0));",
                                        {.alpha = true, .glossy = false}))});
  const Picture p = render(s, light_request(perspective({0, -2, 0}, {0, 0, 0}, 0.5, 16, 16), 64));
  glm::dvec3 sum(0);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) sum += p.rgb(Pass::kCombined, x, y) / 256.0;
  EXPECT_NEAR(sum.r, 1, 0.05);
  EXPECT_NEAR(sum.g, 0.5, 0.025);
  EXPECT_EQ(sum.b, 0);
}

TEST(SpecularRays, OnlyRunWhereSomethingIsSmoothEnough) {
  const gpu_scene::Camera camera = perspective({0, -5, 1}, {0, 0, 0}, 0.75, 16, 16);
  TestScene rough = cabinet({mirror(1, 0.5)});
  rough.materials[1] = lambert();  // the floor
  EXPECT_FALSE(ran(render(rough, light_request(camera)), "specular_rays"));
  EXPECT_TRUE(ran(render(rough, light_request(camera, 1, Mode::kOn)), "specular_rays"));
  // Pixels are told apart even where the material may be smooth somewhere.
  rough.materials[2].facts.least_roughness = 0;
  const Picture none = render(rough, light_request(camera));
  EXPECT_TRUE(ran(none, "specular_rays"));
  EXPECT_EQ(none.stats.rays, 0);
}

TEST(SpecularRays, CostNothingWhereNothingIsSmooth) {
  TestScene s = still_life().scene;
  const auto cost = [&](Mode mode) {
    const gl::Counters& c = gl::counters();
    const int64_t before[] = {c.programs, c.textures, c.memory_bytes};
    engine::Engine engine;
    engine.edit([&](scene::Scene& scene) { s.install(scene); });
    engine::RenderRequest r = light_request(still_life().camera, 1, mode);
    const auto job = engine.render(r);
    while (!job->wait(60)) throw Error("the render did not end");
    job->check();
    return std::vector<int64_t>{c.programs - before[0], c.textures - before[1],
                                c.memory_bytes - before[2]};
  };
  EXPECT_EQ(cost(Mode::kAuto), cost(Mode::kOff));
  s.materials[1] = mirror(1, 0.5);
  const auto off = cost(Mode::kOff);
  EXPECT_EQ(cost(Mode::kAuto), off);
  EXPECT_GT(cost(Mode::kOn), off);
}

}  // namespace
}  // namespace panoptes::test
