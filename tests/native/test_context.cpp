// The GL layer by itself, in a context of its own.
#include "base/error.h"
#include "gl/context.h"
#include "gl/counters.h"
#include "gl/handles.h"
#include "gl/pass_timer.h"
#include "gl/program.h"
#include "support.h"

#include <chrono>

namespace panoptes::test {
namespace {

class Context : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { context = std::make_unique<gl::Context>(); }
  static void TearDownTestSuite() { context.reset(); }
  void TearDown() override { EXPECT_NO_THROW(gl::check_errors("the test")); }

  static inline std::unique_ptr<gl::Context> context;
};

gl::ProgramSource compute(const std::string& body) {
  gl::ProgramSource source;
  source.name = "a test";
  source.stages = {{GL_COMPUTE_SHADER, "test/main.comp"}};
  source.snippets["test/main.comp"] = body;
  return source;
}

constexpr const char* kFill =
    "layout(local_size_x = 64) in;\n"
    "layout(std430, binding = 0) buffer Values { uint values[]; };\n"
    "void main() { values[gl_GlobalInvocationID.x] = FACTOR * gl_GlobalInvocationID.x; }\n";

TEST_F(Context, SaysWhatItRunsOnAndMeetsTheLimits) {
  const gl::DeviceInfo& device = context->device();
  EXPECT_FALSE(device.renderer.empty());
  EXPECT_FALSE(device.vendor.empty());
  EXPECT_EQ(device.version.find("4."), 0u) << device.version;
  EXPECT_GE(device.max_texture_size, 8192);
  EXPECT_GE(device.max_array_layers, 256);
  EXPECT_GE(device.max_texture_buffer_texels, 1 << 26);
  EXPECT_GE(device.max_texture_units, 16);
  EXPECT_EQ(device.software, device.renderer.find("llvmpipe") != std::string::npos);
}

TEST_F(Context, BuffersHoldWhatIsWritten) {
  const std::vector<uint32_t> values{1, 2, 3, 4, 5, 6, 7, 8};
  gl::Buffer buffer{std::span<const uint32_t>(values)};
  const uint32_t nine = 9;
  buffer.write(8, 4, &nine);
  std::vector<uint32_t> read(8);
  buffer.read(0, 32, read.data());
  EXPECT_EQ(read, (std::vector<uint32_t>{1, 2, 9, 4, 5, 6, 7, 8}));
  buffer.clear();
  buffer.read(0, 32, read.data());
  EXPECT_EQ(read, std::vector<uint32_t>(8, 0));
  // Shorter than the least allocation: data still arrives.
  gl::Buffer small(4, &nine);
  EXPECT_EQ(small.bytes(), 16);
  small.read(0, 4, read.data());
  EXPECT_EQ(read[0], 9u);
}

TEST_F(Context, CountersReturnWhenObjectsDie) {
  gl::Counters& c = gl::counters();
  const int64_t buffers = c.buffers, textures = c.textures, memory = c.memory_bytes;
  {
    gl::Buffer a(1000), b(2000);
    gl::Texture flat({GL_TEXTURE_2D, GL_RGBA16F, 10, 20, 1, 1}),
        layered({GL_TEXTURE_2D_ARRAY, GL_RGBA32F, 8, 8, 3, 1}), buffer_view(GL_R32UI, a);
    gl::Framebuffer framebuffer = gl::Framebuffer::make();
    gl::VertexArray array = gl::VertexArray::make();
    gl::Sampler sampler{gl::SamplerOptions{}};
    EXPECT_EQ(c.buffers, buffers + 2);
    EXPECT_EQ(c.textures, textures + 3);
    EXPECT_EQ(c.memory_bytes, memory + 3000 + 10 * 20 * 8 + 8 * 8 * 3 * 16);

    // Moving neither copies nor loses an object.
    gl::Buffer moved(std::move(a));
    gl::Texture target;
    target = std::move(flat);
    EXPECT_FALSE(a);
    EXPECT_TRUE(moved && target);
    EXPECT_EQ(target.options().width, 10);
    EXPECT_EQ(c.buffers, buffers + 2);
    EXPECT_EQ(c.textures, textures + 3);

    // Overwriting deletes what was there, at the latest when the other side dies.
    { b = gl::Buffer(500); }
    EXPECT_EQ(c.buffers, buffers + 2);
    EXPECT_EQ(c.memory_bytes, memory + 1000 + 500 + 10 * 20 * 8 + 8 * 8 * 3 * 16);
  }
  EXPECT_EQ(c.buffers, buffers);
  EXPECT_EQ(c.textures, textures);
  EXPECT_EQ(c.memory_bytes, memory);
  EXPECT_GE(c.peak_bytes, memory + 3000);
}

TEST_F(Context, CountersCountTransfers) {
  gl::Counters& c = gl::counters();
  gl::Buffer buffer(64);
  const int64_t uploads = c.uploads, bytes = c.uploaded_bytes;
  const float data[4] = {};
  buffer.write(0, 16, data);
  buffer.write(0, 0, data);  // nothing to send
  EXPECT_EQ(c.uploads, uploads + 1);
  EXPECT_EQ(c.uploaded_bytes, bytes + 16);
}

TEST_F(Context, AllocationsThatCannotBeAreSentences) {
  const int64_t memory = gl::counters().memory_bytes, buffers = gl::counters().buffers;
  expect_error(
      [] {
        gl::Texture({GL_TEXTURE_2D, GL_RGBA8, 1 << 20, 4, 1, 1});
      },
      "could not allocate");
  EXPECT_EQ(gl::counters().memory_bytes, memory);
  EXPECT_EQ(gl::counters().buffers, buffers);
}

TEST_F(Context, ProgramsRunWithTheirDefines) {
  gl::ProgramSource source = compute(kFill);
  source.defines = {"FACTOR 3u"};
  const gl::Program program(source);
  gl::Buffer values(256);
  program.use();
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, values.id());
  glDispatchCompute(1, 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  std::vector<uint32_t> read(64);
  values.read(0, 256, read.data());
  for (uint32_t i = 0; i < 64; ++i) EXPECT_EQ(read[i], 3 * i);
}

TEST_F(Context, ACompileErrorNamesFileAndLine) {
  gl::ProgramSource source = compute("// one\n#include \"test/part.glsl\"\nlayout(local_size_x = "
                                     "1) in;\nvoid main() { part(); }\n");
  source.snippets["test/part.glsl"] = "// one\n// two\nvoid part() { undeclared = 1; }\n";
  expect_error([&] { gl::Program program(source); }, "test/part.glsl:3");
  expect_error([&] { gl::Program program(source); }, "'a test'");
  source.snippets["test/part.glsl"] = "// fine\nvoid part() {}\n";
  source.snippets["test/main.comp"] =
      "#include \"test/part.glsl\"\n\nlayout(local_size_x = 1) in;\nvoid main() { int x = 1.5; }\n";
  expect_error([&] { gl::Program program(source); }, "test/main.comp:4");
}

TEST_F(Context, ALinkErrorIsASentence) {
  gl::ProgramSource source;
  source.name = "a torn pair";
  source.stages = {{GL_VERTEX_SHADER, "a.vert"}, {GL_FRAGMENT_SHADER, "a.frag"}};
  source.snippets["a.vert"] = "out vec4 left;\nvoid main() { left = gl_Position = vec4(0); }\n";
  source.snippets["a.frag"] =
      "in vec3 left;\nlayout(location = 0) out vec4 o;\nvoid main() { o = vec4(left, 1); }\n";
  const int64_t programs = gl::counters().programs;
  expect_error([&] { gl::Program program(source); }, "'a torn pair'");
  EXPECT_EQ(gl::counters().programs, programs);
}

TEST_F(Context, TheCacheCompilesEachProgramOnce) {
  gl::ProgramCache cache;
  gl::ProgramSource source = compute(kFill);
  source.defines = {"FACTOR 1u"};
  const int64_t programs = gl::counters().programs;
  const gl::Program& first = cache.get(source);
  source.name = "another name";
  EXPECT_EQ(&cache.get(source), &first);
  EXPECT_EQ(gl::counters().programs, programs + 1);
  source.defines = {"FACTOR 2u"};
  EXPECT_NE(&cache.get(source), &first);
  EXPECT_EQ(gl::counters().programs, programs + 2);
  EXPECT_TRUE(first);  // the reference still holds
}

TEST_F(Context, CheckErrorsNamesThePassAndClearsTheError) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 100000, 0);
  glEnable(0xbad);
  expect_error([] { gl::check_errors("the pass"); }, "'the pass'");
  EXPECT_NO_THROW(gl::check_errors("later"));
}

