// The estimators of ambient occlusion for themselves, in front of views that record without error:
// against quadrature and what is known of a corner.
#include "gl/context.h"
#include "gl/program.h"
#include "occlusion_scenes.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace panoptes::test {
namespace {

// In place of ambient_occlusion/view.glsl: what `recorded()` of the test says that the line of
// sight through a point meets, r_max = 1.
constexpr const char* kView = R"(
struct LabRange { vec4 range; };
const LabRange occlusion = LabRange(vec4(1.0, 1.0, 0.85, 0.02));
struct Face { vec3 towards; float wall; };
struct Look { bool seen, hidden; vec3 surface; float error; };
vec3 towards_view(Face f) { return f.towards; }
vec3 looked_at;  // the last point
#include "lab/recorded.glsl"
Look look(Face f, vec3 position, vec3 offset) {
  looked_at = offset;
  vec3 surface = recorded(f, offset);
  return Look(true, dot(surface - offset, f.towards) > 0.0, surface, 1.0e-6);
}
)";

// Every point is a surface's that stands before it.
constexpr const char* kAllBlocked =
    "vec3 recorded(Face f, vec3 offset) { return offset + 1.0e-4 * f.towards; }\n";

// A floor through the surface and a wall at x = -wall, looked at from far away.
constexpr const char* kCorner = R"(
vec3 recorded(Face f, vec3 offset) {
  float on_floor = -offset.z / f.towards.z, on_wall = (-f.wall - offset.x) / f.towards.x;
  bool wall = on_wall > on_floor && offset.z + on_wall * f.towards.z >= 0.0;
  return offset + (wall ? on_wall : on_floor) * f.towards;
}
)";

// The floor alone.
constexpr const char* kFloor =
    "vec3 recorded(Face f, vec3 offset) { return offset - offset.z / f.towards.z * f.towards; }\n";

class OcclusionEstimators : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { context = std::make_unique<gl::Context>(); }
  static void TearDownTestSuite() { context.reset(); }

  // What `vec4 lab(uint i)` of `main` gives for 0 .. count - 1, where estimator number `estimator`
  // (3: obscurance) looks at what `recorded` tells.
  std::vector<glm::vec4> run(int estimator, const char* recorded, const std::string& main,
                             int count) {
    gl::ProgramSource source;
    source.name = "occlusion lab";
    source.stages = {{GL_COMPUTE_SHADER, "lab/main.comp"}};
    constexpr const char* kFiles[] = {"alchemy", "ssao", "hbao", "obscurance"};
    std::string includes = fmt::format("#include \"ambient_occlusion/estimate.glsl\"\n"
                                       "#include \"ambient_occlusion/{}.glsl\"\n",
                                       kFiles[estimator]);
    if (estimator < 2) includes += "#include \"ambient_occlusion/points.glsl\"\n";
    source.snippets = {{"ambient_occlusion/view.glsl", kView},
                       {"lab/recorded.glsl", recorded},
                       {"lab/main.comp", includes + R"(
layout(local_size_x = 64) in;
layout(std430, binding = 2) writeonly buffer Results { vec4 results[]; };
Place place(vec3 normal, uint pixel) {
  uint key = hash(pixel);
  return Place(vec3(0.0), normal, uvec3(key, hash(key + 1u), hash(key + 2u)));
}
#include "lab/body.glsl"
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < results.length()) results[i] = lab(i);
}
)"},
                       {"lab/body.glsl", main}};
    source.defines = {fmt::format("HBAO_SLICES {}", ambient_occlusion::kHbaoSlices),
                      fmt::format("HBAO_STEPS {}", ambient_occlusion::kHbaoSteps)};
    const gl::Buffer out(int64_t(count) * int64_t(sizeof(glm::vec4)));
    programs.get(source).use();
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, out.id());
    glDispatchCompute(GLuint(count + 63) / 64, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    std::vector<glm::vec4> results(size_t(count), glm::vec4(0));
    out.read(0, out.bytes(), results.data());
    EXPECT_NO_THROW(gl::check_errors("occlusion lab"));
    return results;
  }

  static inline std::unique_ptr<gl::Context> context;
  gl::ProgramCache programs;
};

// Largest distance between the distribution of `values` and the even one over 0..1.
double unevenness(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  double worst = 0;
  for (size_t i = 0; i < values.size(); ++i)
    worst = std::max({worst, std::abs(values[i] - double(i) / double(values.size())),
                      std::abs(values[i] - double(i + 1) / double(values.size()))});
  return worst;
}

