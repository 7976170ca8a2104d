// The lobes of the path tracer against formulas in double precision, and against what physics asks of
// any: reciprocity, no energy out of nothing, finite values in hard cases.
#include "bsdf_lab.h"

#include <cmath>
#include <functional>

namespace panoptes::test {
namespace {

class BsdfLobes : public BsdfTest {
 protected:
  // The share of white light from everywhere that goes to the viewer, by quadrature.
  static glm::dvec3 albedo(const LabLobes& lobes, const glm::dvec3& view, double power = 2) {
    const DirectionGrid grid(mirrored(view), power);
    const std::vector<LabValue> values = lab->evaluate(lobes, grid.pairs(view));
    glm::dvec3 sum(0);
    for (int i = 0; i < int(values.size()); ++i)
      sum += values[i].total() * grid.solid_angle(i / DirectionGrid::kSectors);
    return sum;
  }

  // The same by samples, what is singular included.
  static glm::dvec3 throughput(const LabLobes& lobes, const glm::dvec3& view, int draws = 20000) {
    glm::dvec3 sum(0);
    for (const LabSample& s : lab->draw(lobes, view, draws, 7))
      if (s.pdf > 0) sum += s.value.total() / double(s.pdf);
    return sum / double(draws);
  }
};

// --- formulas ------------------------------------------------------------------------------------

double fresnel(double c, double ior) {
  const double g2 = ior * ior - 1 + c * c;
  if (g2 <= 0) return 1;
  const double g = std::sqrt(g2), a = (g - c) / (g + c), b = ((g + c) * c - 1) / ((g - c) * c + 1);
  return 0.5 * a * a * (1 + b * b);
}

double smith(double cosine, double a2) {
  return 2 * cosine / (cosine + std::sqrt(a2 + (1 - a2) * cosine * cosine));
}

double ggx(double nh, double a2) {
  const double t = nh * nh * (a2 - 1) + 1;
  return a2 / (kPi * t * t);
}

// Each for a normal of +Z, with its cosine.
double ggx_reflection(const glm::dvec3& v, const glm::dvec3& l, double alpha) {
  if (l.z <= 0) return 0;
  const double a2 = alpha * alpha;
  return ggx(glm::normalize(l + v).z, a2) * smith(v.z, a2) * smith(l.z, a2) / (4 * v.z);
}

// Walter et al. 2007, equation 21, with light that comes from l.
double ggx_refraction(const glm::dvec3& v, const glm::dvec3& l, double alpha, double ior) {
  if (l.z >= 0) return 0;
  glm::dvec3 h = glm::normalize(-(ior * l + v));
  if (h.z < 0) h = -h;
  const double vh = glm::dot(v, h), lh = glm::dot(l, h), a2 = alpha * alpha;
  if (vh <= 0 || lh >= 0) return 0;
  const double denominator = ior * lh + vh;
  return std::abs(vh * lh / v.z) * ior * ior * ggx(h.z, a2) * smith(v.z, a2) * smith(-l.z, a2) /
         (denominator * denominator);
}

double disney_coat(const glm::dvec3& v, const glm::dvec3& l, double alpha) {
  if (l.z <= 0) return 0;
  const glm::dvec3 h = glm::normalize(l + v);
  const double a2 = alpha * alpha;
  const double d = (a2 - 1) / (kPi * std::log(a2) * (1 + (a2 - 1) * h.z * h.z));
  return d * smith(v.z, 0.0625) * smith(l.z, 0.0625) / (4 * v.z) * fresnel(glm::dot(l, h), 1.5);
}

double burley(const glm::dvec3& v, const glm::dvec3& l, double roughness) {
  if (l.z <= 0) return 0;
  const double lh = glm::dot(l, glm::normalize(l + v)), f90 = 0.5 + 2 * roughness * lh * lh;
  return l.z / kPi * (1 + (f90 - 1) * std::pow(1 - l.z, 5)) * (1 + (f90 - 1) * std::pow(1 - v.z, 5));
}

double oren_nayar(const glm::dvec3& v, const glm::dvec3& l, double roughness) {
  if (l.z <= 0) return 0;
  const double a = 1 / (kPi + (3 * kPi - 4) / 6 * roughness);
  double t = glm::dot(l, v) - l.z * v.z;
  if (t > 0) t /= std::max(l.z, v.z);
  return l.z * a * (1 + roughness * t);
}

double velvet(const glm::dvec3& v, const glm::dvec3& l, double sigma) {
  if (l.z <= 0) return 0;
  const glm::dvec3 h = glm::normalize(l + v);
  const double sine2 = 1 - h.z * h.z, cot2 = h.z * h.z / sine2;
  const double d = std::exp(-cot2 / (sigma * sigma)) / (sigma * sigma * kPi * sine2 * sine2);
  const double g = std::min({1.0, 2 * h.z * l.z / glm::dot(l, h), 2 * h.z * v.z / glm::dot(l, h)});
  return 0.25 * d * g / v.z;
}

using Formula = std::function<double(const glm::dvec3&, const glm::dvec3&)>;

struct LobeCase {
  const char* name;
  LabLobes lobes;
  Formula formula;
  double least = 1e-3;  // below, differences count as of this value
};

std::vector<LobeCase> lobe_cases() {
  std::vector<LobeCase> cases;
  const auto add = [&](const char* name, const std::function<void(LabLobes&)>& change,
                       Formula formula) {
    LabLobes lobes;
    change(lobes);
    cases.push_back({name, lobes, std::move(formula)});
  };
  using V = const glm::dvec3&;
  for (double r : {0.0, 0.5, 1.0}) {
    add("Burley", [&](LabLobes& l) { l.diffuse = glm::vec3(1), l.diffuse_roughness = float(r); },
        [=](V v, V l) { return burley(v, l, r); });
    add("Oren-Nayar",
        [&](LabLobes& l) { l.diffuse = glm::vec3(1), l.diffuse_roughness = float(-1 - r); },
        [=](V v, V l) { return oren_nayar(v, l, r); });
  }
  for (float alpha : {0.04f, 0.25f, 1.0f}) {
    add("mirror",
        [&](LabLobes& l) { l.specular = l.grazing = glm::vec3(1), l.alpha = alpha; },
        [=](V v, V l) { return ggx_reflection(v, l, alpha); });
    add("dielectric",
        [&](LabLobes& l) {
          l.specular = glm::vec3(0.04f), l.grazing = glm::vec3(1);
          l.specular_ior = 1.5f, l.alpha = alpha;
        },
        [=](V v, V l) {
          return ggx_reflection(v, l, alpha) * fresnel(glm::dot(l, glm::normalize(l + v)), 1.5);
        });
    for (float ior : {1.5f, 1 / 1.5f})
      add("refraction",
          [&](LabLobes& l) {
            l.transmission = glm::vec3(1), l.ior = ior, l.transmission_alpha = alpha;
          },
          [=](V v, V l) { return ggx_refraction(v, l, alpha, ior); });
  }
  for (float alpha : {0.05f, 0.5f})
    add("Disney's coat", [&](LabLobes& l) { l.coat = 1, l.coat_alpha = -alpha; },
        [=](V v, V l) { return disney_coat(v, l, alpha); });
  for (float sigma : {0.2f, 1.0f})
    add("velvet", [&](LabLobes& l) { l.sheen = glm::vec3(1), l.sheen_roughness = sigma; },
        [=](V v, V l) { return velvet(v, l, sigma); });
  add("Disney's sheen", [](LabLobes& l) { l.sheen = glm::vec3(1); },
      [](V v, V l) {
        return l.z <= 0 ? 0 : l.z * std::pow(1 - glm::dot(l, glm::normalize(l + v)), 5);
      });
  return cases;
}

// A few hundred directions, not those of any grid.
std::vector<glm::dvec3> directions(int count) {
  std::vector<glm::dvec3> result;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - 2 * (i + 0.5) / count, phi = 2.39996323 * i;
    result.push_back({std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi), z});
  }
  return result;
}

