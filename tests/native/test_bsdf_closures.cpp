// Closures as the path tracer has them, from the material's code to the share of white light that goes
// to the viewer: against Cycles, and against 1 where nothing may be lost.
#include "bsdf_lab.h"

#include <array>
#include <cmath>

namespace panoptes::test {
namespace {

class BsdfClosures : public BsdfTest {
 protected:
  struct Albedo {
    double mean = 0, error = 0;  // and its standard error
  };
  // Of the cosines .98, .6 and .2 between view and normal: on the front, and then on the back.
  static std::array<Albedo, 6> albedos(const std::string& code, int draws = 1 << 16) {
    const std::string body = "const uint DRAWS = " + std::to_string(draws) + R"(u;
vec4 lab(uint i) {
  uint which = i / DRAWS;
  float cosine = which % 3u == 0u ? 0.98 : (which % 3u == 1u ? 0.6 : 0.2);
  Hit hit;
  hit.normal = hit.geometric_normal = hit.normal_unflipped = vec3(0.0, 0.0, 1.0);
  hit.view = vec3(sqrt(1.0 - cosine * cosine), 0.0, cosine);
  hit.backfacing = which >= 3u;
  vec3 white = vec3(1.0);
  Principled p = principled_defaults(hit);
  p.specular_tint = p.sheen_tint = vec3(0.0);
  Surface surface = empty_surface();
  surface.seed = hash(7u * i + 3u);
)" + code + R"(
  finish_surface(hit, surface);
  uvec4 texels[LOBES_TEXELS];
  pack_lobes(lobes_of(hit, surface), texels);
  Lobes l = unpack_lobes(texels, hit.view);
  BsdfSample s = bsdf_sample(l, vec3(unit_float(hash(3u * i)), unit_float(hash(3u * i + 1u)),
                                     unit_float(hash(3u * i + 2u))));
  if (s.pdf <= 0.0) return vec4(0.0);
  return vec4(s.value.diffuse + s.value.glossy + s.value.transmission, 0.0) / s.pdf;
}
)";
    const std::vector<glm::vec4> values = lab->run(body, 6 * draws);
    std::array<Albedo, 6> result;
    for (int k = 0; k < 6; ++k) {
      double squares = 0;
      for (int i = 0; i < draws; ++i) {
        const double value = values[size_t(k) * draws + i].x;
        result[k].mean += value / draws;
        squares += value * value / draws;
      }
      result[k].error =
          std::sqrt(std::max(squares - result[k].mean * result[k].mean, 0.0) / draws);
    }
    return result;
  }
};

// A plane under a white world, rendered by Cycles 3.4 with 65 536 samples. A back is listed where
// Cycles agrees with what its own model says: its refraction lets light go on that leaves on the
// viewer's side. Nor is its clear coat listed, whose samples do not follow its own density.
TEST_F(BsdfClosures, SendBackWhatTheyDoInCycles) {
  struct Row {
    const char* code;
    double front[3], back[3];
  };
  const Row rows[] = {
      {"closure_diffuse(surface, white, white, 1.0, hit.normal);", {0.77719, 0.84036, 0.94720}, {}},
      {"p.base_color = white; p.specular = 0.0; p.roughness = 1.0;"
       "closure_principled_v3(surface, white, p);",
       {1.03548, 1.04053, 1.24533},
       {}},
      {"closure_principled_v3(surface, white, p);", {0.84190, 0.85918, 0.94918}, {}},
      {"p.base_color = vec3(0.5); p.metallic = 1.0; p.roughness = 0.4;"
       "closure_principled_v3(surface, white, p);",
       {0.48371, 0.48252, 0.50685},
       {}},
      {"closure_glossy(surface, white, white, 0.2, hit.normal);", {0.99830, 0.99668, 0.97515}, {}},
      {"closure_glossy(surface, white, white, 0.5, hit.normal);", {0.91414, 0.87048, 0.83134}, {}},
      {"closure_glossy(surface, white, white, 1.0, hit.normal);", {0.31002, 0.38354, 0.51141}, {}},
      {"closure_glass(hit, surface, white, white, 0.2, 1.5, hit.normal);",
       {0.99992, 0.99957, 0.99137},
       {0.99768, 0.99692, 0.97536}},
      {"closure_glass(hit, surface, white, white, 0.7, 1.5, hit.normal);",
       {0.98259, 0.93083, 0.78702},
       {0.74429, 0.68773, 0}},
      {"closure_refraction(hit, surface, white, white, 0.7, 1.5, hit.normal);",
       {0.99451, 0.94765, 0.80938},
       {0.74645, 0, 0}},
      {"closure_velvet(surface, white, white, 1.0, hit.normal);", {0.20758, 0.51824, 0.85150}, {}},
      {"p.base_color = white; p.transmission = 1.0; p.specular = 0.0; p.roughness = 0.3; p.ior = 1.5;"
       "closure_principled_v3(surface, white, p);",
       {0.99962, 0.99796, 0.96867},
       {0.98886, 0.98219, 0.91366}}};
  for (const Row& row : rows) {
    const std::array<Albedo, 6> seen = albedos(row.code);
    for (int k = 0; k < 6; ++k) {
      const double due = k < 3 ? row.front[k] : row.back[k - 3];
      if (due == 0) continue;
      EXPECT_NEAR(seen[k].mean, due, 0.002 * due + 4 * seen[k].error) << row.code << " " << k;
      EXPECT_LT(seen[k].error, 0.005 * due) << "too noisy to judge: " << row.code << " " << k;
    }
  }
}

TEST_F(BsdfClosures, WhiteThingsOfSeveralBouncesLoseNothing) {
  for (const char* code :
       {"closure_glossy_multiscatter(hit, surface, white, white, 0.2, hit.normal);",
        "closure_glossy_multiscatter(hit, surface, white, white, 0.6, hit.normal);",
        "closure_glossy_multiscatter(hit, surface, white, white, 1.0, hit.normal);",
        "closure_glass_multiscatter(hit, surface, white, white, 0.0, 1.5, hit.normal);",
        "closure_glass_multiscatter(hit, surface, white, white, 0.3, 1.5, hit.normal);",
        "closure_glass_multiscatter(hit, surface, white, white, 0.9, 1.33, hit.normal);",
        "p.multiscatter = true; p.metallic = 1.0; p.base_color = white; p.roughness = 0.7;"
        "closure_principled_v3(surface, white, p);",
        "p.multiscatter = true; p.base_color = white; p.specular_tint = white; p.roughness = 0.2;"
        "closure_principled_v4(surface, white, p);",
        "p.multiscatter = true; p.base_color = white; p.specular_tint = white; p.roughness = 0.7;"
        "p.coat = 1.0; p.coat_roughness = 0.5; closure_principled_v4(surface, white, p);"})
    for (const Albedo& albedo : albedos(code, 3 << 15)) {
      EXPECT_NEAR(albedo.mean, 1, 0.005 + 3 * albedo.error) << code;
      EXPECT_LT(albedo.error, 0.004) << "too noisy to judge: " << code;
    }
}

TEST_F(BsdfClosures, ASheenTakesFromWhatLiesBelow) {
  for (const Albedo& albedo :
       albedos("p.base_color = p.specular_tint = p.sheen_tint = white; p.sheen = 1.0;"
               "closure_principled_v4(surface, white, p);"))
    // What the sheen takes is a fit.
    EXPECT_NEAR(albedo.mean, 1, 0.01 + 3 * albedo.error);
}

// Blender 4.3's Cycles: metals of base colour .5, with roughness 1 and, Principled, .7.
TEST_F(BsdfClosures, FurtherBouncesDeepenTheColourOfMetal) {
  const std::array<Albedo, 6> glossy =
      albedos("closure_glossy_multiscatter(hit, surface, white, vec3(0.5), 1.0, hit.normal);");
  const std::array<Albedo, 6> metal =
      albedos("p.multiscatter = true; p.metallic = 1.0; p.base_color = vec3(0.5); p.roughness = 0.7;"
              "closure_principled_v4(surface, white, p);");
  const double due[2][3] = {{0.2554, 0.2912, 0.3728}, {0.4148, 0.4176, 0.4652}};
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(glossy[k].mean, due[0][k], 0.02 * due[0][k]);
    EXPECT_NEAR(metal[k].mean, due[1][k], 0.02 * due[1][k]);
  }
}

}  // namespace
}  // namespace panoptes::test
