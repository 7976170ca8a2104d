// Edits between frames: each shows in the next picture, and uploads what changed and nothing else.
#include "gl/counters.h"
#include "still_life.h"
#include "support.h"

#include <algorithm>
#include <random>
#include <set>

namespace panoptes::test {
namespace {

using film::Pass;

class Edits : public ::testing::Test {
 protected:
  Edits()
      : life(still_life()),
        r(request(life.camera, {Pass::kDiffCol, Pass::kDiffDir, Pass::kDepth})) {
    const uint8_t texel[4] = {255, 128, 0, 255};
    life.scene.add_image(scene::make_image("i", 1, 1, std::span<const uint8_t>(texel), false,
                                           scene::AlphaMode::kNone));
    scene::Material textured = material(
        "void evaluate_material(const Hit hit, inout Surface surface) {\n"
        "  vec3 color = sample_image(hit, 0, hit_uv(hit, UV_DEFAULT), false).rgb * param(0).rgb;\n"
        "  closure_diffuse(surface, vec3(1.0), color, 0.0, hit.normal);\n"
        "}\n",
        {glm::vec4(1)});
    textured.textures = {{1}};
    life.scene.materials[1] = textured;
    before = render(life.scene, r);
    box_pixel = find_box();
  }

  struct Cost {
    int64_t programs, bytes, textures;
  };
  // Runs an edit and the next frame; what the frame compiled and uploaded.
  template <class F>
  Cost cost_of(F&& change) {
    const gl::Counters& c = gl::counters();
    const Cost start{c.programs, c.uploaded_bytes, c.textures};
    shared_engine().edit(change);
    after = render(r);
    return {c.programs - start.programs, c.uploaded_bytes - start.bytes,
            c.textures - start.textures};
  }
  // A pixel where the red box is seen.
  std::pair<int, int> find_box() const {
    for (int y = 0; y < 48; ++y)
      for (int x = 0; x < 48; ++x)
        if (before.value(Pass::kDiffCol, x, y, 2) == 0 && before.value(Pass::kDiffCol, x, y) == 1)
          return {x, y};
    throw Error("the box is not in the picture: mend the test");
  }
  glm::dvec3 box_color() const {
    return after.rgb(Pass::kDiffCol, box_pixel.first, box_pixel.second);
  }
  bool same(Pass pass) const { return after[pass] == before[pass]; }

  // Views of the camera and of the shadow maps, lists of lamps and faces: what any frame sends.
  static constexpr int64_t kFrameBytes = 8 << 10;

