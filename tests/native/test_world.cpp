// The world's light on surfaces and behind them.
#include "support.h"

#include <cmath>
#include <functional>

namespace panoptes::test {
namespace {

using film::Pass;

// The world is summed at the centres of a grid of 256 x 128 directions at least: the midpoint
// rule's error is (pi / 128)^2 / 24 = 2.5e-5 of a smooth world's second derivative.
constexpr double kQuadrature = 2e-4;
// Normals are packed to .0037 degrees.
constexpr double kNormals = 7e-5;

// Squares that face many directions, one below the other in the picture.
const glm::dvec3 kNormalsShown[] = {{0, 0, 1}, {0, 0, -1},       {1, 0, 0},
                                    {0, 1, 0}, {0, -1, 0},       {-1, 0, 0},
                                    {1, 1, 1}, {-0.5, 0.8, 0.2}, {0.3, -1, 0.6}};

// DiffDir of a white square that faces each of the directions above.
void expect_irradiance(const scene::World& world, const std::function<double(glm::dvec3)>& due,
                       double tolerance) {
  for (const glm::dvec3& raw : kNormalsShown) {
    const glm::dvec3 n = glm::normalize(raw);
    const glm::dvec3 side = std::abs(n.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(side, n)), v = glm::cross(n, u);
    TestScene s;
    s.add_object(quad({0, 0, 0}, glm::vec3(u), glm::vec3(v)), {s.add_material(lambert())});
    s.world = world;
    const Picture p =
        render(s, request(orthographic(2.0 * n, {0, 0, 0}, 0.5, 4, 4), {Pass::kDiffDir}));
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(p.value(Pass::kDiffDir, 2, 2, c), due(n), tolerance)
          << n.x << " " << n.y << " " << n.z << " channel " << c;
  }
}

TEST(World, AConstantSkyLightsEveryDirectionAlike) {
  expect_irradiance(
      constant_world(glm::vec3(0.75f)), [](glm::dvec3) { return 0.75; }, 1e-6);
  // The same without being told that it is constant.
  scene::World told = constant_world(glm::vec3(0.75f));
  told.constant.reset();
  expect_irradiance(
      told, [](glm::dvec3) { return 0.75; }, kQuadrature);
}

TEST(World, ALinearSkyIsTwoThirdsAsSteepOnSurfaces) {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1, -2, 0.5));
  expect_irradiance(
      world("vec3 evaluate_world(vec3 d) { return vec3(1.0 + 0.8 * dot(d, param(0).xyz)); }\n",
            {glm::vec4(glm::vec3(axis), 0)}),
      [&](const glm::dvec3& n) { return 1 + 0.8 * 2 / 3 * glm::dot(n, axis); },
      kQuadrature + kNormals);
}

TEST(World, AQuadraticSkyIsAQuarterAsCurvedOnSurfaces) {
  expect_irradiance(
      world("vec3 evaluate_world(vec3 d) {\n"
            "  return vec3(1.0 + 0.3 * (3.0 * d.z * d.z - 1.0) + 0.2 * d.x * d.y +\n"
            "              0.1 * (d.x * d.x - d.y * d.y) - 0.2 * d.y * d.z + 0.1 * d.x * d.z);\n"
            "}\n"),
      [](const glm::dvec3& n) {
        return 1 + 0.25 * (0.3 * (3 * n.z * n.z - 1) + 0.2 * n.x * n.y +
                           0.1 * (n.x * n.x - n.y * n.y) - 0.2 * n.y * n.z + 0.1 * n.x * n.z);
      },
      kQuadrature + kNormals);
}

TEST(World, HalfASkyLightsAPlaneByItsTilt) {
  // White above the horizon: (1 + cos tilt) / 2; the bands that are left out do not matter there.
  expect_irradiance(
      world("vec3 evaluate_world(vec3 d) { return vec3(d.z > 0.0 ? 1.0 : 0.0); }\n"),
      [](const glm::dvec3& n) { return 0.5 * (1 + n.z); }, 2 * kQuadrature);
}

// Combined of a floor with one closure under a sky of radiance 1, seen at a cosine of `nv`.
double in_furnace(const std::string& closure, double nv) {
  TestScene s;
  s.add_object(floor_at(0, 4),
               {s.add_material(
                   material("void evaluate_material(const Hit hit, inout Surface surface) {\n" +
                                closure + "}\n",
                            {}, {.glossy = true, .transmission = true}))});
  s.world = constant_world(glm::vec3(1));
  const gpu_scene::Camera camera =
      orthographic({0, -3 * std::sqrt(1 - nv * nv), 3 * nv}, {0, 0, 0}, 0.01, 3, 3);
  return render(s, request(camera, {})).value(Pass::kCombined, 1, 1);
}