TEST_F(BsdfLobes, AreTheirFormulas) {
  for (const LobeCase& c : lobe_cases()) {
    std::vector<LabPair> pairs;
    std::vector<double> due;
    for (double cosine : {0.95, 0.5, 0.05})
      for (const glm::dvec3& l : directions(500)) {
        const glm::dvec3 v = view_at(cosine);
        pairs.push_back({glm::vec4(v, 0), glm::vec4(l, 0)});
        due.push_back(c.formula(v, l));
      }
    const std::vector<LabValue> values = lab->evaluate(c.lobes, pairs);
    Worst worst;
    for (int i = 0; i < int(values.size()); ++i)
      worst.compare(values[i].total().x, due[i], c.least, i, 0);
    EXPECT_WORST_BELOW(worst, 1e-3) << c.name;
  }
}

TEST_F(BsdfLobes, ReflectAlikeBothWays) {
  for (const LobeCase& c : lobe_cases()) {
    if (c.lobes.transmission.x > 0) continue;
    std::vector<LabPair> there, back;
    for (const glm::dvec3& v : directions(60))
      for (const glm::dvec3& l : directions(50)) {
        if (v.z < 0.02 || l.z < 0.02) continue;
        there.push_back({glm::vec4(v, 0), glm::vec4(l, 0)});
        back.push_back({glm::vec4(l, 0), glm::vec4(v, 0)});
      }
    const std::vector<LabValue> a = lab->evaluate(c.lobes, there), b = lab->evaluate(c.lobes, back);
    Worst worst;
    for (int i = 0; i < int(a.size()); ++i)
      worst.compare(a[i].total().x / there[i].other.z, b[i].total().x / there[i].view.z, c.least, i,
                    0);
    EXPECT_WORST_BELOW(worst, 1e-3) << c.name;
  }
}

