// Pictures of rays at work: their scale, what they run, keep and free.
#include "film/film.h"
#include "gl/counters.h"
#include "ray_picture/ray_picture.h"
#include "rays/brute_force.h"
#include "still_life.h"

#include <glm/gtc/matrix_transform.hpp>

#include <atomic>
#include <set>

namespace panoptes::test {
namespace {

using film::Pass;
using ray_picture::Kind;

engine::RenderRequest debug_request(Kind kind, const gpu_scene::Camera& camera) {
  engine::RenderRequest r = request(camera, {});
  r.debug_picture = kind;
  return r;
}

// --- the colours -------------------------------------------------------------------------------------

glm::dvec3 colour_of(double n) {
  const glm::dvec3 scale[8] = {{0, 0, 0}, {0, 0, 1}, {0, 1, 1}, {0, 1, 0},
                               {1, 1, 0}, {1, 0, 0}, {1, 1, 1}, {1, 1, 1}};
  const double power = std::min(0.5 * std::log2(1 + n), 6.0);
  const int below = int(power);
  return glm::mix(scale[below], scale[below + 1], power - below);
}

TEST(RayPictureScale, HasTheColoursThatItsHeaderSays) {
  // Brute force tests each ray with every triangle, so their number is the picture.
  gl::Context context;
  gl::ProgramCache programs;
  gl::PassTimer timer(context.device());
  tracing::TriangleList list(context.device());
  BruteForceTracer tracer;
  ray_picture::RayPicture picture;
  film::Film film;
  const gpu_scene::Camera camera = orthographic({0, 0, 5}, {0, 0, 0}, 1, 5, 3);
  const std::atomic<bool> cancelled{false};
  const auto pixels = [&](Kind kind) {
    film.start(5, 3, {});
    picture.render(camera, kind, tracer, list, film, programs, timer, cancelled);
    film.end_sample(0);
    return film.read(Pass::kCombined, 1.0f);
  };
  for (uint32_t count : {0u, 3u, 15u, 40u, 63u, 255u, 1023u, 1500u, 4095u, 6000u}) {
    shared::TracedTriangle triangle{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, shared::SEEN_BY_ALL};
    list.assign(std::vector(count, triangle));
    tracer.build(list, programs, timer);
    const std::vector<float> rgba = pixels(Kind::kTests);
    ASSERT_EQ(rgba.size(), 5u * 3 * 4);
    for (size_t i = 0; i < rgba.size(); i += 4) {
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(rgba[i + size_t(c)], colour_of(count)[c], 2e-6);
      EXPECT_EQ(rgba[i + 3], 1.0f);
    }
  }
  // Brute force has no lists, hence no cells.
  for (Kind kind : {Kind::kLists, Kind::kTiles})
    for (const std::vector<float> rgba = pixels(kind); float value : rgba)
      EXPECT_TRUE(value == 0.0f || value == 1.0f);
}

TEST(RayPictureScale, NamesAreThoseOfTheKinds) {
  for (Kind kind : {Kind::kNone, Kind::kSteps, Kind::kTests, Kind::kLists, Kind::kTiles})
    EXPECT_EQ(ray_picture::find_kind(ray_picture::name(kind)), kind);
  EXPECT_FALSE(ray_picture::known(ray_picture::find_kind("everything")));
}

// --- through the engine ------------------------------------------------------------------------------

bool black(const Picture& picture, int x, int y) {
  return picture.rgb(Pass::kCombined, x, y) == glm::dvec3(0);
}

TEST(RayPicture, SeesWhatTheRasteriserSees) {
  const StillLife life = still_life();
  for (const gpu_scene::Camera& camera :
       {life.camera, orthographic({1, -4, 3}, {0, 0, 0.5}, 3, 31, 40),
        perspective({2, -3, 2}, {0, 0, 0}, 1.5, 40, 31, 2.5, 6, {0.3, -0.2})}) {
    const Picture seen = render(life.scene, request(camera, {Pass::kDepth}));
    const Picture tests = render(debug_request(Kind::kTests, camera));
    int shown = 0, missed = 0;
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x) {
        const bool surface = seen.value(Pass::kDepth, x, y) < 1e9;
        shown += surface;
        missed += surface && black(tests, x, y);
      }
    EXPECT_GT(shown, camera.width * camera.height / 8);
    EXPECT_EQ(missed, 0);
  }
}

TEST(RayPicture, EachKindShowsSomethingElse) {
  const StillLife life = still_life();
  std::set<std::vector<float>> pictures;
  for (Kind kind : {Kind::kNone, Kind::kSteps, Kind::kTests, Kind::kLists, Kind::kTiles}) {
    const Picture picture = render(life.scene, debug_request(kind, life.camera));
    EXPECT_GT(mean(picture[Pass::kCombined]), 0.25);
    pictures.insert(picture[Pass::kCombined]);
  }
  EXPECT_EQ(pictures.size(), 5u);
}

TEST(RayPicture, IsTheSameWhateverTheLightAndTheSamples) {
  StillLife life = still_life();
  engine::RenderRequest r = debug_request(Kind::kSteps, life.camera);
  const Picture once = render(life.scene, r);
  r.last_sample = 3;
  r.exposure = 7;
  r.filter_width = 3;
  r.transparent_film = r.force_all_effects = true;
  life.scene.lights.clear();
  const Picture again = render(life.scene, r);
  EXPECT_LT(relative_rmse(again[Pass::kCombined], once[Pass::kCombined]), 1e-6);
  EXPECT_EQ(again.stats.samples, 3u);
}

TEST(RayPicture, RunsTrianglesStructureAndRaysAlone) {
  const StillLife life = still_life();
  const Picture p = render(life.scene, debug_request(Kind::kTests, life.camera));
  std::set<std::string> effects;
  for (const engine::EffectReport& effect : p.stats.effects)
    if (effect.runs) {
      effects.insert(effect.name);
      EXPECT_EQ(effect.ms > 0, effect.name != "pass_combined") << effect.name;
      EXPECT_FALSE(effect.reason.empty());
    }
  EXPECT_EQ(effects, (std::set<std::string>{"triangles", "structure", "rays", "pass_combined"}));
  for (const auto& [name, ms] : p.stats.passes)
    EXPECT_TRUE(name == "triangles" || name == "rays" || name.starts_with("structure")) << name;
  EXPECT_EQ(p.stats.rays, 48 * 48);
  EXPECT_GT(p.stats.build_ms, 0);
  EXPECT_GT(p.stats.trace_ms, 0);
}

// Whether the list was written and the structure built in a frame.
std::pair<bool, bool> made(const Picture& picture) {
  std::pair<bool, bool> result;
  for (const auto& [name, ms] : picture.stats.passes) {
    result.first |= name == "triangles";
    result.second |= name.starts_with("structure");
  }
  return result;
}

// Each structure is another, made and measured on the way; which one makes no difference to where
// rays end.
TEST(RayPicture, ShowsTheStructureThatIsChosen) {
  using engine::Structure;
  const StillLife life = still_life();
  std::vector<Picture> pictures;
  // (Lists in one array and linked ones are in the same cells, and take as many steps.)
  for (Structure structure :
       {Structure::kOrthographic, Structure::kCube, Structure::kBvh, Structure::kAuto}) {
    engine::RenderRequest r = debug_request(Kind::kSteps, life.camera);
    r.structure.structure = structure;
    pictures.push_back(render(life.scene, r));
    if (structure == Structure::kAuto) break;
    EXPECT_TRUE(made(pictures.back()).second) << int(structure);
    for (size_t i = 0; i + 1 < pictures.size(); ++i)
      EXPECT_NE(pictures[i][Pass::kCombined], pictures.back()[Pass::kCombined]) << int(structure);
  }
  // What is left to us is one of them.
  EXPECT_TRUE(pictures.back()[Pass::kCombined] == pictures[0][Pass::kCombined] ||
              pictures.back()[Pass::kCombined] == pictures[2][Pass::kCombined]);

  engine::RenderRequest lists = debug_request(Kind::kSteps, life.camera);
  lists.structure.structure = Structure::kLists;
  const Picture linked = render(lists);
  EXPECT_TRUE(made(linked).second);
  EXPECT_EQ(linked[Pass::kCombined], pictures[1][Pass::kCombined]);

  // Other tiles make another picture, and build anew; the same again build nothing.
  engine::RenderRequest r = debug_request(Kind::kTiles, life.camera);
  r.structure = {Structure::kOrthographic, 4, 0};
  const Picture coarse = render(r);
  EXPECT_TRUE(made(coarse).second);
  EXPECT_FALSE(made(render(r)).second);
  r.structure.tiles = 64;
  EXPECT_NE(render(r)[Pass::kCombined], coarse[Pass::kCombined]);
}

TEST(RayPicture, KeepsTheStructureWhileGeometryRests) {
  const StillLife life = still_life();
  const auto frame = [&](Kind kind, double eye) {
    return made(render(debug_request(kind, perspective({eye, -5, 3}, {0, 0, 0}, 1, 16, 16))));
  };
  const std::pair both{true, true}, neither{false, false};
  EXPECT_EQ(made(render(life.scene, debug_request(Kind::kTests, life.camera))), both);
  EXPECT_EQ(frame(Kind::kTests, 1), neither);
  EXPECT_EQ(frame(Kind::kTiles, 2), neither);
  shared_engine().edit([](scene::Scene& scene) { scene.set_lights({}); });
  EXPECT_EQ(frame(Kind::kTiles, 2), neither);
  const int moved = 1;
  const glm::mat4 place = glm::translate(glm::mat4(1.0f), {0.0f, 0.0f, 0.5f});
  shared_engine().edit(
      [&](scene::Scene& scene) { scene.set_instance_matrices({&moved, 1}, {&place, 1}); });
  EXPECT_EQ(frame(Kind::kTiles, 2), both);
  EXPECT_EQ(frame(Kind::kTiles, 2), neither);
  EXPECT_EQ(frame(Kind::kNone, 2), neither);  // frees it
  EXPECT_EQ(frame(Kind::kTiles, 2), both);
}

TEST(RayPicture, LeavesNothingBehind) {
  const StillLife life = still_life();
  const engine::RenderRequest plain = request(life.camera, {});
  render(life.scene, plain);
  const gl::Counters& counters = gl::counters();
  const int64_t buffers = counters.buffers, textures = counters.textures,
                bytes = counters.memory_bytes;
  render(debug_request(Kind::kTests, life.camera));
  EXPECT_GT(counters.buffers, buffers);
  EXPECT_GT(counters.memory_bytes, bytes);
  render(plain);
  EXPECT_EQ(counters.buffers, buffers);
  EXPECT_EQ(counters.textures, textures);
  EXPECT_EQ(counters.memory_bytes, bytes);
}

TEST(RayPicture, OfNothingIsBlack) {
  const Picture p = render(TestScene(), debug_request(Kind::kLists, still_life().camera));
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) EXPECT_TRUE(black(p, x, y));
}

TEST(RayPicture, WarnsOfWhatRaysCannotMeet) {
  TestScene s = still_life().scene;
  Geometry wild = floor_at(1, 1);
  wild.positions[3].x = -1e30f;
  s.add_object(wild, {});
  const Picture p = render(s, debug_request(Kind::kTests, still_life().camera));
  ASSERT_EQ(p.stats.warnings.size(), 1u);
  EXPECT_EQ(p.stats.warnings[0].find("Rays meet all but 1 of "), 0u) << p.stats.warnings[0];
}

}  // namespace
}  // namespace panoptes::test