TEST_F(OcclusionEstimators, OpeningsAreTheirIntegrals) {
  constexpr int kSteps = 24;
  const std::vector<glm::vec4> found = run(2, kAllBlocked, R"(
vec4 lab(uint i) {
  vec2 at = vec2(uvec2(i % 25u, i / 25u)) / 24.0;
  return vec4(opening(2.0 * HALF_PI * at.x, HALF_PI * (2.0 * at.y - 1.0)), 0.0);
}
)",
                                           (kSteps + 1) * (kSteps + 1));
  Worst worst;
  for (int y = 0; y <= kSteps; ++y)
    for (int x = 0; x <= kSteps; ++x) {
      const double h = kPi * x / kSteps, g = kPi * (double(y) / kSteps - 0.5);
      glm::dvec3 due(0);
      constexpr int kCells = 2000;
      for (int i = 0; i < kCells; ++i) {
        const double t = h * (i + 0.5) / kCells;
        due += h / kCells * std::cos(t - g) * std::sin(t) * glm::dvec3(1, std::cos(t), std::sin(t));
      }
      for (int c = 0; c < 3; ++c)
        worst.compare(found[size_t(y * (kSteps + 1) + x)][c], due[c], 5e-3, x, y);
    }
  EXPECT_WORST_BELOW(worst, 1e-4);
}

TEST_F(OcclusionEstimators, FramesAreOrthonormal) {
  const std::vector<glm::vec4> found = run(1, kAllBlocked, R"(
vec4 lab(uint i) {
  float z = 1.0 - 2.0 * float(i / 3u) / 341.0, angle = 2.399963 * float(i);
  vec3 n = vec3(sqrt(max(1.0 - z * z, 0.0)) * vec2(cos(angle), sin(angle)), z), x, y;
  frame_around(n, x, y);
  return i % 3u == 0u ? vec4(dot(x, x), dot(y, y), dot(x, y), 1.0) :
                        vec4(1.0, 1.0, dot(x, n), dot(cross(x, y), n));
}
)",
                                           1024);
  for (const glm::vec4& f : found)
    ASSERT_LT(glm::distance(glm::dvec4(f), glm::dvec4(1, 1, 0, 1)), 4e-6);
}

TEST_F(OcclusionEstimators, PointsFollowTheCosineAndFillTheHemisphere) {
  const std::vector<glm::vec4> found = run(1, kAllBlocked, R"(
vec4 lab(uint i) {
  Sums sums = no_samples();
  estimate(place(vec3(0.0, 0.0, 1.0), 5u), Face(vec3(0.6, 0.0, 0.8), 0.0), i, 1u, sums);
  return vec4(looked_at, 0.0);
}
)",
                                           4096);
  // The first samples of a pixel, and all: points of a sequence are spread more evenly than chance,
  // which would give 1.2 / sqrt(n), twice as often as not more than 0.83 / sqrt(n).
  for (const size_t n : {size_t(64), found.size()}) {
    std::vector<double> sines, angles, volumes;
    glm::dvec3 sum(0);
    for (size_t i = 0; i < n; ++i) {
      const glm::dvec3 p(found[i]);
      const double r = glm::length(p);
      volumes.push_back(r * r * r);
      sines.push_back((p.x * p.x + p.y * p.y) / (r * r));
      angles.push_back(std::atan2(p.y, p.x) / (2 * kPi) + (p.y < 0 ? 1 : 0));
      sum += p / r;
    }
    for (const std::vector<double>& values : {volumes, sines, angles})
      EXPECT_LT(unevenness(values), 0.6 / std::sqrt(double(n))) << n;
    EXPECT_LT(glm::distance(sum / double(n), glm::dvec3(0, 0, 2 / 3.0)),
              0.5 / std::sqrt(double(n)));
  }
}

TEST_F(OcclusionEstimators, ABlockedHemisphereIsClosedByTwoThirdsOfTheNormal) {
  for (int estimator : {0, 1}) {
    const std::vector<glm::vec4> found = run(estimator, kAllBlocked, R"(
vec4 lab(uint i) {
  vec3 normal = normalize(vec3(1.0, -2.0, 3.0));
  Sums sums = no_samples();
  Face face = Face(normalize(vec3(0.5, -1.0, 1.0)), 0.0);
  for (uint k = 0u; k < 64u; ++k) estimate(place(normal, i), face, 24u * k, 24u, sums);
  return vec4(sums.closed, sums.unknown) / sums.count;
}
)",
                                             64);
    glm::dvec4 mean(0);
    for (const glm::vec4& f : found) mean += glm::dvec4(f) / double(found.size());
    const glm::dvec3 due = 2 / 3.0 * glm::normalize(glm::dvec3(1, -2, 3));
    EXPECT_LT(glm::distance(glm::dvec3(mean), due), 2e-3) << estimator;
    EXPECT_LT(mean.w, 1e-3)
        << "all but what lies next to the surface's plane is seen to be blocked";
  }
}

