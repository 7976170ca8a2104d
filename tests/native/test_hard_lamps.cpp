// Hard lamps: on surfaces, inside things, huge, tiny, many, broken.
#include "json.h"
#include "support.h"

#include <cmath>
#include <limits>

namespace panoptes::test {
namespace {

using film::Pass;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

const gpu_scene::Camera kCamera = perspective({0.3, -3, 2}, {0, 0, 0}, 0.7, 24, 24);

TestScene floor_with(std::vector<scene::Light> lamps) {
  TestScene s;
  s.add_object(floor_at(0, 8), {s.add_material(lambert())});
  s.lights = std::move(lamps);
  return s;
}

std::vector<scene::Light> one_of_each(const glm::vec3& at, const glm::vec3& direction) {
  return {sun(direction, 1), point(at, 10), spot(at, direction, 10, 1.2f, 0.5f),
          area(at, direction, 10, scene::AreaShape::kSquare, 0.5f, 0.5f)};
}

TEST(HardLamps, OnASurfaceAreFinite) {
  for (const scene::Light& lamp : one_of_each({0, 0, 0}, {0, 0, -1}))
    for (uint32_t samples : {1u, 4u}) {
      render(floor_with({lamp}), request(kCamera, {Pass::kDiffDir}, samples));
      scene::Light sideways = lamp;
      sideways.object_to_world = lamp_matrix({0, 0, 0}, {1, 0, 0});
      render(floor_with({sideways}), request(kCamera, {Pass::kDiffDir}, samples));
    }
}

TEST(HardLamps, WhereAPixelLooksAreFinite) {
  // Exactly at the point of the floor that a pixel's ray meets, and next to it.
  const glm::vec3 hit(on_plane(pixel_ray(kCamera, 12, 10), {0, 0, 0}, {0, 0, 1}));
  for (float height : {0.0f, 1e-30f, 1e-7f, -1e-7f})
    for (const scene::Light& lamp : one_of_each(hit + glm::vec3(0, 0, height), {0, 0, -1}))
      render(floor_with({lamp}), request(kCamera, {Pass::kDiffDir}));
}

TEST(HardLamps, InsideABoxLightItsInsideAlone) {
  TestScene s = floor_with({point({0, 0, 0.5f}, 100)});
  s.add_object(box({0, 0, 0.5f}, glm::vec3(0.25f)), {1});
  engine::RenderRequest r = request(kCamera, {Pass::kDiffDir});
  r.shadow_resolution = 512;
  const Picture outside = render(s, r);
  for (float v : outside[Pass::kDiffDir]) ASSERT_EQ(v, 0);
  r.camera = perspective({0.1, 0, 0.5}, {-1, 0.2, 0.5}, 1.2, 24, 24);
  const Picture inside = render(s, r);
  for (float v : inside[Pass::kDiffDir]) ASSERT_GT(v, 0);
}

TEST(HardLamps, WithoutSizeShine) {
  // Areas of no extent are points; radius and angle 0 are the rule.
  const scene::Light empty = area({0, 0, 2}, {0, 0, -1}, 10, scene::AreaShape::kRectangle, 0, 0);
  scene::Light flat = area({0, 0, 2}, {0, 0, -1}, 10, scene::AreaShape::kRectangle, 1, 1);
  for (int c = 0; c < 3; ++c) flat.object_to_world[c] *= 0.0f;  // a singular matrix points down
  for (const scene::Light& lamp : {empty, flat})
    for (uint32_t samples : {1u, 4u}) {
      engine::RenderRequest r =
          request(orthographic({0, 0, 1}, {0, 0, 0}, 1e-3, 4, 4), {Pass::kDiffDir}, samples);
      const Picture p = render(floor_with({lamp}), r);
      EXPECT_NEAR(p.value(Pass::kDiffDir, 2, 2), 10 / (4 * kPi * 4), 1e-4);
    }
}

TEST(HardLamps, OfHugeEnergyStayFinite) {
  for (float energy : {1e20f, 1e30f, 1e38f, -1e38f}) {
    std::vector<scene::Light> lamps = one_of_each({0, 0, 1}, {0, 0, -1});
    for (scene::Light& lamp : lamps) lamp.energy = energy;
    for (uint32_t samples : {1u, 8u}) {
      const Picture p = render(floor_with(lamps), request(kCamera, {Pass::kDiffDir}, samples));
      EXPECT_NO_THROW(parse_json(p.stats.to_json())) << energy;
    }
  }
  TestScene bright = floor_with({});
  bright.world = constant_world(glm::vec3(1e30f));
  render(bright, request(kCamera, {Pass::kDiffDir, Pass::kEnv}, 2));
}

TEST(HardLamps, OfTinyEnergyAreNotLost) {
  const Picture p =
      render(floor_with({sun({0, 0, -1}, 1e-20f)}), request(kCamera, {Pass::kDiffDir}));
  EXPECT_NEAR(p.value(Pass::kDiffDir, 12, 12) / (1e-20 / kPi), 1, 1e-4);
}

TEST(HardLamps, WithSettingsThatAreNotFiniteStayOutOfThePicture) {
  for (float broken : {kNaN, kInf, -kInf, -1.0f}) {
    const auto with = [&](auto change) {
      for (scene::Light lamp : one_of_each({0, 0, 1}, {0, 0, -1}))
        for (uint32_t samples : {1u, 4u}) {
          change(lamp);
          SCOPED_TRACE(
              fmt::format("lamp type {}, value {}, {} samples", int(lamp.type), broken, samples));
          // Another lamp beside it must not suffer.
          const Picture p = render(floor_with({lamp, sun({0, 0, -1}, 1)}),
                                   request(kCamera, {Pass::kDiffDir}, samples));
          EXPECT_GT(mean(p[Pass::kDiffDir]), 0.2);
        }
    };
    with([&](scene::Light& l) { l.radius = broken; });
    with([&](scene::Light& l) { l.angle = broken; });
    with([&](scene::Light& l) { l.spot_size = broken; });
    with([&](scene::Light& l) { l.spot_blend = broken; });
    with([&](scene::Light& l) { l.size_x = broken; });
    with([&](scene::Light& l) { l.spread = broken; });
  }
}

TEST(HardLamps, FarAwayAreSuns) {
  // 10 km above a floor of 4 m: the irradiance of a point at that distance, without self-shading.
  const double watts = 4 * kPi * 1e8;
  const Picture p =
      render(floor_with({point({0, 0, 1e4f}, float(watts))}), request(kCamera, {Pass::kDiffDir}));
  for (float v : p[Pass::kDiffDir]) ASSERT_NEAR(v, 1 / kPi, 1e-4);
}

TEST(HardLamps, ManyThousandsAddUp) {
  // Past the 65 535 iterations after which llvmpipe cuts an invocation off.
  std::vector<scene::Light> lamps;
  const int count = 70000;
  for (int i = 0; i < count; ++i) {
    lamps.push_back(sun({0, 0, -1}, 1e-4f));
    lamps.back().cast_shadow = false;
  }
  const Picture p = render(floor_with(lamps), request(orthographic({0, 0, 1}, {0, 0, 0}, 0.1, 2, 2),
                                                      {Pass::kDiffDir}));
  EXPECT_NEAR(p.value(Pass::kDiffDir, 1, 1), count * 1e-4 / kPi, 1e-3 * count * 1e-4 / kPi);
}

TEST(HardLamps, SpotsOfExtremeCones) {
  for (float size : {0.0f, 1e-4f, 3.1415925f, 3.1415927f})
    for (float blend : {0.0f, 1e-7f, 1.0f}) {
      const Picture p =
          render(floor_with({spot({0, 0, 2}, {0, 0, -1}, 100, size, blend)}),
                 request(orthographic({0, 0, 1}, {0, 0, 0}, 1e-6, 3, 3), {Pass::kDiffDir}));
      if (size > 3) {
        EXPECT_NEAR(p.value(Pass::kDiffDir, 1, 1), 100 / (16 * kPi * kPi), 0.01)
            << size << " " << blend;
      }
    }
}

TEST(HardLamps, MirroredAndScaledLampsShineAsTheirAxesSay) {
  for (scene::Light lamp : one_of_each({0.5f, 0, 2}, {0, 0, -1})) {
    const Picture due = render(floor_with({lamp}), request(kCamera, {Pass::kDiffDir}));
    lamp.object_to_world[0] *= -1.0f;  // mirrored in x: still along -Z
    const Picture mirrored = render(floor_with({lamp}), request(kCamera, {Pass::kDiffDir}));
    EXPECT_LT(relative_rmse(mirrored[Pass::kDiffDir], due[Pass::kDiffDir]), 1e-6) << int(lamp.type);
  }
}

}  // namespace
}  // namespace panoptes::test
