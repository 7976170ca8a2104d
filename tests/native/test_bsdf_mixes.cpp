// Mixes of closures as the path tracer has them: one of a kind is kept by chance, and the mean over
// seeds is what all of them do together.
#include "bsdf_lab.h"

#include <cmath>

namespace panoptes::test {
namespace {

class BsdfMixes : public BsdfTest {};

// Evaluates `closures`, lines that begin with `if (on(k))`, for eight directions, two of them below.
// First all closures together, with a seed for each group of eight; then each alone, a group each.
std::string mix(const std::string& closures, int seeds) {
  return "const int SEEDS = " + std::to_string(seeds) + R"(;
vec3 lab_direction(uint i) {
  if (i >= 6u) return normalize(vec3(-0.4, 0.1 * float(i) - 0.7, -0.9));
  float z = 0.95 - 0.17 * float(i), turn = 2.4 * float(i);
  return vec3(sqrt(1.0 - z * z) * vec2(cos(turn), sin(turn)), z);
}
int only;
bool on(int k) { return only < 0 || only == k; }
vec4 lab(uint i) {
  Hit hit;
  hit.normal = hit.geometric_normal = hit.normal_unflipped = vec3(0.0, 0.0, 1.0);
  hit.view = normalize(vec3(0.5, 0.2, 0.8));
  hit.backfacing = false;
  vec3 straight = hit.normal, tilted = normalize(vec3(0.2, -0.3, 1.0));
  Surface surface = empty_surface();
  int group = int(i / 8u);
  only = group < SEEDS ? -1 : group - SEEDS;
  surface.seed = hash(uint(group));
)" + closures + R"(
  finish_surface(hit, surface);
  Lobes l = lobes_of(hit, surface);
  uvec4 texels[LOBES_TEXELS];
  pack_lobes(l, texels);
  BsdfValue value = bsdf_evaluate(unpack_lobes(texels, hit.view), lab_direction(i % 8u));
  return vec4(value.diffuse + value.glossy + value.transmission, value.pdf);
}
)";
}

TEST_F(BsdfMixes, AreOnAverageTheSumOfTheirLobes) {
  const std::string closures = R"(
  if (on(0)) closure_glossy(surface, vec3(0.3), vec3(1.0, 0.5, 0.2), 0.3, straight);
  if (on(1)) closure_glossy(surface, vec3(0.5), vec3(0.2, 0.5, 1.0), 0.7, tilted);
  if (on(2)) closure_diffuse(surface, vec3(0.2), vec3(0.8, 0.1, 0.1), 0.0, straight);
  if (on(3)) closure_diffuse(surface, vec3(0.4), vec3(0.1, 0.9, 0.1), 1.0, tilted);
  if (on(4)) closure_refraction(hit, surface, vec3(0.2), vec3(0.9, 0.9, 0.5), 0.6, 1.5, straight);
  if (on(5)) closure_refraction(hit, surface, vec3(0.3), vec3(0.5, 0.9, 0.9), 0.8, 1.2, tilted);
  if (on(6)) closure_velvet(surface, vec3(0.5), vec3(1.0, 0.3, 0.6), 0.5, straight);
  if (on(7)) closure_velvet(surface, vec3(0.5), vec3(0.3, 0.6, 1.0), 0.9, tilted);
)";
  const int seeds = 8192, count = 8;
  const std::vector<glm::vec4> values = lab->run(mix(closures, seeds), 8 * (seeds + count));
  for (int direction = 0; direction < 8; ++direction)
    for (int c = 0; c < 3; ++c) {
      double due = 0, sum = 0, squares = 0;
      for (int k = 0; k < count; ++k) due += values[(seeds + k) * 8 + direction][c];
      for (int i = 0; i < seeds; ++i) {
        const double value = values[i * 8 + direction][c];
        sum += value;
        squares += value * value;
      }
      const double mean = sum / seeds;
      const double error = std::sqrt(std::max(squares / seeds - mean * mean, 0.0) / seeds);
      EXPECT_GT(due, 0);
      EXPECT_NEAR(mean, due, 4.5 * error + 1e-5) << "direction " << direction << ", channel " << c;
      EXPECT_LT(error, 0.02 * due) << "too noisy to judge";
    }
}

TEST_F(BsdfMixes, OfColoursAloneTakeNoChances) {
  const std::string closures = R"(
  if (on(0)) closure_diffuse(surface, vec3(0.25), vec3(1.0, 0.0, 0.0), 0.5, straight);
  if (on(1)) closure_diffuse(surface, vec3(0.75), vec3(0.0, 1.0, 0.0), 0.5, straight);
  if (on(2)) closure_glossy(surface, vec3(0.25), vec3(0.0, 0.0, 1.0), 0.5, tilted);
  if (on(3)) closure_glossy(surface, vec3(0.25), vec3(1.0, 0.0, 0.0), 0.5, tilted);
)";
  const int seeds = 64;
  const std::vector<glm::vec4> values = lab->run(mix(closures, seeds), 8 * (seeds + 4));
  for (int direction = 0; direction < 8; ++direction)
    for (int i = 0; i < seeds; ++i)
      for (int c = 0; c < 3; ++c) {
        double due = 0;
        for (int k = 0; k < 4; ++k) due += values[(seeds + k) * 8 + direction][c];
        ASSERT_NEAR(values[i * 8 + direction][c], due, 1e-5 + 1e-5 * due);
      }
}

TEST_F(BsdfMixes, WithWhatIsNotFiniteStayFinite) {
  const std::string closures = R"(
  float nan = intBitsToFloat(0x7fc00000 + int(i & 1u));
  if (on(0)) closure_glossy(surface, vec3(0.3), vec3(nan, 0.5, 0.2), 0.3, straight);
  if (on(1)) closure_glossy(surface, vec3(0.5), vec3(1.0e38), nan, tilted);
  if (on(2)) closure_diffuse(surface, vec3(0.2), vec3(0.8), nan, vec3(nan));
  if (on(3)) closure_refraction(hit, surface, vec3(0.2), vec3(0.9), nan, nan, vec3(0.0));
  if (on(4)) closure_velvet(surface, vec3(0.5), vec3(-1.0e38), nan, straight);
)";
  for (const glm::vec4& value : lab->run(mix(closures, 64), 8 * (64 + 5)))
    for (int c = 0; c < 4; ++c) ASSERT_TRUE(std::isfinite(value[c])) << value[c];
}

}  // namespace
}  // namespace panoptes::test
