// Hard geometry and cameras: finite everywhere, the same picture twice, close to the reference.
#include "still_life.h"
#include "support.h"

#include <cmath>
#include <limits>

namespace panoptes::test {
namespace {

using film::Pass;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

// Shadow edges may fall to the other side of a few pixels' centres when everything is rounded
// differently: not more than 4 in 2304 pixels.
void expect_same_picture(const Picture& a, const Picture& b, const std::string& label) {
  int different = 0;
  for (size_t i = 0; i < a[Pass::kCombined].size(); i += 4) {
    double error = 0;
    for (size_t c = 0; c < 3; ++c)
      error =
          std::max<double>(error, std::abs(a[Pass::kCombined][i + c] - b[Pass::kCombined][i + c]));
    different += error > 2e-3 * std::max(b[Pass::kCombined][i], 0.1f);
  }
  EXPECT_LE(different, 4) << label << ": relative RMSE "
                          << relative_rmse(a[Pass::kCombined], b[Pass::kCombined]);
}

TEST(HardCases, ThePictureIsTheSameAtEveryScale) {
  const StillLife life = still_life();
  const Picture due = render(life.scene, request(life.camera, {Pass::kDepth}));
  for (float scale : {1e-3f, 1.0f / 1024, 1024.0f, 1e3f}) {
    const StillLife other = still_life(scale);
    const Picture p = render(other.scene, request(other.camera, {Pass::kDepth}));
    expect_same_picture(p, due, fmt::format("scale {}", scale));
    for (size_t i = 0; i < due[Pass::kDepth].size(); ++i)
      if (due[Pass::kDepth][i] < 1e9f) {
        ASSERT_NEAR(p[Pass::kDepth][i], due[Pass::kDepth][i] * scale,
                    2e-5 * due[Pass::kDepth][i] * scale);
      }
  }
}

TEST(HardCases, ThePictureIsTheSameFarFromTheOrigin) {
  const StillLife life = still_life();
  const Picture due = render(life.scene, request(life.camera, {Pass::kDepth}));
  for (const glm::dvec3& origin :
       {glm::dvec3(1048576, 0, 0), glm::dvec3(-1048576, 1048576, 524288)}) {
    const StillLife other = still_life(1, origin);
    const Picture p = render(other.scene, request(other.camera, {Pass::kDepth}));
    expect_same_picture(p, due, "2^20 m away");
    for (size_t i = 0; i < due[Pass::kDepth].size(); ++i)
      if (due[Pass::kDepth][i] < 1e9f) {
        ASSERT_NEAR(p[Pass::kDepth][i], due[Pass::kDepth][i], 2e-5 * due[Pass::kDepth][i]);
      }
  }
}

TEST(HardCases, MillimetresAndKilometresInOneScene) {
  // A cube of a millimetre on a plain of ten kilometres, seen close by.
  TestScene s;
  const Id white = s.add_material(lambert());
  s.add_object(floor_at(0, 10000), {white});
  s.add_object(box({0, 0, 0.0005f}, glm::vec3(0.0005f)), {white});
  s.lights = {point({0.002f, -0.003f, 0.004f}, 1e-4f)};
  const gpu_scene::Camera camera =
      perspective({0.001, -0.004, 0.003}, {0, 0, 0.0005}, 0.7, 32, 32, 1e-4, 1e5);
  const Picture p = render(s, request(camera, {Pass::kDepth, Pass::kDiffDir}));
  const glm::dvec3 lamp(0.002f, -0.003f, 0.004f);
  Worst depth, light;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const Ray ray = pixel_ray(camera, x, y);
      const glm::dvec3 on_top = on_plane(ray, {0, 0, 0.001}, {0, 0, 1});
      if (std::max(std::abs(on_top.x), std::abs(on_top.y)) > 0.00049) continue;
      const double due = -(camera.world_to_camera * glm::dvec4(on_top, 1)).z;
      depth.compare(p.value(Pass::kDepth, x, y), due, 1e-9, x, y);
      const glm::dvec3 d = lamp - on_top;
      const double squared = glm::dot(d, d);
      light.compare(p.value(Pass::kDiffDir, x, y),
                    1e-4 / (4 * kPi * kPi * squared) * d.z / std::sqrt(squared), 1e-9, x, y);
    }
  EXPECT_GT(depth.count(), 20);
  EXPECT_WORST_BELOW(depth, 1e-5);
  EXPECT_WORST_BELOW(light, 1e-4);
}

TEST(HardCases, NarrowAndWideFieldsOfView) {
  for (double degrees : {1.0, 179.0}) {
    const double distance = degrees < 90 ? 100 : 1;
    TestScene s;
    s.add_object(floor_at(0, 300), {s.add_material(lambert())});
    s.lights = {sun({0.3f, 0.2f, -1}, float(kPi))};
    const gpu_scene::Camera camera =
        perspective({0, 0, distance}, {0, 0, 0}, degrees * kPi / 180, 32, 32, 0.01, 1000);
    const Picture p = render(s, request(camera, {Pass::kDepth, Pass::kDiffDir, Pass::kNormal}));
    Worst depth, light;
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x) {
        depth.compare(p.value(Pass::kDepth, x, y), distance, 1, x, y);
        light.compare(p.value(Pass::kDiffDir, x, y), 1 / std::sqrt(1.13), 1, x, y);
      }
    EXPECT_WORST_BELOW(depth, 1e-5);
    EXPECT_WORST_BELOW(light, 1e-4);
  }
}

