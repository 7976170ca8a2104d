// What objects' indirect light is multiplied by, on its way to the shaders.
#include "gl/context.h"
#include "gl/counters.h"
#include "gl/program.h"
#include "gpu_scene/gpu_scene.h"
#include "support.h"

#include <glm/gtc/matrix_transform.hpp>

namespace panoptes::test {
namespace {

// Reads the scales of the first instances on the GPU.
constexpr const char* kReader = R"(
#include "gpu_scene/geometry.glsl"
layout(local_size_x = 1) in;
layout(std430, binding = 0) writeonly buffer Results { vec2 results[]; };
void main() { results[gl_WorkGroupID.x] = fetch_indirect_scale(gl_WorkGroupID.x); }
)";

class IndirectScales : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { context = std::make_unique<gl::Context>(); }
  static void TearDownTestSuite() { context.reset(); }

  // Three squares of different scales; 1 is the default.
  IndirectScales() : gpu(context->device()) {
    for (int i = 0; i < 3; ++i)
      squares.add_object(floor_at(0, 1), {squares.add_material(lambert())},
                         glm::translate(glm::mat4(1.0f), glm::vec3(i, 0, 0)));
    squares.instances[0].indirect_scale = {0, 2.5f};
    squares.instances[2].indirect_scale = {scene::kMostIndirectScale, 0};
    squares.install(scene);
    gpu.update(scene);
  }

  // As shaders see them, by instance of the scene.
  std::vector<glm::vec2> read() {
    const size_t count = scene.instances().size();
    gl::ProgramSource source;
    source.name = "reader of scales";
    source.stages = {{GL_COMPUTE_SHADER, "reader.comp"}};
    source.snippets["reader.comp"] = kReader;
    programs.get(source).use();
    gpu.bind_geometry();
    const gl::Buffer results(int64_t(count * sizeof(glm::vec2)));
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, results.id());
    glDispatchCompute(GLuint(count), 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    std::vector<glm::vec2> placed(count), found(count);
    results.read(0, int64_t(count * sizeof(glm::vec2)), placed.data());
    EXPECT_NO_THROW(gl::check_errors("scales"));
    for (size_t i = 0; i < count; ++i) found[i] = placed[gpu.place_of(i)];
    return found;
  }

  static inline std::unique_ptr<gl::Context> context;
  TestScene squares;
  scene::Scene scene;
  gpu_scene::GpuScene gpu;
  gl::ProgramCache programs;
};

TEST_F(IndirectScales, ReachShaders) {
  EXPECT_EQ(read(), (std::vector<glm::vec2>{{0, 2.5f}, {1, 1}, {scene::kMostIndirectScale, 0}}));
}

TEST_F(IndirectScales, AreAsExactAsHalfPrecision) {
  const int index = 1;
  for (const float value : {0.001f, 0.1f, 0.7f, 1 / 3.0f, 123.4f}) {
    const glm::vec2 scale(value, 1);
    scene.set_instance_scales({&index, 1}, {&scale, 1});
    gpu.update(scene);
    EXPECT_NEAR(read()[1].x, value, value * 0x1p-11f);
  }
}

TEST_F(IndirectScales, AreAnEditOfTheirRecordAlone) {
  const int64_t revisions[] = {gpu.geometry_revision(), gpu.shadow_revision(), gpu.emission_revision(),
                               gpu.world_revision()};
  const int64_t bytes = gl::counters().uploaded_bytes;
  const int index = 1;
  const glm::vec2 scale(0.5f, 0.25f);
  scene.set_instance_scales({&index, 1}, {&scale, 1});
  gpu.update(scene);
  EXPECT_EQ(gl::counters().uploaded_bytes - bytes, 4);
  EXPECT_EQ(gpu.geometry_revision(), revisions[0]);
  EXPECT_EQ(gpu.shadow_revision(), revisions[1]);
  EXPECT_EQ(gpu.emission_revision(), revisions[2]);
  EXPECT_EQ(gpu.world_revision(), revisions[3]);
  EXPECT_EQ(read()[1], scale);
}

TEST_F(IndirectScales, SurviveMoves) {
  const int index = 2;
  const glm::mat4 matrix(2.0f);
  const glm::vec2 scale(3, 4);
  scene.set_instance_scales({&index, 1}, {&scale, 1});
  scene.set_instance_matrices({&index, 1}, {&matrix, 1});
  gpu.update(scene);
  EXPECT_EQ(read()[2], scale);
  // A list with one instance less and one scale changed.
  std::vector<scene::Instance> fewer(scene.instances().begin() + 1, scene.instances().end());
  fewer[0].indirect_scale = {7, 8};
  scene.set_instances(fewer, scene.material_table());
  gpu.update(scene);
  EXPECT_EQ(read(), (std::vector<glm::vec2>{{7, 8}, {3, 4}}));
}

}  // namespace
}  // namespace panoptes::test
