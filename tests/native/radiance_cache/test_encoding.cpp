// Spherical harmonics and the encodings of the radiance cache, against quadrature.
#include "gl/context.h"
#include "gl/program.h"
#include "radiance_cache/radiance_cache.h"
#include "support.h"

#include <cmath>
#include <memory>
#include <random>

namespace panoptes::test {
namespace {

using radiance_cache::Encoding;

// Directions spread over the sphere and what each stands for.
struct Quadrature {
  static constexpr int kRows = 64, kColumns = 128;
  std::vector<glm::vec4> points;  // w: solid angle
  Quadrature() {
    for (int y = 0; y < kRows; ++y)
      for (int x = 0; x < kColumns; ++x) {
        const double theta = (y + 0.5) / kRows * kPi, phi = (x + 0.5) / kColumns * 2 * kPi;
        const double band = kPi / kRows;
        points.emplace_back(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta),
                            2 * kPi / kColumns * 2 * std::sin(theta) * std::sin(band / 2));
      }
  }
};

class CacheEncoding : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { context = std::make_unique<gl::Context>(); }
  static void TearDownTestSuite() { context.reset(); }

  // What `vec4 lab(uint i)` of `body` gives for each input.
  std::vector<glm::vec4> run(Encoding encoding, const std::string& body, std::vector<glm::vec4> inputs,
                             int count) {
    gl::ProgramSource source;
    source.name = "encoding lab";
    source.stages = {{GL_COMPUTE_SHADER, "lab/main.comp"}};
    source.snippets = {{"lab/main.comp", R"(
#include "radiance_cache/cells.glsl"
#include "radiance_cache/encoding.glsl"
#include "base/packing.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Inputs { vec4 inputs[]; };
layout(std430, binding = 1) writeonly buffer Results { vec4 results[]; };
#include "lab/body.glsl"
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < results.length()) results[i] = lab(i);
}
)"},
                       {"lab/body.glsl", body}};
    radiance_cache::LookUpOptions{encoding}.add_defines(source);
    const gl::Buffer in(int64_t(inputs.size()) * 16, inputs.data());
    const gl::Buffer out(int64_t(count) * 16);
    programs.get(source).use();
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, in.id());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, out.id());
    glDispatchCompute(GLuint(count + 63) / 64, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    std::vector<glm::vec4> results(size_t(count), glm::vec4(0));
    out.read(0, out.bytes(), results.data());
    EXPECT_NO_THROW(gl::check_errors("encoding lab"));
    return results;
  }

  static inline std::unique_ptr<gl::Context> context;
  gl::ProgramCache programs;
};

// Radiance that nine harmonics hold: (1 + d.x) (1 + .5 d.z) by colours that vary with direction.
glm::dvec3 radiance(const glm::dvec3& d) {
  return {2 + d.x + d.y * d.z, 1 + 0.5 * d.z, 0.7 + 0.6 * d.x * d.x - 0.3 * d.y};
}

// The same in GLSL, projected onto harmonics by the inputs' directions and encoded.
constexpr const char* kEncoded = R"(
vec3 radiance(vec3 d) { return vec3(2.0 + d.x + d.y * d.z, 1.0 + 0.5 * d.z, 0.7 + 0.6 * d.x * d.x - 0.3 * d.y); }
vec4[CELL_TEXELS] encoded() {
  vec3 sums[9];
  for (int k = 0; k < 9; ++k) sums[k] = vec3(0.0);
  for (int i = 0; i < inputs.length(); ++i) {
    float basis[9] = spherical_harmonics(inputs[i].xyz);
    for (int k = 0; k < 9; ++k) sums[k] += radiance(inputs[i].xyz) * basis[k] * inputs[i].w;
  }
  return encode(sums, 7.0);
}
)";

