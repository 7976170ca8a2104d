// Light sampling of the path tracer: how many lights there may be, what an edit does again, hard cases.
#include "gl/counters.h"
#include "path_lights_fixture.h"

namespace panoptes::test {
namespace {

// Straight up: x: radiance of all lamps.
constexpr const char* kUpwards = R"(
vec4 run(vec3 position, vec3 normal, uint index) {
  vec3 up = normalize(vec3(1.0e-3 * random3().xy, 1.0));
  return vec4(lamps_seen(position, normal, up, FAR, 0.0).g);
}
)";

// The same, twice, where samples are as dense as the scattering; all lamps are alike.
constexpr const char* kUpwardsWeighed = R"(
vec4 run(vec3 position, vec3 normal, uint index) {
  vec3 up = normalize(vec3(1.0e-3 * random3().xy, 1.0));
  LightRecord l = fetch_record(0u);
  float pdf = lamp_on_ray(l, position, up, FAR).pdf * record_probability(l, position, normal);
  return vec4(2.0 * lamps_seen(position, normal, up, FAR, pdf).g);
}
)";

// x: samples on the half where x > 0 from the middle; y: others.
constexpr const char* kBrightHalf = R"(
vec4 run(vec3 position, vec3 normal, uint index) {
  LightSample s;
  if (!light_sample(position, normal, random3(), s)) return vec4(0.0);
  bool bright = position.x + s.direction.x * s.t_max > position.x - 0.25;
  return vec4(bright, !bright, 0.0, 0.0);
}
)";

// x: 1 where anything is not a finite number.
constexpr const char* kNotFinite = R"(
bool finite_number(float x) { return abs(x) <= 3.2e38; }
bool finite_vector(vec3 v) { return finite_number(v.x) && finite_number(v.y) && finite_number(v.z); }
vec4 run(vec3 position, vec3 normal, uint index) {
  LightSample s;
  light_sample(position, normal, random3(), s);
  bool good = finite_vector(s.direction) && finite_vector(s.value) && finite_number(s.pdf) &&
              finite_number(s.t_max) && s.pdf >= 0.0 && abs(length(s.direction) - 1.0) < 1.0e-4;
  if (s.pdf > 0.0) good = good && finite_vector(s.value / s.pdf);
  vec3 direction = normalize(random3() - 0.5);
  for (uint primitive = 0u; primitive < 2u; ++primitive)
    good = good && finite_number(light_pdf_primitive(position, normal, primitive, direction, random3().x)) &&
           finite_number(light_pdf_primitive(position, normal, primitive, direction, 0.0));
  good = good && finite_vector(lamps_seen(position, normal, direction, FAR, 0.3)) &&
         finite_vector(lamps_seen(position, normal, direction, FAR, 0.0)) &&
         finite_number(light_pdf_world(position, normal, direction)) &&
         finite_number(light_pdf_world(position, normal, vec3(0.0, 0.0, 1.0)));
  return vec4(good ? 0.0 : 1.0);
}
)";

// x: irradiance by samples; z: 1 where a sample wants a shadow ray, or rays show what is the samples'.
constexpr const char* kShadowless = R"(
vec4 run(vec3 position, vec3 normal, uint index) {
  LightSample s;
  if (!light_sample(position, normal, random3(), s)) return vec4(0.0);
  bool wrong = s.t_max != 0.0 || !s.singular ||
               lamps_seen(position, normal, s.direction, FAR, 1.0) != vec3(0.0);
  float e = s.value.g * max(dot(normal, s.direction), 0.0) / s.pdf;
  return vec4(e, e * e, wrong ? 1.0 : 0.0, 0.0);
}
)";

// --- capacities ----------------------------------------------------------------------------------

