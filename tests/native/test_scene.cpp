// The scene's bookkeeping: what each edit reports, what facts say, what is refused.
#include "base/error.h"
#include "support.h"

#include <limits>

namespace panoptes::test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

class SceneChanges : public ::testing::Test {
 protected:
  SceneChanges() {
    scene.set_mesh(7, floor_at(0, 1).mesh());
    scene.set_mesh(8, box({0, 0, 0}, glm::vec3(1)).mesh());
    scene.set_material(3, lambert());
    scene.set_image(5, scene::make_image("i", 1, 1, std::span<const uint8_t>(texel), true,
                                         scene::AlphaMode::kStraight));
    scene.set_instances({{7, glm::mat4(1), 0}, {8, glm::mat4(1), 0}}, {3});
    scene.take_changes();
  }

  // The changes of one edit, which must leave nothing for a second look.
  template <class F>
  scene::Changes of(F edit) {
    edit();
    const scene::Changes changes = scene.take_changes();
    EXPECT_FALSE(scene.take_changes().any());
    return changes;
  }

  struct Expected {
    std::set<Id> meshes = {}, materials = {}, material_params = {}, images = {};
    std::set<uint32_t> matrices = {}, scales = {};
    bool instances = false, lights = false, world = false;
  };
  static void expect(const scene::Changes& c, const Expected& e) {
    std::set<Id> meshes;
    for (const auto& [id, change] : c.meshes) meshes.insert(id);
    EXPECT_EQ(meshes, e.meshes);
    EXPECT_EQ(c.materials, e.materials);
    EXPECT_EQ(c.material_params, e.material_params);
    EXPECT_EQ(c.images, e.images);
    EXPECT_EQ(c.instance_matrices, e.matrices);
    EXPECT_EQ(c.instance_scales, e.scales);
    EXPECT_EQ(c.instances, e.instances);
    EXPECT_EQ(c.lights, e.lights);
    EXPECT_EQ(c.world, e.world);
  }

  static constexpr uint8_t texel[4] = {1, 2, 3, 4};
  scene::Scene scene;
};

TEST_F(SceneChanges, AMovedVertexTouchesItsMeshAlone) {
  expect(of([&] { scene.set_mesh(7, floor_at(2, 1).mesh()); }), {.meshes = {7}});
}

TEST_F(SceneChanges, AnEditedMeshTellsWhatOfItDiffers) {
  const auto change_of = [&](auto edit) { return of(edit).meshes.at(7); };
  scene::Mesh moved = floor_at(0, 1).mesh();
  moved.positions[2].z = 1;
  scene::MeshChange c = change_of([&] { scene.set_mesh(7, moved); });
  EXPECT_EQ(c.positions.runs, (std::vector<panoptes::Run>{{2, 1}}));
  EXPECT_TRUE(c.triangles.runs.empty() && c.corner_normals.runs.empty());
  EXPECT_TRUE(c.attributes.at(0).runs.empty());
  EXPECT_FALSE(c.resized() || c.corner_normals.all || c.attributes[0].all);
  scene::Mesh mapped = moved;
  mapped.attributes[0].values[7] = 0.25f;  // the second value of the fourth corner
  c = change_of([&] { scene.set_mesh(7, mapped); });
  EXPECT_EQ(c.attributes.at(0).runs, (std::vector<panoptes::Run>{{3, 1}}));
  EXPECT_TRUE(c.positions.runs.empty());
  // Two edits before a frame: what either touched.
  c = change_of([&] {
    moved.positions[0].x = 3;
    scene.set_mesh(7, moved);
    scene.set_mesh(7, mapped);
  });
  EXPECT_EQ(c.positions.runs, (std::vector<panoptes::Run>{{0, 1}}));
  EXPECT_EQ(c.attributes.at(0).runs, (std::vector<panoptes::Run>{{3, 1}}));
  // Another size, or a mesh that was away meanwhile, is all new.
  c = change_of([&] {
    scene.set_mesh(7, moved);
    scene.set_mesh(7, box({0, 0, 0}, glm::vec3(1)).mesh());
  });
  EXPECT_TRUE(c.positions.all && c.triangles.all && c.resized());
  c = change_of([&] {
    const scene::Mesh held = scene.meshes().at(7);
    scene.remove_mesh(7);
    scene.set_mesh(7, held);
  });
  EXPECT_TRUE(c.positions.all && c.triangles.all);
}

TEST_F(SceneChanges, NewRangesTouchTheDrawsToo) {
  Geometry more = floor_at(0, 1);
  more.add(floor_at(1, 1), 1);
  expect(of([&] { scene.set_mesh(7, more.mesh()); }), {.meshes = {7}, .instances = true});
}

TEST_F(SceneChanges, ANewMeshTouchesTheDraws) {
  expect(of([&] { scene.set_mesh(9, floor_at(0, 1).mesh()); }), {.meshes = {9}, .instances = true});
}