TEST_F(CacheEncoding, HarmonicsAreOrthonormal) {
  const Quadrature quadrature;
  const auto products = run(Encoding::kRgb3, R"(
vec4 lab(uint i) {
  float sum = 0.0;
  for (int k = 0; k < inputs.length(); ++k) {
    float basis[9] = spherical_harmonics(inputs[k].xyz);
    sum += basis[i / 9u] * basis[i % 9u] * inputs[k].w;
  }
  return vec4(sum);
}
)", quadrature.points, 81);
  for (int i = 0; i < 81; ++i)
    EXPECT_NEAR(products[size_t(i)].x, i / 9 == i % 9 ? 1 : 0, 1e-3) << i / 9 << ", " << i % 9;
}

TEST_F(CacheEncoding, AllTermsOfThreeColoursGiveRadianceAndIrradianceBack) {
  const Quadrature quadrature;
  for (Encoding encoding : {Encoding::kRgb3, Encoding::kY3Co3Cg3}) {
    const auto results = run(encoding, std::string(kEncoded) + R"(
vec4 lab(uint i) {
  vec3 bands = i % 2u == 0u ? vec3(1.0) : DIFFUSE_BANDS;
  return vec4(decode(encoded(), banded_harmonics(inputs[(i / 2u) * 777u].xyz, bands)), 0.0);
}
)", quadrature.points, 20);
    for (int i = 0; i < 20; ++i) {
      const glm::dvec3 axis(quadrature.points[size_t(i / 2) * 777]);
      glm::dvec3 expected = radiance(axis);
      if (i % 2) {
        expected = glm::dvec3(0);
        for (const glm::vec4& point : quadrature.points)
          expected += radiance(glm::dvec3(point)) * std::max(glm::dot(axis, glm::dvec3(point)), 0.0) *
                      double(point.w) / kPi;
      }
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(results[size_t(i)][c], expected[c], 0.003 * expected[c] + 1e-3) << int(encoding) << " " << i;
    }
  }
}

TEST_F(CacheEncoding, FewerTermsOfChrominanceKeepLuminance) {
  const Quadrature quadrature;
  for (Encoding encoding : {Encoding::kY3Co1Cg1, Encoding::kY3Co2Cg2}) {
    const auto results = run(encoding, std::string(kEncoded) + R"(
vec4 lab(uint i) { return vec4(decode(encoded(), banded_harmonics(inputs[i * 777u].xyz, vec3(1.0))), 0.0); }
)", quadrature.points, 10);
    double colour_error = 0;
    for (int i = 0; i < 10; ++i) {
      const glm::dvec3 expected = radiance(glm::dvec3(quadrature.points[size_t(i) * 777]));
      const glm::dvec3 found(results[size_t(i)]);
      const glm::dvec3 luminance(0.25, 0.5, 0.25);
      EXPECT_NEAR(glm::dot(found, luminance), glm::dot(expected, luminance), 5e-3);
      colour_error = std::max(colour_error, glm::length(found - expected));
    }
    EXPECT_GT(colour_error, 0.1) << "chrominance is meant to be coarser";
  }
}

TEST_F(CacheEncoding, EveryEncodingKeepsTheMean) {
  const Quadrature quadrature;
  for (Encoding encoding : {Encoding::kY3Co1Cg1, Encoding::kY3Co2Cg2, Encoding::kY3Co3Cg3,
                            Encoding::kRgb3, Encoding::kY2Co2Cg2, Encoding::kRgb2}) {
    const auto results = run(encoding, std::string(kEncoded) +
                                           "vec4 lab(uint i) { return vec4(decode(encoded(), "
                                           "banded_harmonics(inputs[0].xyz, vec3(1.0, 0.0, 0.0))), 0.0); }",
                             quadrature.points, 1);
    glm::dvec3 mean(0);
    for (const glm::vec4& point : quadrature.points)
      mean += radiance(glm::dvec3(point)) * double(point.w) / (4 * kPi);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(results[0][c], mean[c], 1e-3) << int(encoding);
  }
}