TEST(World, AWhiteFurnaceIsWhite) {
  for (double nv : {1.0, 0.5, 0.2}) {
    EXPECT_NEAR(in_furnace("closure_diffuse(surface, vec3(1.0), vec3(1.0), 0.0, hit.normal);\n",
                           nv),
                1, 1e-5);
    EXPECT_EQ(in_furnace("closure_diffuse(surface, vec3(1.0), vec3(0.0), 0.0, hit.normal);\n", nv),
              0);
    // Refraction loses nothing, whatever its index; one of 1 does not reflect.
    for (const char* ior : {"1.0", "1.5"})
      for (const char* roughness : {"0.0", "1.0"})
        EXPECT_NEAR(
            in_furnace(fmt::format("closure_refraction(hit, surface, vec3(1.0), vec3(1.0), {}, {}, "
                                   "hit.normal);\n",
                                   roughness, ior),
                       nv),
            1, 5e-3);  // transmission is kept in eight bits
    EXPECT_NEAR(in_furnace("closure_glass(hit, surface, vec3(1.0), vec3(1.0), 0.0, 1.0, hit.normal);\n",
                           nv),
                1, 5e-3);
  }
}

// Share of a uniform sky that a white GGX mirror with Smith's masking reflects, by quadrature over
// the microfacets that are visible (a square of stratified points: Heitz 2018).
double ggx_albedo(double roughness, double nv) {
  const double alpha = roughness * roughness;
  const glm::dvec3 v(std::sqrt(1 - nv * nv), 0, nv);
  const glm::dvec3 vh = glm::normalize(glm::dvec3(alpha * v.x, 0, v.z));
  const glm::dvec3 t1 =
      vh.z < 0.9999 ? glm::normalize(glm::cross(glm::dvec3(0, 0, 1), vh)) : glm::dvec3(1, 0, 0);
  const glm::dvec3 t2 = glm::cross(vh, t1);
  const auto lambda = [&](double c) {
    return 0.5 * (std::sqrt(1 + alpha * alpha * (1 - c * c) / (c * c)) - 1);
  };
  const int n = 128;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double r = std::sqrt((i + 0.5) / n), phi = 2 * kPi * (j + 0.5) / n;
      const double p1 = r * std::cos(phi), s = 0.5 * (1 + vh.z);
      const double p2 = (1 - s) * std::sqrt(1 - p1 * p1) + s * r * std::sin(phi);
      const glm::dvec3 nh =
          p1 * t1 + p2 * t2 + std::sqrt(std::max(0.0, 1 - p1 * p1 - p2 * p2)) * vh;
      const glm::dvec3 h =
          glm::normalize(glm::dvec3(alpha * nh.x, alpha * nh.y, std::max(nh.z, 0.0)));
      const double nl = (2 * glm::dot(v, h) * h - v).z;
      if (nl > 0) sum += (1 + lambda(nv)) / (1 + lambda(nv) + lambda(nl));
    }
  return sum / (n * n);
}

TEST(World, AMirrorReflectsWhatItsLobeDoes) {
  EXPECT_NEAR(ggx_albedo(0.05, 0.5), 1,
              2e-3);  // the quadrature itself: smooth mirrors lose nothing
  for (double nv : {1.0, 0.5, 0.2})
    for (double roughness : {0.1, 0.3, 0.6, 1.0}) {
      const double due = ggx_albedo(roughness, nv);
      const double seen =
          in_furnace(fmt::format("closure_glossy(surface, vec3(1.0), vec3(1.0), {}, hit.normal);\n",
                                 roughness),
                     nv);
      EXPECT_NEAR(seen, due, 0.05 * due) << "roughness " << roughness << ", cosine " << nv;
    }
}

TEST(World, LightIsNeverNegative) {
  // A small bright patch: the nine harmonics ring below zero on its far side.
  TestScene s;
  s.add_object(sphere({0, 0, 0}, 1, 16), {s.add_material(lambert())});
  s.world = world("vec3 evaluate_world(vec3 d) { return vec3(d.x > 0.98 ? 100.0 : 0.0); }\n");
  const Picture p =
      render(s, request(perspective({-4, 1, 0}, {0, 0, 0}, 0.6, 32, 32), {Pass::kDiffDir}));
  for (float v : p[Pass::kDiffDir]) ASSERT_GE(v, 0);
}