TEST_F(SceneChanges, RemovalsAreReportedOnce) {
  expect(of([&] { scene.remove_mesh(8); }), {.meshes = {8}, .instances = true});
  expect(of([&] { scene.remove_mesh(8); }), {});
  expect(of([&] { scene.remove_material(3); }), {.materials = {3}});
  expect(of([&] { scene.remove_material(3); }), {});
  expect(of([&] { scene.remove_image(5); }), {.images = {5}});
  expect(of([&] { scene.remove_image(5); }), {});
}

TEST_F(SceneChanges, AMovedObjectTouchesItsMatrixAlone) {
  const int index = 1;
  const glm::mat4 matrix(2.0f);
  expect(of([&] { scene.set_instance_matrices({&index, 1}, {&matrix, 1}); }), {.matrices = {1}});
  EXPECT_EQ(scene.instances()[1].object_to_world, matrix);
  EXPECT_EQ(scene.instances()[0].object_to_world, glm::mat4(1));
}

TEST_F(SceneChanges, AnObjectsIndirectLightTouchesItsScaleAlone) {
  const int index = 1;
  const glm::vec2 scale(0.5f, 2);
  expect(of([&] { scene.set_instance_scales({&index, 1}, {&scale, 1}); }), {.scales = {1}});
  EXPECT_EQ(scene.instances()[1].indirect_scale, scale);
  EXPECT_EQ(scene.instances()[0].indirect_scale, glm::vec2(1));
}

TEST_F(SceneChanges, NewInstancesIncludeTheirMatricesAndScales) {
  expect(of([&] {
           const int index = 0;
           const glm::mat4 matrix(2.0f);
           const glm::vec2 scale(2);
           scene.set_instance_matrices({&index, 1}, {&matrix, 1});
           scene.set_instance_scales({&index, 1}, {&scale, 1});
           scene.set_instances({{7, glm::mat4(1), 0}}, {3});
         }),
         {.instances = true});
}

TEST_F(SceneChanges, ADraggedSliderTouchesParametersAlone) {
  expect(of([&] { scene.set_material_params(3, {glm::vec4(1, 0, 0, 1)}); }),
         {.material_params = {3}});
  expect(of([&] {
           scene.set_material_params(3, {glm::vec4(1), glm::vec4(2)});
         }),
         {.materials = {3}});
}

TEST_F(SceneChanges, TheRestReportItself) {
  expect(of([&] { scene.set_material(4, lambert()); }), {.materials = {4}});
  expect(of([&] { scene.set_lights({point({0, 0, 1}, 10)}); }), {.lights = true});
  expect(of([&] { scene.set_world(constant_world(glm::vec3(1))); }), {.world = true});
  expect(of([&] {
           scene.set_image(6, scene::make_image("i", 1, 1, std::span<const uint8_t>(texel), true,
                                                scene::AlphaMode::kStraight));
         }),
         {.images = {6}});
}

TEST_F(SceneChanges, NonsenseIsRefusedAndChangesNothing) {
  const int far = 2, below = -1, first = 0;
  const glm::mat4 matrix(1.0f);
  expect_error([&] { scene.set_instance_matrices({&far, 1}, {&matrix, 1}); }, "instance 2");
  expect_error([&] { scene.set_instance_matrices({&below, 1}, {&matrix, 1}); }, "instance -1");
  expect_error([&] { scene.set_instance_matrices({&first, 1}, {}); }, "matrices");
  const glm::vec2 scale(1);
  expect_error([&] { scene.set_instance_scales({&far, 1}, {&scale, 1}); }, "instance 2");
  expect_error([&] { scene.set_instance_scales({&first, 1}, {}); }, "scales");
  for (const float bad : {-1.0f, 65505.0f, std::numeric_limits<float>::infinity(),
                          std::numeric_limits<float>::quiet_NaN()}) {
    const glm::vec2 wrong(1, bad);
    expect_error([&] { scene.set_instance_scales({&first, 1}, {&wrong, 1}); }, "scale of");
    scene::Instance instance{7, glm::mat4(1), 0};
    instance.indirect_scale = wrong;
    expect_error([&] { scene.set_instances({instance}, {3}); }, "scale of");
  }
  expect_error([&] { scene.set_material_params(99, {}); }, "material 99");
  for (Id id : {Id(0), Id(-4)}) {
    expect_error([&] { scene.set_mesh(id, {}); }, "mesh");
    expect_error([&] { scene.set_material(id, {}); }, "material");
    expect_error([&] { scene.set_image(id, {}); }, "image");
  }
  EXPECT_FALSE(scene.take_changes().any());
}

TEST_F(SceneChanges, ABrokenMatrixLeavesTheObjectOutWithAWarning) {
  glm::mat4 broken(1.0f);
  broken[3].y = kNaN;
  scene.set_instances({{7, glm::mat4(1), 0}, {8, broken, 0}}, {3});
  ASSERT_EQ(scene.instances().size(), 2u);  // indices stay as the caller counts them
  EXPECT_EQ(scene.facts().instances, 1);
  EXPECT_EQ(scene.facts().triangles, 2);
  EXPECT_EQ(scene.bounds().high, glm::vec3(1, 1, 0));
  ASSERT_EQ(scene.warnings().size(), 1u);
  EXPECT_NE(scene.warnings()[0].find("1 objects have a matrix"), std::string::npos)
      << scene.warnings()[0];
  scene.set_instances({{7, glm::mat4(1), 0}}, {3});
  EXPECT_TRUE(scene.warnings().empty());
}

