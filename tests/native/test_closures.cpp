// Closures under a sun, against their formulas.
#include "support.h"

#include <cmath>

namespace panoptes::test {
namespace {

using film::Pass;

constexpr double kRounding = 2e-5;
// Albedos are kept in half floats, eleven bits; llvmpipe cuts off where others round.
constexpr double kHalf = 1.0 / 1024;

// A floor seen in perspective at many angles, under one sun of strength pi.
const gpu_scene::Camera kCamera = perspective({0.3, -2.2, 1.1}, {0, 0.3, 0}, 0.5, 32, 24);
const glm::dvec3 kToSun = glm::normalize(glm::dvec3(0.8, 0.3, 0.6));

TestScene floor_of(scene::Material m) {
  TestScene s;
  s.add_object(floor_at(0, 8), {s.add_material(std::move(m))});
  s.lights = {sun(glm::vec3(-kToSun), float(kPi))};
  s.lights[0].cast_shadow = false;
  return s;
}

// V and the cosines at a pixel of the floor.
struct Angles {
  double nl, nv, lh, nh;
  explicit Angles(int x, int y) {
    const glm::dvec3 v = -pixel_ray(kCamera, x, y).direction;
    const glm::dvec3 h = glm::normalize(v + kToSun);
    nl = kToSun.z;
    nv = v.z;
    lh = glm::dot(kToSun, h);
    nh = h.z;
  }
};

std::string principled(const std::string& version, const std::string& settings) {
  return "void evaluate_material(const Hit hit, inout Surface surface) {\n"
         "  Principled p = principled_defaults(hit);\n" +
         settings + "  closure_principled_v" + version + "(surface, vec3(1.0), p);\n}\n";
}

TEST(Closures, LambertSendsItsAlbedoBack) {
  const glm::dvec3 albedo(0.8, 0.2, 0.05);
  const Picture p = render(floor_of(lambert(glm::vec3(albedo))),
                           request(kCamera, {Pass::kDiffDir, Pass::kDiffCol}));
  Worst color, light, combined;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x)
      for (int c = 0; c < 3; ++c) {
        color.compare(p.value(Pass::kDiffCol, x, y, c), albedo[c], 1e-3, x, y);
        light.compare(p.value(Pass::kDiffDir, x, y, c), kToSun.z, 1e-3, x, y);
        combined.compare(p.value(Pass::kCombined, x, y, c), albedo[c] * kToSun.z, 1e-3, x, y);
      }
  EXPECT_WORST_BELOW(color, kHalf);
  EXPECT_WORST_BELOW(light, kRounding);
  EXPECT_WORST_BELOW(combined, kHalf);
}

TEST(Closures, PrincipledBeforeFourIsBurley) {
  for (float roughness : {0.0f, 0.5f, 1.0f}) {
    scene::Material m = material(
        principled("3",
                   "p.base_color = vec3(0.6);\n p.specular = 0.0;\n p.roughness = param(0).x;\n"),
        {glm::vec4(roughness)});
    const Picture p = render(floor_of(m), request(kCamera, {Pass::kDiffDir, Pass::kDiffCol}));
    Worst worst, color;
    for (int y = 0; y < p.height; ++y)
      for (int x = 0; x < p.width; ++x) {
        const Angles a(x, y);
        const double f90 = 0.5 + 2 * roughness * a.lh * a.lh;
        const double due = a.nl * (1 + (f90 - 1) * std::pow(1 - a.nl, 5)) *
                           (1 + (f90 - 1) * std::pow(1 - a.nv, 5));
        worst.compare(p.value(Pass::kDiffDir, x, y), due, 1e-3, x, y);
        color.compare(p.value(Pass::kDiffCol, x, y), 0.6, 0.1, x, y);
      }
    EXPECT_WORST_BELOW(color, kHalf);
    // The lobe's roughness is kept in a half float as well.
    EXPECT_WORST_BELOW(worst, kRounding + kHalf * (roughness > 0));
  }
}

TEST(Closures, PrincipledFromFourIsLambert) {
  scene::Material m =
      material(principled("4", "p.specular = 0.0;\n p.base_color = vec3(0.5);\n"), {});
  const Picture p = render(floor_of(m), request(kCamera, {Pass::kDiffDir}));
  Worst worst;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x)
      worst.compare(p.value(Pass::kDiffDir, x, y), kToSun.z, 1e-3, x, y);
  EXPECT_WORST_BELOW(worst, kRounding);
}

