// Runs the path tracer's BSDF on the device, for the tests that compare it with quadrature and with
// formulas in double precision.
#pragma once

#include "gl/context.h"
#include "gl/program.h"
#include "support.h"

#include <memory>
#include <vector>

namespace panoptes::test {

// Lobes before they are packed, each black until a test gives it a colour; laid out as the programs
// of the lab read them.
struct LabLobes {
  glm::vec3 geometric_normal{0, 0, 1};
  float diffuse_roughness = -1;
  glm::vec3 smooth_normal{0, 0, 1};
  float specular_ior = 1;
  glm::vec3 diffuse{0};
  float alpha = 0.25f;
  glm::vec3 normal{0, 0, 1};
  float transmission_alpha = 0;
  glm::vec3 specular{0};
  float ior = 1.5f;
  glm::vec3 grazing{0};
  float sheen_roughness = -1;
  glm::vec3 specular_normal{0, 0, 1};
  float coat = 0;
  glm::vec3 transmission{0};
  float coat_alpha = 0.01f;
  glm::vec3 transmission_normal{0, 0, 1};
  float unused0 = 0;
  glm::vec3 sheen{0};
  float unused1 = 0;
  glm::vec3 sheen_normal{0, 0, 1};
  float unused2 = 0;
  glm::vec3 coat_normal{0, 0, 1};
  float unused3 = 0;
};

// BsdfValue; all lobes' sum is total().
struct LabValue {
  glm::vec3 diffuse;
  float pdf;
  glm::vec3 glossy;
  float unused0;
  glm::vec3 transmission;
  float unused1;
  glm::dvec3 total() const {
    return glm::dvec3(diffuse) + glm::dvec3(glossy) + glm::dvec3(transmission);
  }
};

struct LabSample {
  glm::vec3 direction;
  float pdf;
  LabValue value;
  float singular, kind, unused0, unused1;
};

struct LabPair {
  glm::vec4 view, other;  // the other: a direction, or random numbers
};

class BsdfLab {
 public:
  // bsdf_evaluate() of each pair of view and direction.
  std::vector<LabValue> evaluate(const LabLobes& lobes, const std::vector<LabPair>& pairs);
  // bsdf_sample() of `count` random triples; the same ones for the same seed.
  std::vector<LabSample> draw(const LabLobes& lobes, const glm::dvec3& view, int count,
                              uint32_t seed);
  // What the code of `main` (the body of a function that sets `vec4 result` for `uint i`) gives for
  // i = 0 .. count - 1, with the closures and the BSDF at hand.
  std::vector<glm::vec4> run(const std::string& main, int count);

 private:
  template <class T>
  std::vector<T> run(const gl::ProgramSource& source, const LabLobes& lobes,
                     const std::vector<LabPair>& pairs, size_t count);

  gl::Context context_;
  gl::ProgramCache programs_;
};

// One lab for all tests of a suite.
class BsdfTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { lab = std::make_unique<BsdfLab>(); }
  static void TearDownTestSuite() { lab.reset(); }
  static inline std::unique_ptr<BsdfLab> lab;
};

// --- integrals over directions -------------------------------------------------------------------

// All directions in cells: rings around `pole` that are the narrower the nearer to it they are, cut
// into sectors. So that a narrow lobe is resolved, `pole` should be where it peaks.
class DirectionGrid {
 public:
  static constexpr int kRings = 256, kSectors = 384;
  // Rings lie at pi * t^power, t = 0 .. 1.
  DirectionGrid(const glm::dvec3& pole, double power);
  glm::dvec3 direction(int ring, int sector) const;  // the centre of a cell
  double solid_angle(int ring) const;
  // The cell that holds a direction: ring * kSectors + sector.
  int cell(const glm::dvec3& direction) const;
  // Each cell's centre with one view.
  std::vector<LabPair> pairs(const glm::dvec3& view) const;

 private:
  double angle(double t) const;
  glm::dmat3 frame_;
  double power_;
};

glm::dvec3 view_at(double cosine, double turned = 0.3);  // around +Z
glm::dvec3 mirrored(const glm::dvec3& view);             // by +Z

}  // namespace panoptes::test