TEST(World, IsSeenBehindTheScene) {
  const char* code = "vec3 evaluate_world(vec3 d) { return d * 0.5 + 0.5; }\n";
  TestScene s;
  s.add_object(floor_at(0, 0.5f), {s.add_material(lambert())});
  s.world = world(code);
  for (const gpu_scene::Camera& camera :
       {perspective({0.5, -2, 1}, {0, 0, 0.3}, 1.2, 40, 30),
        perspective({0.5, -2, 1}, {0, 0, 0.3}, 1.2, 40, 30, 0.01, 100, {0.2, -0.3}),
        orthographic({0.5, -2, 1}, {0, 0, 0.3}, 1, 40, 30)}) {
    const Picture p = render(s, request(camera, {Pass::kEnv, Pass::kDepth}));
    Worst env;
    int covered = 0;
    for (int y = 0; y < p.height; ++y)
      for (int x = 0; x < p.width; ++x) {
        const bool behind = p.value(Pass::kDepth, x, y) > 1e9;
        covered += !behind;
        const glm::dvec3 d = pixel_ray(camera, x, y).direction;
        for (int c = 0; c < 3; ++c) {
          const double due = behind ? d[c] * 0.5 + 0.5 : 0;
          env.compare(p.value(Pass::kEnv, x, y, c), due, 1e-2, x, y);
          if (behind) {
            EXPECT_EQ(p.value(Pass::kCombined, x, y, c), p.value(Pass::kEnv, x, y, c));
          }
        }
        EXPECT_EQ(p.value(Pass::kCombined, x, y, 3), 1);
      }
    EXPECT_GT(covered, 20);
    EXPECT_WORST_BELOW(env, 1e-5);
  }
}

TEST(World, IsLeftOutOfATransparentFilm) {
  TestScene s;
  s.add_object(floor_at(0, 0.5f), {s.add_material(lambert())});
  s.world = constant_world(glm::vec3(0.5f));
  engine::RenderRequest r = request(orthographic({0, 0, 2}, {0, 0, 0}, 1, 32, 32), {Pass::kEnv});
  r.transparent_film = true;
  const Picture p = render(s, r);
  EXPECT_EQ(p.value(Pass::kCombined, 1, 1, 3), 0);
  EXPECT_EQ(p.rgb(Pass::kCombined, 1, 1), glm::dvec3(0));
  EXPECT_EQ(p.rgb(Pass::kEnv, 1, 1), glm::dvec3(0.5));
  EXPECT_EQ(p.value(Pass::kCombined, 16, 16, 3), 1);
  EXPECT_NEAR(p.value(Pass::kCombined, 16, 16), 0.5, 1e-5);
}

// --- environment images --------------------------------------------------------------------------

// An equirectangular map of f(direction), in Blender's orientation: +X at the middle column's
// centre line, +Y a quarter to its left, +Z at the top row.
std::vector<float> equirectangular(int width, int height,
                                   const std::function<glm::dvec3(glm::dvec3)>& f) {
  std::vector<float> pixels;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double phi = -((x + 0.5) / width - 0.5) * 2 * kPi, v = ((y + 0.5) / height - 0.5) * kPi;
      const glm::dvec3 c =
          f({std::cos(v) * std::cos(phi), std::cos(v) * std::sin(phi), std::sin(v)});
      pixels.insert(pixels.end(), {float(c.r), float(c.g), float(c.b), 1.0f});
    }
  return pixels;
}

glm::dvec3 smooth(const glm::dvec3& d) { return d * 0.4 + 0.5; }

constexpr const char* kImageWorld =
    "vec3 evaluate_world(vec3 direction) {\n"
    "  vec2 uv = vec2(-atan(direction.y, direction.x) * 0.15915494 + 0.5,\n"
    "                 atan(direction.z, length(direction.xy)) * 0.31830989 + 0.5);\n"
    "  return sample_image_wide(0, uv, 0.0, false).rgb;\n"
    "}\n";

TestScene under_image(scene::Image image) {
  TestScene s;
  s.add_object(floor_at(0, 0.5f), {s.add_material(lambert())});
  s.world = world(kImageWorld);
  s.world.textures = {{s.add_image(std::move(image))}};
  return s;
}

const glm::dvec3 kLooks[] = {{1, 0.1, 0}, {-1, 0.05, 0.1}, {0, 1, 0},
                             {0, -1, 0},  {0.1, 0, 1},     {0, 0.2, -1}};

