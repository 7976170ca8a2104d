// The samplers of the path tracer's BSDF against their densities, and densities and albedos against
// quadrature.
#include "bsdf_lab.h"

#include <cmath>

namespace panoptes::test {
namespace {

class BsdfSampling : public BsdfTest {};

struct Case {
  const char* name;
  LabLobes lobes;
  double cosine = 0.7;  // of the view
  double power = 2;     // of the grid
  double ior = 0;       // > 0: the grid is around the refracted direction
};

LabLobes diffuse(float roughness) {
  LabLobes l;
  l.diffuse = glm::vec3(0.8f, 0.5f, 0.2f);
  l.diffuse_roughness = roughness;
  return l;
}

LabLobes glossy(float roughness) {
  LabLobes l;
  l.specular = l.grazing = glm::vec3(1);
  l.alpha = roughness * roughness;
  return l;
}

LabLobes refraction(float roughness, float ior) {
  LabLobes l;
  l.transmission = glm::vec3(1);
  l.transmission_alpha = roughness * roughness;
  l.ior = ior;
  return l;
}

LabLobes coat(float alpha) {
  LabLobes l;
  l.coat = 1;
  l.coat_alpha = alpha;
  return l;
}

LabLobes sheen(float roughness) {
  LabLobes l;
  l.sheen = glm::vec3(1);
  l.sheen_roughness = roughness;
  return l;
}

// Everything at once, with a normal of its own for each lobe.
LabLobes everything() {
  LabLobes l = diffuse(0.4f);
  l.specular = {0.04f, 0.05f, 0.06f};
  l.grazing = glm::vec3(0.9f);
  l.specular_ior = 1.5f;
  l.alpha = 0.09f;
  l.transmission = {0.1f, 0.2f, 0.3f};
  l.transmission_alpha = 0.2f;
  l.sheen = glm::vec3(0.5f);
  l.coat = 0.5f;
  l.coat_alpha = -0.04f;
  l.smooth_normal = glm::normalize(glm::vec3(0.1f, 0, 1));
  l.normal = glm::normalize(glm::vec3(0.2f, 0.2f, 1));
  l.specular_normal = glm::normalize(glm::vec3(-0.2f, 0.1f, 1));
  l.transmission_normal = glm::normalize(glm::vec3(0.1f, -0.1f, 1));
  l.coat_normal = glm::normalize(glm::vec3(0, 0.05f, 1));
  return l;
}

std::vector<Case> cases() {
  return {{"Lambert", diffuse(-1)},
          {"Oren-Nayar, grazing", diffuse(-2), 0.05},
          {"Burley", diffuse(1), 0.3},
          {"glossy .1", glossy(0.1f), 0.7, 4},
          {"glossy .1, grazing", glossy(0.1f), 0.05, 4},
          {"glossy .5", glossy(0.5f), 0.4},
          {"glossy 1", glossy(1), 0.9},
          {"glossy 1, grazing", glossy(1), 0.02},
          {"just above the smooth limit", glossy(0.02f), 0.8, 6},
          {"refraction .2 into glass", refraction(0.2f, 1.5f), 0.6, 4, 1.5},
          {"refraction .2 out of glass", refraction(0.2f, 1 / 1.5f), 0.9, 4, 1 / 1.5},
          {"refraction .7 into glass, grazing", refraction(0.7f, 1.5f), 0.1, 2, 1.5},
          {"refraction 1 out of glass", refraction(1, 1 / 1.5f), 0.5, 2, 1},
          {"refraction of nearly the same index", refraction(0.5f, 1.02f), 0.6, 6, 1.02},
          {"Disney's coat", coat(-0.01f), 0.6, 4},
          {"Disney's coat, rough", coat(-1), 0.6},
          {"a coat of GGX", coat(0.04f), 0.5, 3},
          {"Disney's sheen", sheen(-1), 0.3},
          {"velvet", sheen(0.3f), 0.5},
          {"everything", everything(), 0.6, 3},
          {"everything, grazing", everything(), 0.15, 3}};
}

glm::dvec3 pole_of(const Case& c, const glm::dvec3& view) {
  if (c.ior <= 0) return mirrored(view);
  const double squared = 1 - (1 - view.z * view.z) / (c.ior * c.ior);
  return {-view.x / c.ior, -view.y / c.ior, -std::sqrt(std::max(squared, 0.01))};
}

// How many standard deviations a chi-square of that many degrees lies above what is to be expected
// (Wilson and Hilferty).
double deviations(double chi_square, int degrees) {
  const double spread = 2.0 / (9 * degrees);
  return (std::cbrt(chi_square / degrees) - (1 - spread)) / std::sqrt(spread);
}

constexpr int kDraws = 60000;
// Rings and sectors that make up a bin.
constexpr int kBinRings = 16, kBinSectors = 32;

TEST_F(BsdfSampling, DirectionsAreDistributedAsTheirDensitySays) {
  for (const Case& c : cases()) {
    const glm::dvec3 view = view_at(c.cosine);
    const DirectionGrid grid(pole_of(c, view), c.power);
    const std::vector<LabValue> values = lab->evaluate(c.lobes, grid.pairs(view));
    const auto bin = [](int cell) {
      const int ring = cell / DirectionGrid::kSectors, sector = cell % DirectionGrid::kSectors;
      return ring / kBinRings * (DirectionGrid::kSectors / kBinSectors) + sector / kBinSectors;
    };
    constexpr int kBins = DirectionGrid::kRings / kBinRings * DirectionGrid::kSectors / kBinSectors;
    // The last bin is for what has no direction.
    std::vector<double> expected(kBins + 1), counted(kBins + 1);
    double sum = 0;
    for (int i = 0; i < int(values.size()); ++i) {
      const double share = values[i].pdf * grid.solid_angle(i / DirectionGrid::kSectors);
      expected[bin(i)] += kDraws * share;
      sum += share;
    }
    EXPECT_LE(sum, 1.003) << c.name;
    expected[kBins] = kDraws * std::max(1 - sum, 0.0);
    for (const LabSample& s : lab->draw(c.lobes, view, kDraws, 1)) {
      ASSERT_EQ(s.singular, 0) << c.name;
      counted[s.pdf > 0 ? bin(grid.cell(s.direction)) : kBins] += 1;
    }
    double chi_square = 0, pooled_expected = 0, pooled_counted = 0;
    int degrees = -1;
    const auto compare = [&](double due, double seen) {
      chi_square += (seen - due) * (seen - due) / due;
      ++degrees;
    };
    for (int i = 0; i <= kBins; ++i)
      if (expected[i] >= 10) {
        compare(expected[i], counted[i]);
      } else {
        pooled_expected += expected[i];
        pooled_counted += counted[i];
      }
    if (pooled_expected >= 10) compare(pooled_expected, pooled_counted);
    EXPECT_LT(pooled_counted, 2 * pooled_expected + 20) << c.name;
    ASSERT_GT(degrees, 2) << c.name;
    EXPECT_LT(deviations(chi_square, degrees), 4) << c.name << ": " << chi_square << " of " << degrees;
  }
}

TEST_F(BsdfSampling, WhatSamplesWeighOnAverageIsTheAlbedo) {
  for (const Case& c : cases()) {
    const glm::dvec3 view = view_at(c.cosine);
    const DirectionGrid grid(pole_of(c, view), c.power);
    const std::vector<LabValue> values = lab->evaluate(c.lobes, grid.pairs(view));
    glm::dvec3 albedo(0);
    for (int i = 0; i < int(values.size()); ++i)
      if (values[i].pdf > 0)
        albedo += values[i].total() * grid.solid_angle(i / DirectionGrid::kSectors);
    glm::dvec3 sum(0), squares(0);
    for (const LabSample& s : lab->draw(c.lobes, view, kDraws, 2)) {
      if (s.pdf <= 0) continue;
      EXPECT_EQ(s.pdf, s.value.pdf) << c.name;
      const glm::dvec3 weight = s.value.total() / double(s.pdf);
      sum += weight;
      squares += weight * weight;
    }
    for (int k = 0; k < 3; ++k) {
      const double mean = sum[k] / kDraws;
      const double error = std::sqrt(std::max(squares[k] / kDraws - mean * mean, 0.0) / kDraws);
      EXPECT_NEAR(mean, albedo[k], 0.002 * albedo[k] + 4 * error) << c.name << ", channel " << k;
      // Sheens reflect little, and their samples know little of where.
      EXPECT_LT(error, std::max(0.005 * albedo[k], 6e-4)) << c.name << ": too noisy to judge";
    }
  }
}

TEST_F(BsdfSampling, SmoothLobesGoOneWay) {
  LabLobes l = refraction(0, 1.5f);
  l.transmission = glm::vec3(0.3f);
  l.specular = l.grazing = glm::vec3(0.2f);
  l.alpha = 0;
  const glm::dvec3 view = view_at(0.6);
  const int draws = 4000;
  int refracted = 0, reflected = 0;
  for (const LabSample& s : lab->draw(l, view, draws, 3)) {
    ASSERT_EQ(s.singular, 1);
    ASSERT_GT(s.pdf, 0);
    const glm::dvec3 d(s.direction);
    if (s.kind == 2) {
      ++refracted;
      EXPECT_LT(glm::length(d - glm::dvec3(-view.x / 1.5, -view.y / 1.5,
                                           -std::sqrt(1 - (1 - view.z * view.z) / 2.25))),
                1e-4);
      EXPECT_NEAR(s.value.transmission.x, 0.3, 1e-6);
      EXPECT_EQ(s.value.glossy.x, 0);
    } else {
      ++reflected;
      EXPECT_LT(glm::length(d - mirrored(view)), 2e-4);
      EXPECT_NEAR(s.value.glossy.x, 0.2, 1e-6);
      EXPECT_EQ(s.value.transmission.x, 0);
    }
    EXPECT_NEAR(s.pdf, s.kind == 2 ? 0.6 : 0.4, 1e-5);
  }
  EXPECT_NEAR(refracted, 0.6 * draws, 5 * std::sqrt(0.24 * draws));
  EXPECT_EQ(refracted + reflected, draws);
}

TEST_F(BsdfSampling, NothingIsLostThroughAPaneOfTheSameIndex) {
  for (float roughness : {0.0f, 0.5f, 1.0f}) {
    const glm::dvec3 view = view_at(0.4);
    for (const LabSample& s : lab->draw(refraction(roughness, 1), view, 100, 4)) {
      EXPECT_EQ(s.singular, 1);
      EXPECT_LT(glm::length(glm::dvec3(s.direction) + view), 1e-5);
      EXPECT_EQ(s.value.transmission, glm::vec3(s.pdf));
    }
  }
}

TEST_F(BsdfSampling, BlackSurfacesScatterNothing) {
  for (const LabSample& s : lab->draw({}, view_at(0.5), 100, 5)) EXPECT_EQ(s.pdf, 0);
}

TEST_F(BsdfSampling, NoDirectionLeavesOnTheWrongSideOfTheSurface) {
  LabLobes l = everything();
  l.geometric_normal = glm::normalize(glm::vec3(0.9f, 0.1f, 1));
  int lost = 0;
  for (const LabSample& s : lab->draw(l, view_at(0.6), 20000, 6)) {
    lost += s.pdf <= 0;
    if (s.pdf > 0) {
      EXPECT_EQ(glm::dot(s.direction, l.geometric_normal) < 0, s.kind == 2) << s.kind;
    }
  }
  EXPECT_GT(lost, 100) << "the geometric normal is far enough from the others to lose some";
}

}  // namespace
}  // namespace panoptes::test