TEST(HardCases, AwkwardSizes) {
  const StillLife life = still_life();
  for (const auto& [w, h] : {std::pair(1, 1), {3, 1}, {1, 5}, {17, 13}, {129, 3}}) {
    engine::RenderRequest r = request(life.camera, {Pass::kDepth, Pass::kNormal}, 2);
    r.camera.width = w;
    r.camera.height = h;
    const Picture p = render(life.scene, r);
    EXPECT_EQ(p[Pass::kCombined].size(), size_t(w * h * 4));
    EXPECT_GT(mean(p[Pass::kCombined]), 0.3);
    EXPECT_EQ(p.stats.width, w);
    EXPECT_EQ(p.stats.height, h);
  }
}

TEST(HardCases, NothingToRenderIsAnError) {
  const StillLife life = still_life();
  engine::RenderRequest r = request(life.camera, {});
  r.last_sample = 0;
  expect_error([&] { shared_engine().render(r); }, "at least one sample");
  r = request(life.camera, {});
  r.camera.height = 0;
  expect_error([&] { shared_engine().render(r); }, "48x0");
  r = request(life.camera, {});
  r.camera.world_to_camera[3].x = kNaN;
  expect_error([&] { shared_engine().render(r); }, "not finite");
}

TEST(HardCases, AnEmptySceneIsBlackOrSky) {
  const gpu_scene::Camera camera = perspective({0, -3, 1}, {0, 0, 0}, 0.8, 16, 16);
  TestScene s;
  Picture p = render(s, request(camera, {Pass::kDepth, Pass::kNormal, Pass::kDiffDir}, 3));
  for (size_t i = 0; i < p[Pass::kCombined].size(); ++i)
    ASSERT_EQ(p[Pass::kCombined][i], i % 4 == 3 ? 1 : 0);
  for (float d : p[Pass::kDepth]) ASSERT_EQ(d, 1e10f);
  s.lights = {sun({0, 0, -1}, 5), point({0, 0, 0}, 5)};
  p = render(s, request(camera, {}));
  for (size_t i = 0; i < p[Pass::kCombined].size(); i += 4) ASSERT_EQ(p[Pass::kCombined][i], 0);
  s.world = constant_world(glm::vec3(0.25f));
  p = render(s, request(camera, {}));
  for (size_t i = 0; i < p[Pass::kCombined].size(); i += 4) ASSERT_EQ(p[Pass::kCombined][i], 0.25f);
}

TEST(HardCases, MeshesWithoutTrianglesAndInstancesWithoutMeshes) {
  TestScene s = still_life().scene;
  const gpu_scene::Camera camera = still_life().camera;
  const Picture due = render(s, request(camera, {}));
  s.add_object(Geometry(), {1});
  s.add_instance(77, {1}, glm::mat4(1));
  Geometry loose;
  loose.positions = {{0, 0, 0}, {100, 100, 100}};
  s.add_object(loose, {});
  EXPECT_EQ(render(s, request(camera, {}))[Pass::kCombined], due[Pass::kCombined]);
}