TEST(World, ImagesKeepBlendersOrientation) {
  const std::vector<float> pixels = equirectangular(256, 128, smooth);
  TestScene s = under_image(scene::make_image("sky", 256, 128, std::span<const float>(pixels),
                                              false, scene::AlphaMode::kNone));
  for (const glm::dvec3& look : kLooks) {
    const gpu_scene::Camera camera =
        perspective({0, 0, 3}, glm::dvec3(0, 0, 3) + look, 0.5, 16, 16);
    const Picture p = render(s, request(camera, {Pass::kEnv, Pass::kDepth}));
    Worst worst;
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) {
        if (p.value(Pass::kDepth, x, y) < 1e9) continue;
        const glm::dvec3 due = smooth(pixel_ray(camera, x, y).direction);
        for (int c = 0; c < 3; ++c) worst.compare(p.value(Pass::kEnv, x, y, c), due[c], 0.1, x, y);
      }
    // Linear interpolation over 1.4 degrees; next to the poles the rows end half a texel early.
    EXPECT_WORST_BELOW(worst, std::abs(look.z) > 0.5 ? 0.05 : 2e-3);
  }
}

TEST(World, ImagesLightSurfacesAsTheyLook) {
  const std::vector<float> pixels = equirectangular(256, 128, smooth);
  TestScene s = under_image(scene::make_image("sky", 256, 128, std::span<const float>(pixels),
                                              false, scene::AlphaMode::kNone));
  const Picture p =
      render(s, request(orthographic({0, 0, 2}, {0, 0, 0}, 0.4, 4, 4), {Pass::kDiffDir}));
  EXPECT_NEAR(p.value(Pass::kDiffDir, 2, 2, 0), 0.5, 1e-3);
  EXPECT_NEAR(p.value(Pass::kDiffDir, 2, 2, 2), 0.5 + 0.4 * 2 / 3, 1e-3);
}

TEST(World, ByteImagesAreLinearised) {
  // A uniform grey of sRGB code 128: .2158605 in linear light.
  const std::vector<uint8_t> grey(4 * 8 * 4, 128);
  TestScene s = under_image(scene::make_image("sky", 8, 4, std::span<const uint8_t>(grey), true,
                                              scene::AlphaMode::kNone));
  const gpu_scene::Camera camera = perspective({0, -2, 1}, {0, 0, 0}, 1.2, 16, 16);
  const Picture p = render(s, request(camera, {Pass::kEnv, Pass::kDiffDir}));
  EXPECT_NEAR(p.value(Pass::kEnv, 8, 15), 0.2158605, 1e-4);
  EXPECT_NEAR(p.value(Pass::kDiffDir, 8, 8), 0.2158605, 1e-4);
}

TEST(World, AMissingImageIsMagenta) {
  TestScene s;
  s.world = world(kImageWorld);
  s.world.textures = {{99}};
  const Picture p = render(s, request(perspective({0, -2, 1}, {0, 0, 0}, 1.2, 8, 8), {Pass::kEnv}));
  EXPECT_EQ(p.rgb(Pass::kEnv, 4, 4), glm::dvec3(1, 0, 1));
}

TEST(World, ChangesAreSeenAndFelt) {
  TestScene s;
  s.add_object(floor_at(0, 0.5f), {s.add_material(lambert())});
  s.world = constant_world({0.25f, 0.5f, 1});
  const engine::RenderRequest r =
      request(orthographic({0, 0, 2}, {0, 0, 0}, 1, 16, 16), {Pass::kEnv, Pass::kDiffDir});
  for (float level : {0.25f, 1.0f, 0.5f, 0.0f}) {
    shared_engine().edit([&](scene::Scene& scene) {
      if (level == 0.25f) s.install(scene);
      scene.set_world(constant_world(glm::vec3(level)));
    });
    const Picture p = render(r);
    EXPECT_NEAR(p.value(Pass::kEnv, 1, 1), level, 1e-6);
    EXPECT_NEAR(p.value(Pass::kDiffDir, 8, 8), level, 1e-6);
  }
}

TEST(World, BrokenCodeIsShownBlackWithAWarning) {
  TestScene s;
  s.world = world("this is no GLSL");
  const Picture p = render(s, request(perspective({0, -2, 1}, {0, 0, 0}, 1.2, 8, 8), {Pass::kEnv}));
  for (float v : p[Pass::kEnv]) ASSERT_EQ(v, 0);
  ASSERT_EQ(p.stats.warnings.size(), 1u);
  EXPECT_NE(p.stats.warnings[0].find("world is shown black"), std::string::npos);
}

}  // namespace
}  // namespace panoptes::test