  StillLife life;
  engine::RenderRequest r;
  Picture before, after;
  std::pair<int, int> box_pixel;
};

TEST_F(Edits, NothingChangedUploadsNoScene) {
  const Cost cost = cost_of([](scene::Scene&) {});
  EXPECT_EQ(cost.programs, 0);
  EXPECT_EQ(cost.textures, 0);
  EXPECT_LT(cost.bytes, kFrameBytes);
  EXPECT_TRUE(same(Pass::kCombined));
}

TEST_F(Edits, AMovedCameraUploadsABlock) {
  r.camera = perspective({0.6, -5, 3}, {0, 0, 0.5}, 0.75, 48, 48);
  const Cost cost = cost_of([](scene::Scene&) {});
  EXPECT_EQ(cost.programs, 0);
  EXPECT_LT(cost.bytes, kFrameBytes);
  EXPECT_FALSE(same(Pass::kDepth));
}

TEST_F(Edits, ADraggedSliderIsAnUploadAndNeverACompile) {
  const Cost cost = cost_of(
      [](scene::Scene& scene) { scene.set_material_params(2, {glm::vec4(0.5f, 1, 1, 1)}); });
  EXPECT_EQ(cost.programs, 0);
  EXPECT_EQ(cost.textures, 0);
  EXPECT_LT(cost.bytes, kFrameBytes);
  EXPECT_EQ(box_color().r, 0.5);
  EXPECT_TRUE(same(Pass::kDepth));
}

TEST_F(Edits, AMovedObjectUploadsItsMatrix) {
  const Cost cost = cost_of([](scene::Scene& scene) {
    const int index = 1;
    glm::mat4 matrix(1);
    matrix[3].z = 0.75f;
    scene.set_instance_matrices({&index, 1}, {&matrix, 1});
  });
  EXPECT_EQ(cost.programs, 0);
  EXPECT_EQ(cost.textures, 0);
  EXPECT_LT(cost.bytes, kFrameBytes);
  EXPECT_FALSE(same(Pass::kDepth));
  EXPECT_FALSE(same(Pass::kDiffDir)) << "its shadow moves along";
}

TEST_F(Edits, AnEditedMeshUploadsItsOwnRange) {
  const Cost cost = cost_of([](scene::Scene& scene) {
    scene.set_mesh(2, box({-1, 0.5f, 0.75f}, glm::vec3(0.5f)).mesh());
  });
  EXPECT_EQ(cost.programs, 0);
  // The sphere alone is some 200 KiB; a box is 12 triangles.
  EXPECT_LT(cost.bytes, 24 << 10);
  EXPECT_FALSE(same(Pass::kDepth));
}

TEST_F(Edits, AMeshThatGrowsAndShrinksIsShownAsItIs) {
  for (int segments : {8, 64, 4, 200, 16}) {
    cost_of([&](scene::Scene& scene) {
      scene.set_mesh(2, sphere({-1, 0.5f, 0.5f}, 0.5f, segments).mesh());
    });
    // The other meshes keep their places in the heaps: the floor and the large sphere are intact.
    int differ = 0;
    for (size_t i = 0; i < after[Pass::kDepth].size(); ++i)
      differ += after[Pass::kDepth][i] != before[Pass::kDepth][i];
    EXPECT_LT(differ, 48 * 48 / 4) << segments;
    EXPECT_GT(differ, 10) << segments;
  }
  cost_of([&](scene::Scene& scene) { scene.set_mesh(2, life.scene.meshes[1]); });
  for (Pass pass : {Pass::kCombined, Pass::kDepth, Pass::kDiffCol}) EXPECT_TRUE(same(pass));
}

TEST_F(Edits, AMovedLampUploadsNoGeometry) {
  const Cost cost = cost_of([](scene::Scene& scene) {
    scene.set_lights({sun({-0.5f, 0.25f, -1}, 2)});
  });
  EXPECT_LT(cost.bytes, kFrameBytes);
  EXPECT_FALSE(same(Pass::kDiffDir));
  EXPECT_TRUE(same(Pass::kDiffCol));
}

TEST_F(Edits, AReplacedImageIsShown) {
  const Cost cost = cost_of([](scene::Scene& scene) {
    const uint8_t texel[4] = {0, 255, 255, 255};
    scene.set_image(1, scene::make_image("i", 1, 1, std::span<const uint8_t>(texel), false,
                                         scene::AlphaMode::kNone));
  });
  EXPECT_EQ(cost.programs, 0);
  EXPECT_LT(cost.bytes, kFrameBytes);
  EXPECT_EQ(box_color(), glm::dvec3(0, 1, 1));
}

TEST_F(Edits, NewMaterialCodeIsShown) {
  cost_of([](scene::Scene& scene) { scene.set_material(2, lambert({0.25f, 0.5f, 0.75f})); });
  EXPECT_EQ(box_color(), glm::dvec3(0.25, 0.5, 0.75));
  cost_of([](scene::Scene& scene) { scene.remove_material(2); });
  EXPECT_NEAR(box_color().g, 0.8, 1e-3);  // the default grey
}

TEST_F(Edits, MoreParametersAreShownToo) {
  // The block grows: every other material's first parameter moves.
  cost_of([](scene::Scene& scene) {
    scene.set_material_params(1, std::vector<glm::vec4>(9, glm::vec4(0.5f)));
    scene.set_material_params(2, {glm::vec4(0.25f, 1, 1, 1)});
  });
  EXPECT_EQ(box_color().r, 0.25);
}

TEST_F(Edits, RemovedAndAddedObjectsAreShown) {
  cost_of([](scene::Scene& scene) { scene.remove_mesh(2); });
  EXPECT_NE(box_color(), before.rgb(Pass::kDiffCol, box_pixel.first, box_pixel.second));
  cost_of([&](scene::Scene& scene) { scene.set_mesh(2, life.scene.meshes[1]); });
  EXPECT_TRUE(same(Pass::kCombined));
  cost_of([&](scene::Scene& scene) { scene.set_instances({}, {}); });
  for (float d : after[Pass::kDepth]) ASSERT_EQ(d, 1e10f);
  cost_of(
      [&](scene::Scene& scene) { scene.set_instances(life.scene.instances, life.scene.table); });
  EXPECT_TRUE(same(Pass::kCombined));
}

TEST_F(Edits, AnotherSlotTableIsShown) {
  cost_of([&](scene::Scene& scene) {
    std::vector<Id> table = life.scene.table;
    std::swap(table[0], table[1]);
    scene.set_instances(life.scene.instances, table);
  });
  EXPECT_EQ(box_color().r, 0.75);
}

// --- many objects
// ---------------------------------------------------------------------------------

// A hundred boxes of four meshes and materials, some of which may discard fragments, some hidden
// from the camera or from lamps.
struct Crowd {
  explicit Crowd(unsigned seed) : random(seed) {
    for (int i = 0; i < 4; ++i) {
      const float shade = 0.25f * float(i + 1);
      scene.add_material(i % 2 ? alpha_card({shade, 0.5f, 1, 0.75f}) : lambert({shade, 1, 0.5f}));
      scene.meshes.push_back(box({0, 0, 0}, glm::vec3(0.1f + 0.05f * float(i))).mesh());
    }
    scene.materials[3].attributes = {"uv"};
    scene.lights = {sun({0.5f, 0.25f, -1}, 2)};
    for (int i = 0; i < 100; ++i) add();
  }
  float number() { return float(random() % 1024) / 512 - 1; }
  uint32_t pick(uint32_t count) { return uint32_t(random()) % count; }
  void add() {
    glm::mat4 place(1);
    place[3] = glm::vec4(2 * number(), 2 * number(), number(), 1);
    constexpr uint32_t kBits[4] = {shared::SEEN_BY_ALL, shared::SEEN_BY_ALL, shared::SEEN_BY_CAMERA,
                                   shared::SEEN_BY_SHADOW};
    scene.instances.insert(scene.instances.begin() + pick(uint32_t(scene.instances.size() + 1)),
                           {Id(1 + pick(4)), place, int(pick(4)), kBits[pick(4)]});
    scene.table = {1, 2, 3, 4};
  }
  void remove() {
    scene.instances.erase(scene.instances.begin() + pick(uint32_t(scene.instances.size())));
  }

