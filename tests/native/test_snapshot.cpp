// Snapshots: what is written is read again, and no file, however broken, does harm.
#include "base/error.h"
#include "engine/snapshot.h"
#include "support.h"

#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

namespace panoptes::test {
namespace {

namespace fs = std::filesystem;

class Snapshot : public ::testing::Test {
 protected:
  Snapshot() {
    folder = fs::temp_directory_path() / fmt::format("panoptes_snapshot_{}", getpid());
    fs::create_directories(folder);
    path = (folder / "a.scene").string();

    Geometry g = floor_at(0, 1);
    g.add(floor_at(1, 2), 1);
    g.color.assign(32, 0.5f);
    setup.add_material(alpha_card({1, 0.5f, 0.25f, 0.5f}));
    setup.add_material(lambert({0.1f, 0.2f, 0.3f}));
    const uint8_t bytes[8] = {1, 2, 3, 4, 5, 6, 7, 8};
    const float floats[4] = {0.5f, 2, 3, 1};
    const Id a = setup.add_image(scene::make_image("a", 2, 1, std::span<const uint8_t>(bytes), true,
                                                   scene::AlphaMode::kNone));
    setup.add_image(scene::make_image("b", 1, 1, std::span<const float>(floats), false,
                                      scene::AlphaMode::kPremultiplied));
    setup.materials[0].textures = {{a, true, scene::TextureUse::Extension::kClip}};
    setup.materials[0].attributes = {"uv", "color"};
    setup.add_object(g, {1, 2}, glm::mat4(3.0f));
    setup.instances[0].visibility = shared::SEEN_BY_SHADOW;
    setup.lights = {sun({0, 0, -1}, 3),
                    area({0, 0, 1}, {0, 0, -1}, 5, scene::AreaShape::kEllipse, 2, 3)};
    setup.lights[1].cast_shadow = false;
    setup.world = world("vec3 evaluate_world(vec3 d) { return abs(d); }", {glm::vec4(4)});
    setup.install(scene);
    scene.set_mesh(1LL << 40, floor_at(2, 1).mesh("far id"));

    request = test::request(perspective({1, 2, 3}, {0, 0, 0}, 0.7, 31, 17),
                            {film::Pass::kDepth, film::Pass::kEmit}, 9);
    request.first_sample = 4;
    request.seed = 77;
    request.exposure = 1.5f;
    request.filter_width = 0.75f;
    request.soft_shadows = false;
    request.transparent_film = true;
    request.time_budget = 2.5;
    request.noise_threshold = 0.125;
    request.force_all_effects = true;
    request.debug_picture = ray_picture::Kind::kLists;
    request.structure = {engine::Structure::kCube, 64, 3};
  }
  ~Snapshot() override { fs::remove_all(folder); }