TEST(HardCases, OneTriangle) {
  Geometry g;
  g.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  g.triangles = g.loops = {{0, 1, 2}};
  g.slots = {0};
  g.normals.assign(3, {0, 0, 1});
  g.uv.assign(6, 0);
  TestScene s;
  s.add_object(g, {s.add_material(lambert())});
  s.lights = {sun({0.2f, 0, -1}, float(kPi)), point({0, 0, 1}, 10)};
  const Picture p =
      render(s, request(orthographic({0, 0, 3}, {0, 0, 0}, 1, 32, 32), {Pass::kDiffDir}));
  EXPECT_GT(p.value(Pass::kDiffDir, 16, 8), 0.9);
  EXPECT_EQ(p.value(Pass::kDiffDir, 2, 30), 0);
}

TEST(HardCases, TheCameraInsideAndOnGeometry) {
  TestScene s;
  const Id white = s.add_material(lambert());
  s.add_object(box({0, 0, 0}, glm::vec3(1)), {white});
  s.lights = {point({0.2f, 0.3f, 0.4f}, 20)};
  Picture p = render(s, request(perspective({0, 0, 0}, {1, 0.3, 0.2}, 1.5, 24, 24),
                                {Pass::kDepth, Pass::kDiffDir}));
  for (float d : p[Pass::kDepth]) ASSERT_LT(d, 2);
  for (float v : p[Pass::kDiffDir]) ASSERT_GT(v, 0);
  // On a face, looking in; and with the eye exactly in the plane of one.
  render(s, request(perspective({1, 0, 0}, {0, 0, 0}, 1.5, 24, 24), {Pass::kDepth}));
  p = render(s, request(perspective({3, 0, 1}, {0, 0, 1}, 0.5, 24, 24), {Pass::kNormal}));
  EXPECT_GT(p.value(Pass::kNormal, 12, 8, 0), 0.99);
}

TEST(HardCases, GeometryAcrossTheNearPlane) {
  // A floor that runs under and behind the camera: what is seen of it is as if it were small.
  TestScene s;
  s.add_object(floor_at(0, 50), {s.add_material(lambert())});
  s.lights = {sun({0.3f, 0.2f, -1}, float(kPi))};
  const gpu_scene::Camera camera = perspective({0, 0, 0.5}, {0, 4, 0}, 1.2, 32, 32, 0.1, 500);
  const Picture p = render(s, request(camera, {Pass::kDepth, Pass::kDiffDir}));
  Worst depth, light;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const Ray ray = pixel_ray(camera, x, y);
      if (ray.direction.z > -0.05) continue;
      const glm::dvec3 hit = on_plane(ray, {0, 0, 0}, {0, 0, 1});
      depth.compare(p.value(Pass::kDepth, x, y), -(camera.world_to_camera * glm::dvec4(hit, 1)).z,
                    1e-3, x, y);
      light.compare(p.value(Pass::kDiffDir, x, y), 1 / std::sqrt(1.13), 1, x, y);
    }
  EXPECT_WORST_BELOW(depth, 3e-5);
  EXPECT_WORST_BELOW(light, 1e-4);
}

TEST(HardCases, ClipPlanesCutWhatIsSeen) {
  TestScene s;
  s.add_object(floor_at(0, 1), {s.add_material(lambert())});
  s.add_object(floor_at(-5, 1), {s.add_material(lambert())});
  const Picture p =
      render(s, request(orthographic({0, 0, 3}, {0, 0, 0}, 0.5, 8, 8, 3.5, 7.5), {Pass::kDepth}));
  for (float d : p[Pass::kDepth]) ASSERT_EQ(d, 1e10f);
}