// Measured in Cycles 3.4 with a Normal input, GGX of roughness .6, Lambert; velvet is not cut there.
TEST_F(BsdfLobes, OnlyDiffuseLightFadesOutBeforeTheHorizonOfAMappedNormal) {
  const glm::dvec3 view = glm::normalize(glm::dvec3(0.5, 0.2, 0.8));
  LabLobes rough, mirror;
  rough.normal = mirror.specular_normal = glm::normalize(glm::vec3(0.3f, 0.1f, 1));
  rough.diffuse = mirror.specular = mirror.grazing = glm::vec3(1);
  mirror.alpha = 0.36f;
  std::vector<LabPair> pairs;
  for (const glm::dvec3& l : {glm::dvec3(0.3, 0.5, 0.8), {0.9, 0.1, 0.25}, {0.95, 0.1, 0.05},
                              {0.9, 0.1, -0.1}})
    pairs.push_back({glm::vec4(view, 0), glm::vec4(glm::normalize(l), 0)});
  const double lambert[] = {0.89821, 0.34879, 0.06217, 0}, ggx[] = {0.70964, 0.16247, 0.09895, 0};
  const std::vector<LabValue> a = lab->evaluate(rough, pairs), b = lab->evaluate(mirror, pairs);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(kPi * a[i].diffuse.x, lambert[i], 2e-4) << i;
    EXPECT_NEAR(kPi * b[i].glossy.x, ggx[i], 2e-4) << i;
  }
}

// --- energy --------------------------------------------------------------------------------------

TEST_F(BsdfLobes, WhiteDiffuseSendsAllBack) {
  LabLobes l;
  l.diffuse = glm::vec3(1);
  for (double cosine : {1.0, 0.5, 0.05}) {
    EXPECT_NEAR(albedo(l, view_at(cosine)).x, 1, 2e-3);
    EXPECT_NEAR(throughput(l, view_at(cosine)).x, 1, 1e-5);
  }
}

TEST_F(BsdfLobes, SmoothGlassSendsAllOn) {
  for (float ior : {1.5f, 1 / 1.5f, 1.0f, 2.4f})
    for (double cosine : {1.0, 0.9, 0.4, 0.05}) {
      LabLobes l;
      const float reflected = float(fresnel(cosine, ior));
      l.alpha = 0;
      l.specular = l.grazing = glm::vec3(reflected);
      l.transmission = glm::vec3(1 - reflected);
      l.ior = ior;
      EXPECT_NEAR(throughput(l, view_at(cosine), 2000).x, 1, 1e-5) << ior << " at " << cosine;
    }
}

// What one scattering of white GGX sends back, by n * n facets. Visible normals turn the integral into
// the mean of the other direction's masking.
double ggx_albedo(double alpha, const glm::dvec3& v, int n) {
  double sum = 0, weight = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      // As many facets in each step of 1 - w^2 as GGX has there, so that narrow lobes are resolved,
      // and those that stand upright by small steps.
      const double w = (i + 0.5) / n, theta = std::atan(alpha * std::sqrt(1 - w * w) / w);
      const double phi = 2 * kPi * (j + 0.5) / n;
      const glm::dvec3 h(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                         std::cos(theta));
      const double vh = glm::dot(v, h);
      if (vh <= 0) continue;
      const double visible = w * vh / h.z;  // times the same constant everywhere
      const glm::dvec3 out = 2 * vh * h - v;
      weight += visible;
      if (out.z > 0) sum += visible * smith(out.z, alpha * alpha);
    }
  return sum / weight;
}

TEST_F(BsdfLobes, OneScatteringOfGgxLosesWhatItIsKnownToLose) {
  for (float alpha : {0.04f, 0.36f, 1.0f})
    for (double cosine : {0.9, 0.3}) {
      LabLobes l;
      l.specular = l.grazing = glm::vec3(1);
      l.alpha = alpha;
      const glm::dvec3 v = view_at(cosine, 0);
      const double due = ggx_albedo(alpha, v, 400);
      EXPECT_NEAR(albedo(l, v, 3).x, due, 0.005 * due) << alpha << " at " << cosine;
      EXPECT_NEAR(throughput(l, v, 150000).x, due, 0.005 * due) << alpha << " at " << cosine;
      EXPECT_LT(due, 1);
    }
}