TEST_F(SceneChanges, AnObjectComesBackWhenItsMatrixIsMended) {
  glm::mat4 broken(1.0f);
  broken[0].x = kNaN;
  scene.set_instances({{7, broken, 0}}, {3});
  const int index = 0;
  const glm::mat4 matrix(1.0f);
  scene.set_instance_matrices({&index, 1}, {&matrix, 1});
  EXPECT_EQ(scene.facts().instances, 1);
  EXPECT_TRUE(scene.warnings().empty());
}

TEST(SceneLights, DropsLampsThatCannotShine) {
  scene::Scene scene;
  scene::Light dark = point({0, 0, 1}, 0), black = point({0, 0, 1}, 5),
               broken = point({0, 0, 1}, 5), energy = point({0, 0, 1}, kNaN),
               color = point({0, 0, 1}, 5);
  black.color = glm::vec3(0);
  broken.object_to_world[3].x = std::numeric_limits<float>::infinity();
  color.color.g = kNaN;
  scene::Light negative = sun({0, 0, -1}, -2);
  scene.set_lights({dark, black, point({0, 0, 3}, 7), broken, energy, color, negative});
  ASSERT_EQ(scene.lights().size(), 2u);
  EXPECT_EQ(scene.lights()[0].energy, 7);
  EXPECT_EQ(scene.lights()[1].energy, -2);  // Blender allows lamps that take light away
}

TEST(SceneFacts, CountWhatInstancesUse) {
  scene::Scene scene;
  EXPECT_EQ(scene.facts().triangles, 0);
  EXPECT_FALSE(scene.facts().world);
  EXPECT_TRUE(scene.bounds().empty());

  Geometry two = floor_at(0, 1);
  two.add(floor_at(1, 1), 1);
  scene.set_mesh(1, two.mesh());
  scene.set_material(1, material(kLambert, {}, {.alpha = true, .glossy = false}));
  scene.set_material(2, material(kLambert, {}, {.emission = true, .glossy = false}));
  scene.set_material(3, material(kLambert, {},
                                 {.normal_map = true, .glossy = true, .transmission = true}));
  scene.set_instances({{1, glm::mat4(1), 0}, {1, glm::mat4(1), 0}, {99, glm::mat4(1), 0}}, {1, 2});
  scene::Facts facts = scene.facts();
  EXPECT_EQ(facts.triangles, 8);
  EXPECT_EQ(facts.instances, 2);
  EXPECT_TRUE(facts.alpha);
  EXPECT_TRUE(facts.emission);
  EXPECT_FALSE(facts.normal_map);  // no instance uses material 3
  EXPECT_FALSE(facts.glossy);
  EXPECT_FALSE(facts.transmission);

  // A slot past the table and a removed material both show the default, which is glossy.
  scene.set_instances({{1, glm::mat4(1), 1}}, {1, 2});
  EXPECT_TRUE(scene.facts().glossy);
  EXPECT_FALSE(scene.facts().alpha);
  scene.set_instances({{1, glm::mat4(1), 0}}, {3, 42});
  facts = scene.facts();
  EXPECT_TRUE(facts.normal_map);
  EXPECT_TRUE(facts.transmission);
  EXPECT_EQ(scene.material_of(scene.instances()[0], 1), 0);
}

TEST(SceneFacts, CountLampsAndTheWorld) {
  scene::Scene scene;
  scene::Light silent = area({0, 0, 1}, {0, 0, -1}, 5, scene::AreaShape::kDisk, 1, 1);
  silent.cast_shadow = false;
  scene.set_lights({point({0, 0, 1}, 5), point({0, 0, 2}, 5), sun({0, 0, -1}, 1), silent});
  scene::Facts facts = scene.facts();
  EXPECT_EQ(facts.lamp_count(), 4);
  EXPECT_EQ(facts.shadow_lamp_count(), 3);
  EXPECT_EQ(facts.lamps[int(scene::LightType::kPoint)], 2);
  EXPECT_EQ(facts.shadow_lamps[int(scene::LightType::kArea)], 0);
  EXPECT_TRUE(facts.extended_lamps);
  scene.set_lights({point({0, 0, 1}, 5), sun({0, 0, -1}, 1)});
  EXPECT_FALSE(scene.facts().extended_lamps);

  scene.set_world(constant_world(glm::vec3(0)));
  EXPECT_FALSE(scene.facts().world);
  scene.set_world(constant_world(glm::vec3(0, 0.1f, 0)));
  EXPECT_TRUE(scene.facts().world);
  scene.set_world(world("vec3 evaluate_world(vec3 d) { return vec3(0.0); }"));
  EXPECT_TRUE(scene.facts().world);  // nobody knows without asking each direction
}

}  // namespace
}  // namespace panoptes::test