TEST_F(CacheEncoding, SeedsComeBack) {
  for (Encoding encoding : {Encoding::kY3Co1Cg1, Encoding::kRgb3, Encoding::kRgb2}) {
    const auto results = run(encoding, std::string(kEncoded) + R"(
vec4 lab(uint i) {
  ivec3 voxel = ivec3(i & 7u, i >> 3 & 7u, i >> 6);
  vec3 sums[9];
  for (int k = 0; k < 9; ++k) sums[k] = vec3(1.0);
  vec4 texels[CELL_TEXELS] = encode(sums, float(seed_code(voxel)));
  uint code = uint(texels[CELL_TEXELS - 1][COEFFICIENTS % 4]);
  return vec4(seed_voxel(code) - voxel, code);
}
)", {glm::vec4(0)}, 512);
    for (const glm::vec4& result : results) {
      EXPECT_EQ(glm::vec3(result), glm::vec3(0));
      EXPECT_GT(result.w, 0);
    }
  }
}

TEST_F(CacheEncoding, PackedColoursAreRightOfAnySize) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<glm::vec4> colours{{0, 0, 0, 0}, {1, 1, 1, 0}, {-1, 0.5f, 2, 0}, {1e-30f, 0, 0, 0}, {1e30f, 1e30f, 1, 0}};
  for (int i = 0; i < 500; ++i) {
    const float size = std::exp2(60 * unit(random) - 30);
    colours.push_back(size * glm::vec4(unit(random), unit(random), unit(random), 0));
  }
  const auto results = run(Encoding::kRgb3, "vec4 lab(uint i) { return vec4(unpack_light(pack_light(inputs[i].rgb)), 0.0); }",
                           colours, int(colours.size()));
  for (size_t i = 0; i < colours.size(); ++i) {
    const glm::vec3 expected = glm::max(glm::vec3(colours[i]), glm::vec3(0));
    const float largest = std::max({expected.r, expected.g, expected.b});
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(results[i][c], expected[c], largest / 255) << i;
  }
}

// A world of one harmonic comes back as its coefficient, and blurring keeps energy.
TEST(CacheWorld, HarmonicsAndBlurredMap) {
  using namespace radiance_cache;
  std::vector<glm::vec4> map;
  for (int y = 0; y < kWorldHeight; ++y)
    for (int x = 0; x < kWorldWidth; ++x) {
      const double theta = (y + 0.5) / kWorldHeight * kPi;
      map.emplace_back(2, 1 + std::cos(theta), x == 3 && y == 9 ? 1000 : 0, 0);
    }
  const auto harmonics = world_harmonics(map);
  EXPECT_NEAR(harmonics[0].r, 2 * std::sqrt(4 * kPi), 1e-3);
  EXPECT_NEAR(harmonics[0].g, std::sqrt(4 * kPi), 1e-3);
  EXPECT_NEAR(harmonics[2].g, std::sqrt(4 * kPi / 3), 1e-3);  // cos(theta) = sqrt(4 pi / 3) Y_1^0
  for (int k : {1, 3, 4, 5, 6, 7, 8}) EXPECT_NEAR(harmonics[size_t(k)].g, 0, 1e-3) << k;
  const auto blurred = blurred_world(map, 64);
  const int width = kWorldWidth / 4, height = kWorldHeight / 4;
  ASSERT_EQ(blurred.size(), size_t(width * height));
  glm::dvec3 energy(0), before(0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      energy += glm::dvec3(blurred[size_t(y * width + x)]) * std::sin((y + 0.5) / height * kPi) / double(width * height);
  for (int y = 0; y < kWorldHeight; ++y)
    for (int x = 0; x < kWorldWidth; ++x)
      before += glm::dvec3(map[size_t(y * kWorldWidth + x)]) * std::sin((y + 0.5) / kWorldHeight * kPi) /
                double(kWorldWidth * kWorldHeight);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(energy[c], before[c], 0.02 * before[c]) << c;
}

}  // namespace
}  // namespace panoptes::test