// Of points of the hemisphere, spread evenly over its volume, those behind a wall `k` away: their
// share, and the mean of their directions' part towards the wall. By the midpoint rule on the unit
// disk.
glm::dvec2 points_behind_wall(double k) {
  constexpr int kCells = 2000;
  glm::dvec2 sum(0);
  for (int i = 0; i < kCells; ++i) {
    const double x = k + (1 - k) * (i + 0.5) / kCells;
    sum += 2 * std::sqrt(1 - x * x) * (1 - k * k * k / (x * x * x)) * glm::dvec2(1, x);
  }
  return sum * (1 - k) / (kCells * kPi);
}

TEST_F(OcclusionEstimators, AWallOccludesWhatItsSegmentOfADiskTells) {
  // From 45 degrees, and from straight before the wall.
  for (int estimator : {0, 1, 2}) {
    const std::vector<glm::vec4> found = run(estimator, kCorner, R"(
vec4 lab(uint i) {
  Face face = Face(normalize(vec3(1.0, 0.0, i < 640u ? 1.0 : 0.1)), 0.05 + 0.1 * float(i / 64u % 10u));
  Sums sums = no_samples();
  for (uint k = 0u; k < 64u; ++k)
    estimate(place(vec3(0.0, 0.0, 1.0), i), face, 24u * k, 24u, sums);
  return vec4(sums.occlusion, sums.closed) / sums.count;
}
)",
                                             1280);
    for (int from : {0, 1}) {
      Worst occlusion, closed;
      double sum = 0, due_sum = 0;
      for (int a = 0; a < 10; ++a) {
        glm::dvec2 mean(0);
        for (int i = 0; i < 64; ++i) {
          const glm::vec4& f = found[size_t(640 * from + 64 * a + i)];
          mean += glm::dvec2(f.x, -f.y) / 64.0;
        }
        const double k = 0.05 + 0.1 * a;
        const glm::dvec2 due = points_behind_wall(k);
        occlusion.compare(mean.x, due.x, 1, a, from);
        closed.compare(mean.y, due.y, 1, a, from);
        sum += mean.x;
        due_sum += wall_occlusion(k);
      }
      // Points alone are known exactly. The other two are approximations by construction: Alchemy
      // counts what is recorded before points that are open, too, and the more of it the more a
      // view shows of the wall's height; steps towards the horizon miss what lies between them.
      // Points that lie deeper in the wall than r_max, along the line of sight, are unknown: from
      // aside some of those that the wall blocks do.
      if (estimator == 1) {
        EXPECT_WORST_BELOW(occlusion, from == 0 ? 0.02 : 0.002);
        EXPECT_WORST_BELOW(closed, from == 0 ? 0.02 : 0.002);
      }
      const glm::dvec2 range = estimator == 0
                                   ? (from == 0 ? glm::dvec2(1.1, 1.5) : glm::dvec2(1.1, 2.5))
                               : estimator == 1 ? glm::dvec2(0.7, 0.8)
                                                : glm::dvec2(0.8, 1);
      EXPECT_GT(sum / due_sum, range.x) << estimator << " from " << from;
      EXPECT_LT(sum / due_sum, range.y) << estimator << " from " << from;
    }
  }
}

TEST_F(OcclusionEstimators, AFloorAloneIsOpen) {
  for (int estimator : {0, 1, 2, 3}) {
    const std::vector<glm::vec4> found = run(estimator, kFloor, R"(
vec4 lab(uint i) {
  float z = 0.02 + 0.97 * float(i) / 255.0, angle = 2.399963 * float(i);
  Face face = Face(vec3(sqrt(1.0 - z * z) * vec2(cos(angle), sin(angle)), z), 0.0);
  Sums sums = no_samples();
  estimate(place(vec3(0.0, 0.0, 1.0), i), face, 0u, 24u, sums);
  return vec4(sums.occlusion, sums.closed);
}
)",
                                             256);
    for (const glm::vec4& f : found)
      ASSERT_LT(glm::length(f), estimator == 2 ? 1e-4 : 1e-9) << estimator;
  }
}

}  // namespace
}  // namespace panoptes::test