  std::string content() const {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void rewrite(const std::string& bytes) const {
    std::ofstream(path, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
  }

  fs::path folder;
  std::string path;
  TestScene setup;
  scene::Scene scene;
  engine::RenderRequest request;
};

TEST_F(Snapshot, GivesTheSameSceneAndRequestBack) {
  engine::write_snapshot(path, scene, request);
  scene::Scene again;
  const engine::RenderRequest r = engine::read_snapshot(path, again);

  ASSERT_EQ(again.meshes().size(), scene.meshes().size());
  for (const auto& [id, mesh] : scene.meshes()) {
    const scene::Mesh& m = again.meshes().at(id);
    EXPECT_EQ(m.name, mesh.name);
    EXPECT_EQ(m.positions, mesh.positions);
    EXPECT_EQ(m.triangles, mesh.triangles);
    EXPECT_EQ(m.corner_normals, mesh.corner_normals);
    EXPECT_EQ(m.bounds.low, mesh.bounds.low);
    EXPECT_EQ(m.bounds.high, mesh.bounds.high);
    EXPECT_EQ(m.default_uv, mesh.default_uv);
    EXPECT_EQ(m.default_color, mesh.default_color);
    EXPECT_EQ(m.warning, mesh.warning);
    ASSERT_EQ(m.ranges.size(), mesh.ranges.size());
    for (size_t i = 0; i < m.ranges.size(); ++i) {
      EXPECT_EQ(m.ranges[i].slot, mesh.ranges[i].slot);
      EXPECT_EQ(m.ranges[i].first, mesh.ranges[i].first);
      EXPECT_EQ(m.ranges[i].count, mesh.ranges[i].count);
    }
    ASSERT_EQ(m.attributes.size(), mesh.attributes.size());
    for (size_t i = 0; i < m.attributes.size(); ++i) {
      EXPECT_EQ(m.attributes[i].name, mesh.attributes[i].name);
      EXPECT_EQ(m.attributes[i].channels, mesh.attributes[i].channels);
      EXPECT_EQ(m.attributes[i].values, mesh.attributes[i].values);
    }
  }
  ASSERT_EQ(again.images().size(), 2u);
  for (const auto& [id, image] : scene.images()) {
    const scene::Image& i = again.images().at(id);
    EXPECT_EQ(i.name, image.name);
    EXPECT_EQ(i.width, image.width);
    EXPECT_EQ(i.height, image.height);
    EXPECT_EQ(i.srgb, image.srgb);
    EXPECT_EQ(i.type, image.type);
    EXPECT_EQ(i.channels, image.channels);
    ASSERT_EQ(i.levels.size(), image.levels.size());
    for (size_t level = 0; level < i.levels.size(); ++level) {
      const size_t bytes = size_t(i.levels[level].width) * size_t(i.levels[level].height) *
                           i.texel_bytes();
      EXPECT_EQ(std::memcmp(i.levels[level].pixels.get(), image.levels[level].pixels.get(), bytes),
                0);
    }
  }
  ASSERT_EQ(again.materials().size(), 2u);
  for (const auto& [id, material] : scene.materials()) {
    const scene::Material& m = again.materials().at(id);
    EXPECT_EQ(m.name, material.name);
    EXPECT_EQ(m.code, material.code);
    EXPECT_EQ(m.params, material.params);
    EXPECT_EQ(m.attributes, material.attributes);
    EXPECT_EQ(m.facts.alpha, material.facts.alpha);
    EXPECT_EQ(m.facts.glossy, material.facts.glossy);
    ASSERT_EQ(m.textures.size(), material.textures.size());
    for (size_t i = 0; i < m.textures.size(); ++i) {
      EXPECT_EQ(m.textures[i].image, material.textures[i].image);
      EXPECT_EQ(m.textures[i].closest, material.textures[i].closest);
      EXPECT_EQ(m.textures[i].extension, material.textures[i].extension);
    }
  }
  ASSERT_EQ(again.instances().size(), 1u);
  EXPECT_EQ(again.instances()[0].object_to_world, scene.instances()[0].object_to_world);
  EXPECT_EQ(again.instances()[0].mesh, scene.instances()[0].mesh);
  EXPECT_EQ(again.instances()[0].visibility, shared::SEEN_BY_SHADOW);
  EXPECT_EQ(again.material_table(), scene.material_table());
  ASSERT_EQ(again.lights().size(), 2u);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(again.lights()[i].type, scene.lights()[i].type);
    EXPECT_EQ(again.lights()[i].object_to_world, scene.lights()[i].object_to_world);
    EXPECT_EQ(again.lights()[i].energy, scene.lights()[i].energy);
    EXPECT_EQ(again.lights()[i].shape, scene.lights()[i].shape);
    EXPECT_EQ(again.lights()[i].size_y, scene.lights()[i].size_y);
    EXPECT_EQ(again.lights()[i].cast_shadow, scene.lights()[i].cast_shadow);
  }
  EXPECT_EQ(again.world().code, scene.world().code);
  EXPECT_EQ(again.world().params, scene.world().params);
  EXPECT_FALSE(again.world().constant);

  EXPECT_EQ(r.camera.world_to_camera, request.camera.world_to_camera);
  EXPECT_EQ(r.camera.projection, request.camera.projection);
  EXPECT_EQ(r.camera.width, 31);
  EXPECT_EQ(r.camera.height, 17);
  EXPECT_EQ(r.first_sample, 4u);
  EXPECT_EQ(r.last_sample, 9u);
  EXPECT_EQ(r.seed, 77u);
  EXPECT_EQ(r.passes, request.passes);
  EXPECT_EQ(r.filter_width, 0.75f);
  EXPECT_EQ(r.exposure, 1.5f);
  EXPECT_TRUE(r.force_all_effects);
  EXPECT_FALSE(r.soft_shadows);
  EXPECT_TRUE(r.transparent_film);
  EXPECT_EQ(r.shadow_resolution, request.shadow_resolution);
  EXPECT_EQ(r.debug_picture, request.debug_picture);
  EXPECT_EQ(r.structure, request.structure);
  EXPECT_EQ(r.time_budget, 2.5);
  EXPECT_EQ(r.noise_threshold, 0.125);
  EXPECT_FALSE(fs::exists(path + ".part"));
}

TEST_F(Snapshot, IsTheSameFileForTheSameScene) {
  engine::write_snapshot(path, scene, request);
  const std::string first = content();
  scene::Scene again;
  const engine::RenderRequest r = engine::read_snapshot(path, again);
  engine::write_snapshot(path, again, r);
  EXPECT_EQ(content(), first);
}

TEST_F(Snapshot, AnEmptySceneIsAScene) {
  engine::write_snapshot(path, {}, request);
  scene::Scene again;
  engine::read_snapshot(path, again);
  EXPECT_TRUE(again.meshes().empty());
  EXPECT_TRUE(again.world().black());
}

TEST_F(Snapshot, CutOffAnywhereIsAnError) {
  engine::write_snapshot(path, scene, request);
  const std::string whole = content();
  ASSERT_GT(whole.size(), 1000u);
  // Every length around the head and the tail, a sample of those between.
  for (size_t length = 0; length < whole.size();
       length += length < 64 || length + 32 > whole.size() ? 1 : 17) {
    rewrite(whole.substr(0, length));
    scene::Scene again;
    ASSERT_THROW(engine::read_snapshot(path, again), Error) << "cut at " << length;
    ASSERT_TRUE(again.meshes().empty()) << "a broken file left half a scene";
  }
}

TEST_F(Snapshot, DamagedSizesAreErrorsAndNeverHugeAllocations) {
  engine::write_snapshot(path, scene, request);
  const std::string whole = content();
  std::mt19937 random(6);
  int refused = 0;
  for (int i = 0; i < 250; ++i) {
    std::string bytes = whole;
    const size_t at = 8 + random() % (bytes.size() - 16);
    const uint64_t value = random() % 3 ? ~uint64_t(0) >> (random() % 40) : random();
    std::memcpy(&bytes[at], &value, sizeof value);
    rewrite(bytes);
    scene::Scene again;
    try {
      engine::read_snapshot(path, again);
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 5);
}

TEST_F(Snapshot, OtherFilesAreRefused) {
  engine::write_snapshot(path, scene, request);
  const std::string whole = content();
  std::string magic = whole, version = whole;
  magic[0] = 'X';
  ++version[4];
  rewrite(magic);
  expect_error([&] { engine::read_snapshot(path, scene); }, "no Panoptes snapshot");
  rewrite(version);
  expect_error([&] { engine::read_snapshot(path, scene); }, "version");
  rewrite("");
  expect_error([&] { engine::read_snapshot(path, scene); }, "cut off");
  expect_error([&] { engine::read_snapshot((folder / "none").string(), scene); },
               "cannot be opened");
  expect_error([&] { engine::read_snapshot(folder.string(), scene); }, "snapshot");
}

TEST_F(Snapshot, AWriteThatFailsLeavesNoFile) {
  const fs::path missing = folder / "missing" / "a.scene";
  expect_error([&] { engine::write_snapshot(missing.string(), scene, request); },
               "cannot be written");
  EXPECT_FALSE(fs::exists(folder / "missing"));

  const fs::path taken = folder / "folder";
  fs::create_directories(taken / "inside");
  expect_error([&] { engine::write_snapshot(taken.string(), scene, request); },
               "cannot be written");
  EXPECT_TRUE(fs::is_directory(taken / "inside"));
  EXPECT_FALSE(fs::exists(taken.string() + ".part"));

  // A full disk: the write itself fails.
  if (fs::exists("/dev/full")) {
    fs::create_symlink("/dev/full", folder / "b.scene.part");
    expect_error([&] { engine::write_snapshot((folder / "b.scene").string(), scene, request); },
                 "cannot be written");
    EXPECT_FALSE(fs::exists(folder / "b.scene"));
  }
}

TEST_F(Snapshot, AFailedWriteKeepsTheOldFile) {
  engine::write_snapshot(path, scene, request);
  const std::string before = content();
  fs::create_directories(path + ".part/in the way");
  EXPECT_THROW(engine::write_snapshot(path, scene, request), Error);
  EXPECT_EQ(content(), before);
}

}  // namespace
}  // namespace panoptes::test