TEST(Closures, MetalAndGlassLeaveNoDiffuseColour) {
  // DiffCol = base * (1 - metallic) * (1 - transmission); DiffDir stays the light alone.
  for (const auto& [metallic, transmission] :
       {std::pair(0.5f, 0.0f), {0.0f, 0.25f}, {0.5f, 0.5f}}) {
    scene::Material m =
        material(principled("4", "p.base_color = vec3(0.8);\n p.metallic = param(0).x;\n"
                                 "p.transmission = param(0).y;\n p.specular = 0.0;\n"),
                 {glm::vec4(metallic, transmission, 0, 0)}, {.glossy = true, .transmission = true});
    const Picture p = render(floor_of(m), request(kCamera, {Pass::kDiffDir, Pass::kDiffCol}));
    const double due = 0.8 * (1 - metallic) * (1 - transmission);
    EXPECT_NEAR(p.value(Pass::kDiffCol, 16, 12), due, due * 2 * kHalf);
    EXPECT_NEAR(p.value(Pass::kDiffDir, 16, 12), kToSun.z, kRounding);
  }
  const Picture p =
      render(floor_of(material(principled("3", "p.metallic = 1.0;\n"), {}, {.glossy = true})),
             request(kCamera, {Pass::kDiffDir, Pass::kDiffCol}));
  EXPECT_EQ(p.value(Pass::kDiffCol, 16, 12), 0);
  EXPECT_EQ(p.value(Pass::kDiffDir, 16, 12), 0);
}

double ggx(double nl, double nv, double nh, double alpha) {
  const double a2 = alpha * alpha;
  const double t = nh * nh * (a2 - 1) + 1;
  const double d = a2 / (kPi * t * t);
  const double v =
      0.5 / (nl * std::sqrt(a2 + (1 - a2) * nv * nv) + nv * std::sqrt(a2 + (1 - a2) * nl * nl));
  return d * v;
}

TEST(Closures, AWhiteMirrorIsGgxWithSmithMasking) {
  for (float roughness : {0.3f, 0.7f, 1.0f}) {
    scene::Material m =
        material("void evaluate_material(const Hit hit, inout Surface surface) {\n"
                 "  closure_glossy(surface, vec3(1.0), vec3(1.0), param(0).x, hit.normal);\n"
                 "}\n",
                 {glm::vec4(roughness)}, {.glossy = true});
    const Picture p = render(floor_of(m), request(kCamera, {Pass::kGlossDir, Pass::kGlossCol}));
    Worst worst;
    const double alpha = double(roughness) * roughness;
    for (int y = 0; y < p.height; ++y)
      for (int x = 0; x < p.width; ++x) {
        const Angles a(x, y);
        worst.compare(p.value(Pass::kGlossDir, x, y), kPi * a.nl * ggx(a.nl, a.nv, a.nh, alpha),
                      1e-2, x, y);
        EXPECT_EQ(p.value(Pass::kGlossCol, x, y), 1);
      }
    // Roughness is a half float, and enters by its fourth power.
    EXPECT_WORST_BELOW(worst, 8 * kHalf);
  }
}

TEST(Closures, NothingReflectsWithoutSpecular) {
  const Picture p =
      render(floor_of(material(principled("3", "p.specular = 0.0;\n"), {}, {.glossy = true})),
             request(kCamera, {Pass::kGlossDir, Pass::kGlossCol}));
  for (float v : p[Pass::kGlossDir]) ASSERT_EQ(v, 0);
  for (float v : p[Pass::kGlossCol]) ASSERT_EQ(v, 0);
}