// A pass that keeps the device busy for a while, and a program that ends at once.
class Busy {
 public:
  Busy()
      : program_(compute("layout(local_size_x = 64) in;\n"
                         "layout(std430, binding = 0) buffer Values { float values[]; };\n"
                         "layout(location = 0) uniform int rounds;\n"
                         "void main() {\n"
                         "  float x = float(gl_GlobalInvocationID.x);\n"
                         "  for (int i = 0; i < rounds; ++i) x = sin(x) * 1.5 + cos(x);\n"
                         "  values[gl_GlobalInvocationID.x] = x;\n"
                         "}\n")),
        values_(64 * 256 * 4) {}
  void run(int rounds) const {
    program_.use();
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, values_.id());
    glUniform1i(0, rounds);
    glDispatchCompute(256, 1, 1);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
  }

 private:
  gl::Program program_;
  gl::Buffer values_;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST_F(Context, PassTimesAreThoseOfTheWallClock) {
  const Busy busy;
  busy.run(1);
  glFinish();
  gl::PassTimer timer(context->device());
  int rounds = 500;
  for (; rounds < 60000; rounds *= 2) {  // until a pass takes 60 ms on this device
    const auto start = std::chrono::steady_clock::now();
    busy.run(rounds);
    glFinish();
    if (seconds_since(start) > 0.06) break;
  }
  const auto start = std::chrono::steady_clock::now();
  {
    gl::PassScope scope(timer, "heavy");
    busy.run(rounds);
  }
  {
    gl::PassScope scope(timer, "light");
    busy.run(1);
  }
  glFinish();
  const double wall = seconds_since(start) * 1000;
  const std::vector<gl::PassTime> times = timer.times();
  ASSERT_EQ(times.size(), 2u);
  EXPECT_EQ(times[0].name, "heavy");
  EXPECT_GT(times[0].ms, 0.8 * wall);
  EXPECT_LT(times[0].ms, 1.01 * wall);
  EXPECT_LT(times[1].ms, 0.5 * times[0].ms);
}

TEST_F(Context, PassTimesOfOneNameAddUp) {
  const Busy busy;
  gl::PassTimer timer(context->device());
  const auto run = [&](const char* name) {
    gl::PassScope scope(timer, name);
    busy.run(2000);
  };
  run("a");
  const double once = timer.times().at(0).ms;
  run("b");
  for (int i = 0; i < 8; ++i) run("a");
  const std::vector<gl::PassTime> times = timer.times();
  ASSERT_EQ(times.size(), 2u);
  EXPECT_EQ(times[0].name, "a");
  EXPECT_GT(times[0].ms, once);
  EXPECT_GT(times[0].ms, 2 * times[1].ms);
  timer.reset();
  EXPECT_TRUE(timer.times().empty());
}

}  // namespace
}  // namespace panoptes::test