  TestScene scene;
  std::mt19937 random;
};

TEST(EditsOfMany, GiveThePictureOfAFreshScene) {
  Crowd crowd(3);
  engine::RenderRequest r = request(perspective({0, -6, 4}, {0, 0, 0}, 0.6, 40, 40),
                                    {Pass::kDiffCol, Pass::kDiffDir, Pass::kDepth}, 2);
  render(crowd.scene, r);
  for (int step = 0; step < 12; ++step) {
    for (uint32_t edits = crowd.pick(6); edits > 0; --edits) {
      crowd.add();
      if (crowd.pick(2)) crowd.remove();
      if (crowd.pick(2)) crowd.remove();
    }
    if (step % 3 == 0) crowd.scene.materials[0] = lambert({crowd.number(), 0.5f, 0});
    if (step % 4 == 1) {
      // One more name in every mesh's record, until they are too small for it.
      crowd.scene.materials[1].attributes.push_back(fmt::format("name {}", step));
      for (int i = 0; i < 4; ++i)
        crowd.scene.materials[2].attributes.push_back(fmt::format("other {} {}", step, i));
    }
    if (step % 4 == 2) crowd.scene.meshes[2] = sphere({0, 0, 0}, 0.2f, 4 + step).mesh();
    if (step % 5 == 4)
      std::erase_if(crowd.scene.instances, [](const scene::Instance& i) {
        return i.material_offset == 2;  // nobody uses this material now
      });
    shared_engine().edit([&](scene::Scene& scene) {
      for (size_t i = 0; i < 4; ++i) scene.set_mesh(Id(i + 1), crowd.scene.meshes[i]);
      for (size_t i = 0; i < 4; ++i) scene.set_material(Id(i + 1), crowd.scene.materials[i]);
      scene.set_instances(crowd.scene.instances, crowd.scene.table);
    });
    const Picture edited = render(r);
    render(TestScene{}, r);  // nothing keeps its place
    const Picture fresh = render(crowd.scene, r);
    // Random thresholds depend on what an object is and where, not on when it came.
    for (Pass pass : {Pass::kCombined, Pass::kDiffCol, Pass::kDiffDir, Pass::kDepth})
      ASSERT_EQ(edited[pass], fresh[pass]) << "step " << step;
  }
}

TEST(EditsOfMany, OfOneObjectUploadWhatIsItsOwn) {
  Crowd crowd(7);
  const engine::RenderRequest r =
      request(perspective({0, -6, 4}, {0, 0, 0}, 0.6, 16, 16), {Pass::kDiffCol});
  render(crowd.scene, r);
  const auto sent = [&](auto edit) {
    const int64_t before = gl::counters().uploaded_bytes;
    shared_engine().edit(edit);
    render(r);
    return gl::counters().uploaded_bytes - before;
  };
  const auto list = [&](scene::Scene& scene) {
    scene.set_instances(crowd.scene.instances, crowd.scene.table);
  };
  const auto lamp = [&](scene::Scene& scene) { scene.set_lights({sun({0.5f, 0.25f, -1}, 3)}); };
  sent(lamp);
  const int64_t frame = sent(lamp);  // with the lamps' maps drawn again
  EXPECT_EQ(sent(list), frame) << "the same list";
  // Equal bytes between two edited places are sent along up to kGap.
  constexpr int64_t kInstance = 64, kDraw = 36, kGap = 256;
  std::reverse(crowd.scene.instances.begin(), crowd.scene.instances.end());
  EXPECT_EQ(sent(list), frame) << "the same in another order";
  int64_t all = 0;
  for (int i = 0; i < 20; ++i) {
    crowd.add();
    all += sent(list) - frame;
  }
  // Now and then a list moves to where it has room.
  EXPECT_LE(all, 20 * 2 * (kInstance + kDraw));
  for (int i = 0; i < 20; ++i) {
    crowd.remove();
    // The last instance and the last draw fill the holes.
    EXPECT_LE(sent(list) - frame, kInstance + 2 * kDraw + kGap);
  }
}

TEST_F(Edits, SettingsOfTheFrameDoNotStick) {
  engine::RenderRequest other = r;
  other.camera.width = 30;
  other.camera.height = 20;
  other.shadow_resolution = 64;
  other.last_sample = 3;
  other.force_all_effects = true;
  render(other);
  after = render(r);
  for (Pass pass : {Pass::kCombined, Pass::kDepth, Pass::kDiffDir}) EXPECT_TRUE(same(pass));
}

TEST(ValueEdits, OfPlainMaterialsKeepShadowsAndGlow) {
  TestScene s;
  const Id plain = s.add_material(lambert()), glow = s.add_material(emitter(glm::vec3(1)));
  s.add_object(floor_at(0, 3), {plain});
  s.add_object(quad({1, 0, 2}, {0.5f, 0, 0}, {0, 0.5f, 0}), {glow});
  s.lights = {sun({0.2f, 0.1f, -1}, 1)};
  const engine::RenderRequest r = request(orthographic({0, 0, 9}, {0, 0, 0}, 1.0, 12, 12), {});
  const auto drawn = [](const Picture& picture) {
    std::set<std::string> names;
    for (const auto& [name, ms] : picture.stats.passes) names.insert(name);
    return std::pair(names.count("sun_shadows"), names.count("emissive_shadows"));
  };
  const auto change = [&](Id id, float value) {
    shared_engine().edit([&](scene::Scene& scene) {
      scene.set_material_params(id, {glm::vec4(value, value, value, 1)});
    });
    return drawn(render(r));
  };
  EXPECT_EQ(drawn(render(s, r)), std::pair(size_t(1), size_t(1)));
  EXPECT_EQ(change(plain, 0.25f), std::pair(size_t(0), size_t(0)));
  // A lamp's maps are drawn together with those of what glows.
  EXPECT_EQ(change(glow, 2.0f).second, size_t(1));
}

}  // namespace
}  // namespace panoptes::test