TEST(Closures, ReflectionNeverExceedsTheLightThatArrives) {
  // Under lamps all over the hemisphere, of radiance 1: the directional albedo of a white mirror is
  // that of the formula, and never above 1.
  const gpu_scene::Camera camera = orthographic({0, -3, 2}, {0, 0, 0}, 0.01, 1, 1);
  const glm::dvec3 v = glm::normalize(glm::dvec3(0, -3, 2));
  for (float roughness : {0.25f, 0.6f, 1.0f}) {
    TestScene s = floor_of(
        material("void evaluate_material(const Hit hit, inout Surface surface) {\n"
                 "  closure_glossy(surface, vec3(1.0), vec3(1.0), param(0).x, hit.normal);\n"
                 "}\n",
                 {glm::vec4(roughness)}, {.glossy = true}));
    s.lights.clear();
    const int rings = 32, sectors = 64;
    double due = 0;
    for (int i = 0; i < rings; ++i)
      for (int j = 0; j < sectors; ++j) {
        const double theta = 0.5 * kPi * (i + 0.5) / rings, phi = 2 * kPi * (j + 0.5) / sectors;
        const double solid_angle = std::sin(theta) * (0.5 * kPi / rings) * (2 * kPi / sectors);
        const glm::dvec3 l(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                           std::cos(theta));
        s.lights.push_back(sun(glm::vec3(-l), float(solid_angle)));
        s.lights.back().cast_shadow = false;
        due += solid_angle * l.z *
               ggx(l.z, v.z, glm::normalize(l + v).z, double(roughness) * roughness);
      }
    const double albedo =
        render(s, request(camera, {Pass::kGlossDir})).value(Pass::kGlossDir, 0, 0);
    EXPECT_NEAR(albedo, due, 8 * kHalf * due) << roughness;
    EXPECT_LT(albedo, 1) << roughness;
  }
}

TEST(Closures, MixedColoursAddUp) {
  const Picture p =
      render(floor_of(material(
                 "void evaluate_material(const Hit hit, inout Surface surface) {\n"
                 "  closure_diffuse(surface, vec3(0.25), vec3(1.0, 0.0, 0.0), 0.0, hit.normal);\n"
                 "  closure_diffuse(surface, vec3(0.75), vec3(0.0, 1.0, 0.0), 0.0, hit.normal);\n"
                 "  closure_emission(surface, vec3(0.5), vec3(3.0));\n"
                 "  closure_emission(surface, vec3(1.0), vec3(0.25));\n"
                 "}\n",
                 {}, {.emission = true, .glossy = false})),
             request(kCamera, {Pass::kDiffCol, Pass::kEmit}));
  EXPECT_EQ(p.rgb(Pass::kDiffCol, 16, 12), glm::dvec3(0.25, 0.75, 0));
  EXPECT_EQ(p.rgb(Pass::kEmit, 16, 12), glm::dvec3(1.75));
}

TEST(Closures, TheDefaultMaterialIsBlendersGrey) {
  TestScene s;
  s.add_object(floor_at(0, 8), {0});
  s.lights = {sun({0, 0, -1}, float(kPi))};
  const Picture p = render(s, request(kCamera, {Pass::kDiffCol, Pass::kGlossCol}));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(p.value(Pass::kDiffCol, 16, 12, c), 0.8, 0.8 * kHalf);
  EXPECT_EQ(p.value(Pass::kGlossCol, 16, 12), 1);
}

TEST(Closures, BrokenMaterialsShowMagentaAndWarn) {
  TestScene s = floor_of(material("this is no GLSL", {}));
  s.materials[0].name = "Rusty";
  Picture p = render(s, request(kCamera, {Pass::kDiffCol}));
  EXPECT_EQ(p.rgb(Pass::kDiffCol, 16, 12), glm::dvec3(1, 0, 1));
  ASSERT_EQ(p.stats.warnings.size(), 1u);
  EXPECT_NE(p.stats.warnings[0].find("'Rusty' shows magenta"), std::string::npos)
      << p.stats.warnings[0];
  p = render(request(kCamera, {Pass::kDiffCol}));
  EXPECT_EQ(p.stats.warnings.size(), 1u) << "the warning must stay and must not pile up";
  // Mended, it is shown again and the warning is gone.
  s.materials[0] = lambert({0.5f, 0.25f, 1});
  p = render(s, request(kCamera, {Pass::kDiffCol}));
  EXPECT_EQ(p.rgb(Pass::kDiffCol, 16, 12), glm::dvec3(0.5, 0.25, 1));
  EXPECT_TRUE(p.stats.warnings.empty());
}

}  // namespace
}  // namespace panoptes::test
