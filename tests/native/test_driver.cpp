// The command-line driver: a snapshot becomes a picture, and mistakes become one sentence.
#include "engine/snapshot.h"
#include "json.h"
#include "still_life.h"
#include "support.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace panoptes::test {
namespace {

namespace fs = std::filesystem;

class Driver : public ::testing::Test {
 protected:
  Driver() {
    folder = fs::temp_directory_path() / fmt::format("panoptes_driver_{}", getpid());
    fs::create_directories(folder);
    const StillLife life = still_life();
    scene::Scene scene;
    life.scene.install(scene);
    request = test::request(life.camera, {}, 2);
    engine::write_snapshot(file("life.scene"), scene, request);
  }
  ~Driver() override { fs::remove_all(folder); }

  std::string file(const std::string& name) const { return (folder / name).string(); }
  std::string content(const std::string& name) const {
    std::ifstream stream(file(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  // Runs the driver; its output goes to the files "out" and "err". The exit status.
  int run(const std::string& arguments) const {
    const int status = std::system(
        fmt::format("cd '{}' && '{}' {} >out 2>err", folder.string(), PANOPTES_DRIVER, arguments)
            .c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  void expect_refused(const std::string& arguments, const std::string& part) const {
    EXPECT_EQ(run(arguments), 1) << arguments;
    const std::string error = content("err");
    EXPECT_NE(error.find(part), std::string::npos) << arguments << ": " << error;
    // One sentence, and the last line.
    const size_t mine = error.find("panoptes_driver: ");
    ASSERT_NE(mine, std::string::npos) << error;
    EXPECT_EQ(error.find('\n', mine), error.size() - 1) << error;
  }

  fs::path folder;
  engine::RenderRequest request;
};

TEST_F(Driver, RendersASnapshot) {
  ASSERT_EQ(run("life.scene -o out.pfm --stats stats.json"), 0) << content("err");
  const Json stats = parse_json(content("stats.json"));
  EXPECT_EQ(stats.at("samples").number, 2);
  EXPECT_EQ(stats.at("size").list.at(0).number, 48);

  const Picture due = render(still_life().scene, request);
  const std::string pfm = content("out.pfm"), head = "PF\n48 48\n-1.0\n";
  ASSERT_EQ(pfm.size(), head.size() + 48 * 48 * 12);
  EXPECT_EQ(pfm.substr(0, head.size()), head);
  for (size_t i = 0; i < 48 * 48; ++i)
    for (size_t c = 0; c < 3; ++c) {
      float value;
      std::memcpy(&value, &pfm[head.size() + (3 * i + c) * 4], 4);
      ASSERT_EQ(value, due[film::Pass::kCombined][4 * i + c]);
    }
}

TEST_F(Driver, TakesAnotherSizeAndSampleCount) {
  ASSERT_EQ(run("life.scene -o out.pfm --size 20x10 --samples 3 --stats stats.json --repeat 2"), 0)
      << content("err");
  const Json stats = parse_json(content("stats.json"));
  EXPECT_EQ(stats.at("samples").number, 3);
  EXPECT_EQ(stats.at("size").list.at(1).number, 10);
  EXPECT_EQ(content("out.pfm").find("PF\n20 10\n"), 0u);
}

TEST_F(Driver, ShowsRaysAtWork) {
  ASSERT_EQ(run("life.scene -o steps.pfm --debug steps --stats stats.json"), 0) << content("err");
  EXPECT_EQ(parse_json(content("stats.json")).at("rays").number, 2 * 48 * 48);
  ASSERT_EQ(run("life.scene -o tests.pfm --debug tests"), 0) << content("err");
  EXPECT_EQ(content("steps.pfm").size(), content("tests.pfm").size());
  EXPECT_NE(content("steps.pfm"), content("tests.pfm"));
}

TEST_F(Driver, ExplainsItself) {
  EXPECT_EQ(run("--help"), 0);
  EXPECT_EQ(content("out").find("usage: "), 0u);
}

TEST_F(Driver, MistakesAreOneSentence) {
  expect_refused("", "no scene was given");
  expect_refused("missing.scene", "'missing.scene' cannot be opened");
  expect_refused(".", "snapshot");
  expect_refused("life.scene other.scene", "more than one scene");
  expect_refused("life.scene --sizes 3x3", "--sizes");
  expect_refused("life.scene --size", "--size");
  for (const char* size : {"12", "0x4", "-3x4", "4x", "axb", "4x4x4", "99999999999x2"})
    expect_refused(fmt::format("life.scene --size {}", size), "--size");
  for (const char* samples : {"0", "-1", "1.5", "many", "99999999999"})
    expect_refused(fmt::format("life.scene --samples {}", samples), "--samples");
  expect_refused("life.scene --size 100000x2", "100000x2");
  expect_refused("life.scene --structure tree", "auto, orthographic, cube, lists, bvh");
  expect_refused("life.scene --debug everything", "none, steps, tests, lists, tiles");
  std::ofstream(file("text")) << "no snapshot at all, but long enough for a head";
  expect_refused("text", "no Panoptes snapshot");
}

TEST_F(Driver, PicturesThatCannotBeWrittenAreAnError) {
  expect_refused("life.scene -o missing/out.pfm", "'missing/out.pfm' cannot be written");
  EXPECT_FALSE(fs::exists(folder / "missing"));
}

}  // namespace
}  // namespace panoptes::test