TEST(HardCases, ValuesThatAreNotFiniteStayOutOfThePicture) {
  const StillLife life = still_life();
  for (float broken : {kNaN, kInf, -kInf}) {
    TestScene s = life.scene;
    Geometry g = box({0, 1, 1}, glm::vec3(0.5f));
    g.positions[1].y = broken;
    g.normals[8] = glm::vec3(broken);
    g.uv[20] = broken;
    s.add_object(g, {s.add_material(material(
                        "void evaluate_material(const Hit hit, inout Surface surface) {\n"
                        "  vec4 texel = sample_image(hit, 0, hit_uv(hit, UV_DEFAULT), true);\n"
                        "  vec3 n = normal_map_tangent(hit, UV_DEFAULT, texel.rgb, 1.0);\n"
                        "  closure_diffuse(surface, vec3(1.0), texel.rgb, 0.0, n);\n"
                        "}\n",
                        {}, {.normal_map = true, .glossy = false}))});
    const float texels[8] = {broken, 1, 0.5f, 1, 1, broken, 1, broken};
    s.materials.back().textures = {
        {s.add_image(scene::make_image("i", 2, 1, std::span<const float>(texels), false,
                                       scene::AlphaMode::kStraight))}};
    glm::mat4 matrix(1);
    matrix[2].x = broken;
    s.add_instance(1, {1}, matrix);
    const Picture p =
        render(s, request(life.camera, {Pass::kDiffDir, Pass::kNormal, Pass::kDiffCol}, 2));
    EXPECT_GT(mean(p[Pass::kCombined]), 0.3) << "the rest of the scene is still there";
    EXPECT_EQ(p.stats.warnings.size(), 2u);
  }
}

TEST(HardCases, ParametersThatAreNotFiniteStayOutOfThePicture) {
  const StillLife life = still_life();
  for (float broken : {kNaN, kInf, -kInf}) {
    TestScene s = life.scene;
    s.materials[1].params[0].g = broken;
    s.materials[0] = material("void evaluate_material(const Hit hit, inout Surface surface) {\n"
                              "  Principled p = principled_defaults(hit);\n"
                              "  p.roughness = param(0).x;\n"
                              "  p.emission = vec3(param(0).x);\n"
                              "  closure_principled_v3(surface, vec3(1.0), p);\n"
                              "}\n",
                              {glm::vec4(broken)}, {.emission = true, .glossy = true});
    render(s, request(life.camera, {Pass::kDiffDir, Pass::kGlossDir, Pass::kEmit}, 2));
  }
}

TEST(HardCases, CoordinatesNearTheEndOfFloatsDoNoHarm) {
  for (float huge : {1e15f, 1e19f, 1e30f, 3e38f}) {
    StillLife life = still_life();
    Geometry g = floor_at(-1, 1);
    g.positions[2] = {huge, huge, -huge};
    life.scene.add_object(g, {1});
    const Picture p = render(life.scene, request(life.camera, {Pass::kNormal, Pass::kDiffDir}));
    // A point lamp's light on the floor does not depend on what lies at infinity.
    EXPECT_GT(mean(p[Pass::kCombined]), 0.2) << huge;
  }
}

TEST(HardCases, TheSamePictureTwiceToTheBit) {
  const StillLife life = still_life();
  TestScene s = life.scene;
  s.add_material(alpha_card({1, 1, 1, 0.5f}));
  s.add_object(floor_at(1.5f, 1), {3});
  s.lights.push_back(area({0, -1, 4}, {0, 0, -1}, 200, scene::AreaShape::kSquare, 1, 1));
  s.world = world("vec3 evaluate_world(vec3 d) { return d * 0.5 + 0.5; }\n");
  for (uint32_t samples : {1u, 8u}) {
    const engine::RenderRequest r =
        request(life.camera,
                {Pass::kDiffDir, Pass::kNormal, Pass::kDepth, Pass::kEnv, Pass::kDiffCol}, samples);
    const Picture a = render(s, r), b = render(r), c = render(s, r);
    for (const auto& [pass, pixels] : a.passes) {
      EXPECT_EQ(pixels, b[pass]) << film::info(pass).name << " of the next frame";
      EXPECT_EQ(pixels, c[pass]) << film::info(pass).name << " of the scene set again";
    }
  }
}

}  // namespace
}  // namespace panoptes::test