TEST_F(PathLights, RaysFindTheirWayThroughTenThousandSoftLamps) {
  constexpr uint32_t kInvocations = 64, kRuns = 64;
  const std::vector<Place> receivers = places(8, 10);
  install(strewn({point({0, 0, 0}, 100, 0.3f)}, 10'000, 10));
  std::vector<double> due;
  for (const Place& place : receivers) {
    due.push_back(0);
    for (scene::Light lamp : scene.lights()) {
      // The few that are near enough have a shape; the others are points.
      if (glm::distance(lamp.position(), place.position) > 3) lamp.radius = 0;
      due.back() += irradiance(lamp, place);
    }
  }
  expect_unbiased(run(kBothWays, receivers, kInvocations, kRuns), due, kInvocations * kRuns, 0.01);
  EXPECT_TRUE(lights.warnings().empty());
}

// A ray that passes thousands of lamps at once neither ends early nor loses light.
TEST_F(PathLights, APileOfSoftLampsLosesNoLight) {
  TestScene s;
  for (int i = 0; i < 20'000; ++i)
    s.lights.push_back(area({0, 0, 2 + 1e-5f * float(i)}, {0, 0, -1}, 1, scene::AreaShape::kDisk, 1, 1));
  install(s);
  ASSERT_EQ(lights.warnings().size(), 1u);
  EXPECT_NE(lights.warnings()[0].find("16384 of 20000 soft lamps"), std::string::npos);
  const Place below{{0, 0, 0}, {0, 0, 1}};
  const double radiance = 1 / (4 * kPi * 0.25);
  EXPECT_NEAR(run(kUpwards, {below}, 64, 1)[0].x, 16384 * radiance, 1e-4 * 16384 * radiance);
  const glm::dvec4 weighed = run(kUpwardsWeighed, {below}, 512, 1)[0];
  EXPECT_NEAR(weighed.x, 16384 * radiance, 0.05 * 16384 * radiance);
}

TEST_F(PathLights, SaysWhenTheDriverCannotAddressTheLights) {
  gl::DeviceInfo small = context->device();
  small.max_texture_buffer_texels = 65536;  // what OpenGL promises
  path_tracer::Lights few(small);
  const auto list_lamps = [&](int count) {
    strewn({point({0, 0, 0}, 100)}, count, 50).install(scene);
    gpu.update(scene);
    list.update(scene, gpu, programs, timer);
    few.update(scene, gpu, list, programs, timer);
  };
  expect_error([&] { list_lamps(20'000); }, "more lamps and glowing triangles than this graphics driver");
  EXPECT_NO_THROW(list_lamps(5'000));
  EXPECT_EQ(few.lamp_count(), 5'000u);
  // The world's map gets coarser instead.
  TestScene s;
  s.world = world(kSkyWithSun);
  s.install(scene);
  gpu.update(scene);
  few.update(scene, gpu, list, programs, timer);
  EXPECT_TRUE(few.world_sampled());
  EXPECT_LE(few.bytes(), 65536 * 4 + 64);
}

TEST_F(PathLights, AHundredThousandTrianglesMayGlow) {
  constexpr uint32_t kInvocations = 64, kRuns = 64;
  TestScene s;
  const Geometry ball = sphere({0, 0, 0}, 1, 320);
  const Id glowing = s.add_material(glow({1, 1, 1}, true));
  s.add_object(ball, {glowing});
  install(s);
  EXPECT_GT(lights.triangle_count(), 100'000u);
  std::vector<Place> receivers = places(8, 4);
  std::erase_if(receivers, [](const Place& p) { return glm::length(p.position) < 1.5f; });
  for (const glm::dvec4& mean : run(kTriangleDensities, receivers, kInvocations, kRuns)) {
    EXPECT_EQ(mean.y, 0);
    EXPECT_GT(mean.z, 0.5);
  }
}

// --- updates -------------------------------------------------------------------------------------

TEST_F(PathLights, OnlyWhatHasChangedIsDoneAgain) {
  TestScene s;
  s.add_object(floor_at(0, 1), {s.add_material(glow({1, 1, 1}, true))});
  s.lights = {point({0, 0, 2}, 100)};
  s.world = world(kSkyWithSun);
  install(s);
  const auto uploads = [&] {
    const int64_t before = gl::counters().uploaded_bytes;
    lights.update(scene, gpu, list, programs, timer);
    return gl::counters().uploaded_bytes - before;
  };
  EXPECT_EQ(uploads(), 0);
  // A dragged lamp: its record and the tree, no question to the material, no map.
  s.lights[0].energy = 50;
  scene.set_lights(s.lights);
  gpu.update(scene);
  const int64_t records = 3 * sizeof(shared::LightRecord) + 5 * sizeof(shared::LightNode) + 2 * 4;
  EXPECT_EQ(uploads(), records + int64_t(sizeof(shared::LightConstants)));
  EXPECT_EQ(uploads(), 0);
  // Another radiance is found out.
  scene.set_material_params(1, {glm::vec4(0)});
  gpu.update(scene);
  EXPECT_GT(uploads(), 0);
  EXPECT_EQ(lights.triangle_count(), 0u);
  EXPECT_EQ(lights.lamp_count(), 1u);
  // No lamps and no world any more.
  scene.set_lights({});
  scene.set_world(constant_world({0, 0, 0}));
  gpu.update(scene);
  uploads();
  EXPECT_FALSE(lights.any());
  EXPECT_EQ(lights.bytes(), int64_t(sizeof(shared::LightConstants)));
}

// Of two triangles of one material, the one that is bright there gets most samples.
TEST_F(PathLights, TrianglesAreMeasuredWhereTheirRadianceVaries) {
  TestScene s;
  scene::Material m = material(
      "void evaluate_material(const Hit hit, inout Surface surface) {\n"
      "  closure_emission(surface, vec3(1.0), vec3(hit_world_position(hit).x > 101.0 ? 10.0 : 0.01));\n"
      "}\n",
      {}, {.emission = true, .glossy = false});
  Geometry both = floor_at(0, 1);
  both.add(quad({2.5f, 0, 0}, {1, 0, 0}, {0, 1, 0}));
  s.add_object(both, {s.add_material(m)}, glm::translate(glm::mat4(1), {100, 0, 0}));
  install(s);
  const glm::dvec4 mean = run(kBrightHalf, {{{101.25f, 0, 2}, {0, 0, -1}}}, 64, 64)[0];
  EXPECT_GT(mean.x, 0.85);
  EXPECT_GT(mean.y, 0.005);  // and the other is not forgotten
}

// --- hard cases ----------------------------------------------------------------------------------

TEST_F(PathLights, LightOnAndInsideASurfaceIsFinite) {
  TestScene s;
  s.lights = one_of_each();
  s.lights.push_back(area({0, 0, 0}, {0, 0, 1}, 10, scene::AreaShape::kRectangle, 1, 0));
  s.add_object(quad({5, 0, 0}, {1, 0, 0}, {0, 1, 0}), {s.add_material(glow({1, 2, 3}, true))});
  s.world = world(kSkyWithSun);
  install(s);
  std::vector<Place> receivers;
  for (const scene::Light& lamp : s.lights)
    for (const glm::vec3& n : {glm::vec3(0, 0, 1), glm::vec3(0), glm::vec3(0, -1, 0)}) {
      receivers.push_back({lamp.position(), n});
      receivers.push_back({lamp.position() + 0.2f * glm::vec3(lamp.object_to_world[0]), n});
      receivers.push_back({std::nextafter(1.0f, 2.0f) * lamp.position(), n});
    }
  for (const glm::vec3& corner : {glm::vec3(4, -1, 0), glm::vec3(5, 0, 0), glm::vec3(6, 1, 1e-20f)})
    receivers.push_back({corner, {0, 0, 1}});
  for (const glm::dvec4& mean : run(kNotFinite, receivers, 8, 32)) EXPECT_EQ(mean.x, 0);
}

// At every scale, and far from the world's origin, the light is the same.
TEST_F(PathLights, ScaleAndPlaceDoNotMatter) {
  constexpr uint32_t kInvocations = 64, kRuns = 128;
  const std::vector<Place> near = places(6, 1.5f);
  for (const auto& [scale, origin] : {std::pair(1e-4f, 0.0f), {1e5f, 0.0f}, {1.0f, 1048576.0f}}) {
    SCOPED_TRACE(scale);
    TestScene s;
    s.lights = one_of_each();
    const auto moved = [&, scale = scale, origin = origin](const glm::vec3& p) {
      return glm::round(8.0f * p) / 8.0f * scale + glm::vec3(origin, -origin, origin);
    };
    std::vector<double> due;
    for (const Place& place : near) {
      const Place rounded{glm::round(8.0f * place.position) / 8.0f, place.normal};
      due.push_back(irradiance(quad({0, 0, 4}, {1, 0, 0}, {0, 1, 0}), 3, rounded));
      for (const scene::Light& lamp : s.lights) due.back() += irradiance(lamp, rounded);
    }
    for (scene::Light& lamp : s.lights) {
      lamp.object_to_world[3] = glm::vec4(moved(lamp.position()), 1);
      if (lamp.type != scene::LightType::kSun) lamp.energy *= scale * scale;
      lamp.radius *= scale;
      lamp.size_x *= scale;
      lamp.size_y *= scale;
    }
    glm::mat4 place = glm::scale(glm::mat4(1), glm::vec3(scale));
    place[3] = glm::vec4(moved({0, 0, 0}), 1);
    s.add_object(quad({0, 0, 4}, {1, 0, 0}, {0, 1, 0}), {s.add_material(glow({2, 3, 4}, false))}, place);
    install(s);
    std::vector<Place> receivers;
    for (const Place& p : near) receivers.push_back({moved(p.position), p.normal});
    expect_unbiased(run(kBothWays, receivers, kInvocations, kRuns), due, kInvocations * kRuns, 0.01);
  }
}

TEST_F(PathLights, LampsWithoutShadowNeedNoRay) {
  for (scene::Light lamp : one_of_each()) {
    lamp.cast_shadow = false;
    TestScene s;
    s.lights = {lamp};
    install(s);
    const Place place{{0, 0, 0}, {0, 0, 1}};
    const glm::dvec4 mean = run(kShadowless, {place}, 64, 64)[0];
    EXPECT_EQ(mean.z, 0);
    EXPECT_NEAR(mean.x, irradiance(lamp, place),
                5 * std::sqrt(std::max(mean.y - mean.x * mean.x, 0.0) / (64 * 64)) + 0.004 * mean.x);
  }
}

}  // namespace
}  // namespace panoptes::test