TEST_F(BsdfLobes, WhatOneScatteringLosesIsKnownInClosedForm) {
  const std::vector<glm::vec4> known = lab->run(
      "vec4 lab(uint i) {\n"
      "  return vec4(ggx_separable_albedo(float(i / 11u + 1u) / 10.0, float(i % 11u + 1u) / 11.0));\n"
      "}\n",
      110);
  for (int i = 0; i < 110; ++i) {
    const double alpha = (i / 11 + 1) / 10.0, cosine = (i % 11 + 1) / 11.0;
    const double due = ggx_albedo(alpha, view_at(cosine), 120);
    EXPECT_NEAR(known[i].x, due, 0.005 * due) << alpha << " at " << cosine;
  }
}

TEST_F(BsdfLobes, NoLobeSendsBackMoreThanItGets) {
  for (const LobeCase& c : lobe_cases()) {
    // Burley's reflects up to 1.6 times the light at grazing angles, by design.
    if (std::string(c.name) == "Burley") continue;
    for (double cosine : {0.95, 0.3, 0.02})
      EXPECT_LT(throughput(c.lobes, view_at(cosine)).x, 1.001) << c.name << " at " << cosine;
  }
}

// --- hard cases ----------------------------------------------------------------------------------

void expect_finite(const LabSample& s, const std::string& what) {
  const glm::dvec3 total = s.value.total();
  ASSERT_TRUE(std::isfinite(s.pdf) && std::isfinite(total.x) && std::isfinite(total.y) &&
              std::isfinite(total.z))
      << what;
  ASSERT_GE(s.pdf, 0) << what;
  if (s.pdf > 0) {
    ASSERT_NEAR(glm::length(s.direction), 1, 1e-4) << what;
    // A throughput that no sample may have: nothing here reflects more than 1.
    ASSERT_LT(total.x / s.pdf, 1e4) << what;
  }
}

TEST_F(BsdfLobes, HardCasesAreFinite) {
  const auto unit = [](float x, float y, float z) { return glm::normalize(glm::vec3(x, y, z)); };
  const std::vector<glm::vec3> normals = {unit(0, 0, 1), unit(2, 0, 0.01f), unit(0, 0, -1),
                                          unit(-1, 1, -0.2f)};
  for (float white : {0.0f, 1.0f})
    for (float alpha : {0.0f, 3.1e-4f, 3.3e-4f, 1e-3f, 1.0f})
      for (float ior : {1.0f, 1.0009f, 1.0011f, 1e-5f, 0.5f, 1000.0f})
        for (size_t k = 0; k < normals.size(); ++k) {
          LabLobes l;
          l.diffuse = l.specular = l.grazing = l.transmission = l.sheen = glm::vec3(white);
          l.coat = white;
          l.alpha = l.transmission_alpha = alpha;
          l.coat_alpha = k % 2 ? alpha : -alpha;
          l.diffuse_roughness = k % 2 ? -2.0f : 1.0f;
          l.sheen_roughness = k % 2 ? alpha : -1.0f;
          l.ior = l.specular_ior = ior;
          l.normal = l.specular_normal = l.transmission_normal = normals[k];
          l.sheen_normal = l.coat_normal = normals[(k + 1) % normals.size()];
          l.smooth_normal = normals[(k + 2) % normals.size()];
          for (double cosine : {1.0, 1e-4})
            for (const LabSample& s : lab->draw(l, view_at(cosine), 64, 8))
              expect_finite(s, fmt::format("white {} alpha {} ior {} normals {} view {}", white,
                                           alpha, ior, k, cosine));
        }
}

TEST_F(BsdfLobes, OppositeAndEqualDirectionsAreFinite) {
  LabLobes l;
  l.diffuse = l.specular = l.grazing = l.transmission = l.sheen = glm::vec3(1);
  l.coat = 1;
  l.transmission_alpha = 0.5f;
  std::vector<LabPair> pairs;
  for (double cosine : {1.0, 0.5, 1e-6, 0.0}) {
    const glm::dvec3 v = view_at(cosine);
    for (const glm::dvec3& d : {v, -v, mirrored(v), -mirrored(v)})
      pairs.push_back({glm::vec4(v, 0), glm::vec4(d, 0)});
  }
  for (float ior : {1.0f, 1.002f, 1.5f, 0.6f}) {
    l.ior = l.specular_ior = ior;
    for (const LabValue& value : lab->evaluate(l, pairs)) {
      EXPECT_TRUE(std::isfinite(value.pdf) && std::isfinite(value.total().x)) << ior;
      EXPECT_GE(value.pdf, 0);
    }
  }
}

}  // namespace
}  // namespace panoptes::test
