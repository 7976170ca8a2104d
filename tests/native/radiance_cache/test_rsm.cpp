// The first bounce by reflective shadow maps against quadrature of (5.2)'s integral over a lit floor.
#include "base/error.h"
#include "gpu_scene/view.h"
#include "radiance_cache/bindings.h"
#include "radiance_cache/reflective_maps.h"
#include "radiance_cache/volume_fixture.h"

#include <array>

namespace panoptes::test {
namespace {

using radiance_cache::ReflectiveMaps;
using Coefficients = std::array<double, 9>;

constexpr double kHalf = 2, kAlbedo = 0.6;  // of the floor z = 0

// As shaders/base/spherical_harmonics.glsl orders them.
Coefficients harmonics(const glm::dvec3& d) {
  return {0.282094792,
          0.488602512 * d.y,
          0.488602512 * d.z,
          0.488602512 * d.x,
          1.092548431 * d.x * d.y,
          1.092548431 * d.y * d.z,
          0.315391565 * (3 * d.z * d.z - 1),
          1.092548431 * d.x * d.z,
          0.546274215 * (d.x * d.x - d.y * d.y)};
}

// Irradiance of the floor.
using Irradiance = std::function<double(glm::dvec3)>;

class ReflectiveMapsTest : public VolumeTest {
 protected:
  ReflectiveMapsTest() : maps(programs, timer) {
    settings.walls = false;  // no seed sees less than all of these cells
  }

  const Grid grid{{-2.51, -2.52, -0.53}, 0.5, {10, 10, 8}, 4};
  // Some before the floor, off its middle, none nearer than the bound of 1 / d^2.
  std::vector<glm::ivec3> cells{{4, 5, 3}, {6, 4, 4}, {2, 6, 3}, {5, 8, 5}};

  void set_up(TestScene& s, const Geometry& more = {}) {
    Geometry g = floor_at(0, float(kHalf));
    g.add(more);
    s.add_object(g, {s.add_material(lambert(glm::vec3(kAlbedo)))});
    install(s, {grid}, 0.5f);
  }

  rasterize::LightSet placed(const std::vector<scene::Light>& lamps,
                             const std::vector<rasterize::MeshLight>& meshes = {}) const {
    return rasterize::place_lights(lamps, {}, meshes,
                                   {.bounds = scene.bounds(),
                                    .camera_origin = kOrigin,
                                    .resolution = settings.rsm_resolution});
  }

  // Coefficients of the first channel at the cells.
  std::vector<Coefficients> gathered(const rasterize::LightSet& set) {
    std::vector<uint32_t> numbers;
    for (const glm::ivec3& c : cells)
      numbers.push_back(uint32_t((c.z * grid.cells.y + c.y) * grid.cells.x + c.x));
    const gl::Buffer list{std::span<const uint32_t>(numbers)};
    // The voxel (2, 2, 2) of each cell.
    const std::vector<uint32_t> codes(size_t(grid.cells.x * grid.cells.y * grid.cells.z), 1 + 2 + 16 + 128);
    const gl::Buffer seeds{std::span<const uint32_t>(codes)};
    const gl::Texture seed_texels(GL_R32UI, seeds);
    const auto bind = [&] {
      glBindBufferBase(GL_UNIFORM_BUFFER, radiance_cache::kVolumesBlock, volume.block().id());
      volume.words().bind(radiance_cache::kWordsUnit);
      glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, list.id());
      seed_texels.bind(0);
      const glm::ivec4 lattice[MOST_CASCADES] = {};
      glUniform4iv(1, MOST_CASCADES, &lattice[0].x);
    };
    const shared::View camera =
        gpu_scene::camera_view(perspective(kOrigin, {0, 0, 0}, 1, 8, 8), {0, 0});
    const std::atomic<bool> cancelled = false;
    maps.update({set, kOrigin, camera, gpu, view_block, cancelled},
                {uint32_t(cells.size()), glm::dvec3(list_origin()), 112, 7, bind}, settings);
    EXPECT_NO_THROW(gl::check_errors("reflective shadow maps"));
    std::vector<glm::vec4> read(cells.size() * 9);
    maps.light_buffer().read(0, int64_t(read.size() * sizeof(glm::vec4)), read.data());
    std::vector<Coefficients> result(cells.size());
    for (size_t i = 0; i < read.size(); ++i) {
      EXPECT_TRUE(std::isfinite(read[i].x + read[i].y + read[i].z)) << i;
      result[i / 9][i % 9] = read[i].x;
    }
    return result;
  }
  glm::vec3 list_origin() const { return list.origin(); }

  // The same by quadrature, of the part of the floor between `low` and `high`, with 1 / d^2 bounded at `least`
  // cells.
  std::vector<Coefficients> expected(const Irradiance& irradiance, glm::dvec2 low = glm::dvec2(-kHalf),
                                     glm::dvec2 high = glm::dvec2(kHalf), double least = 0.5) const {
    constexpr int kSteps = 96, kPlaces = 4;
    // Light is received above the voxels that the floor makes solid.
    const double voxel = grid.cell / grid.voxels, top = grid.low.z + voxel * std::ceil(-grid.low.z / voxel);
    std::vector<Coefficients> result;
    for (const glm::ivec3& cell : cells) {
      Coefficients sum{};
      for (int i = 0; i < kSteps * kSteps; ++i) {
        const glm::dvec2 u((i % kSteps + 0.5) / kSteps, (i / kSteps + 0.5) / kSteps);
        const glm::dvec3 x(low + (high - low) * u, 0);
        const double area = (high.x - low.x) * (high.y - low.y) / (kSteps * kSteps);
        const double sent = irradiance(x) * kAlbedo / kPi * area;
        if (sent == 0) continue;
        for (int k = 0; k < kPlaces * kPlaces * kPlaces; ++k) {
          const glm::dvec3 v(k % kPlaces, k / kPlaces % kPlaces, k / (kPlaces * kPlaces));
          const glm::dvec3 begin = glm::max(grid.low + grid.cell * glm::dvec3(cell), glm::dvec3(-1e9, -1e9, top));
          const glm::dvec3 end = grid.low + grid.cell * (glm::dvec3(cell) + 1.0);
          const glm::dvec3 way = x - begin - (end - begin) * (v + 0.5) / double(kPlaces);
          const glm::dvec3 d = glm::normalize(way);
          const Coefficients basis = harmonics(d);
          const double share = sent * -d.z / std::max(glm::dot(way, way), std::pow(least * grid.cell, 2)) / (kPlaces * kPlaces * kPlaces);
          for (size_t c = 0; c < 9; ++c) sum[c] += share * basis[c];
        }
      }
      result.push_back(sum);
    }
    return result;
  }

  // Every coefficient within `tolerance` of the cell's mean.
  static void expect_near(const std::vector<Coefficients>& found, const std::vector<Coefficients>& due,
                          double tolerance) {
    for (size_t i = 0; i < due.size(); ++i) {
      EXPECT_GT(due[i][0], 0);
      for (size_t c = 0; c < 9; ++c)
        EXPECT_NEAR(found[i][c], due[i][c], tolerance * due[i][0]) << "cell " << i << ", " << c;
    }
  }
  static double mean(const std::vector<Coefficients>& light) {
    double sum = 0;
    for (const Coefficients& c : light) sum += c[0] / double(light.size());
    return sum;
  }

  static constexpr glm::dvec3 kOrigin{3, -4, 2};  // of lamps' positions
  ReflectiveMaps maps;
  radiance_cache::Settings settings{.rsm_samples = 4000, .rsm_resolution = 128, .rsm_spread = 0.8f};
};

// A lamp at `from` whose intensity towards the unit direction is `intensity`.
Irradiance of_point(const glm::dvec3& from, const std::function<double(glm::dvec3)>& intensity) {
  return [=](glm::dvec3 x) {
    const glm::dvec3 way = x - from, d = glm::normalize(way);
    return -d.z > 0 ? intensity(d) * -d.z / glm::dot(way, way) : 0.0;
  };
}

TEST_F(ReflectiveMapsTest, LightOfEachKindOfLampIsThatOfQuadrature) {
  TestScene s;
  set_up(s);
  const glm::dvec3 from(0.3, -0.2, 1.4), axis = glm::normalize(glm::dvec3(0.2, 0.3, -1));
  const glm::vec3 place(from), way(axis);

  const scene::Light bulb = point(place, 100);
  ASSERT_EQ(placed({bulb}).lights[0].views.size(), 6u);  // whose borders must not shine twice
  expect_near(gathered(placed({bulb})), expected(of_point(from, [&](auto) { return double(bulb.power().x); })), 0.03);

  const scene::Light cone = spot(place, way, 100, 0.9f, 0);
  const double edge = std::cos(0.45);
  expect_near(gathered(placed({cone})), expected(of_point(from, [&](glm::dvec3 d) {
                const double cosine = glm::dot(d, axis);
                return cosine > edge ? cone.power().x * cosine : 0.0;
              })), 0.03);

  const scene::Light panel = area(place, way, 100, scene::AreaShape::kSquare, 0.1f, 0.1f);
  expect_near(gathered(placed({panel})), expected(of_point(from, [&](glm::dvec3 d) {
                return panel.power().x * std::max(glm::dot(d, axis), 0.0);
              })), 0.03);

  const scene::Light day = sun(way, 3);
  expect_near(gathered(placed({day})), expected([&](glm::dvec3) { return 3 * -axis.z; }), 0.03);

  const rasterize::MeshLight glow{from, way, glm::vec3(5), glm::vec3(0), 0.01f};
  expect_near(gathered(placed({}, {glow})), expected(of_point(from, [&](glm::dvec3 d) {
                return 5 * std::max(glm::dot(d, axis), 0.0);
              })), 0.03);

  // All together, the points of glowing surfaces with the samples of one lamp.
  const auto all = gathered(placed({bulb, cone, panel, day}, {glow, glow}));
  double sum = 0;
  for (const auto& one : {placed({bulb}), placed({cone}), placed({panel}), placed({day}), placed({}, {glow, glow})})
    sum += mean(gathered(one));
  EXPECT_NEAR(mean(all), sum, 0.01 * sum);
}

TEST_F(ReflectiveMapsTest, LampsFarAwayAreSeenInOneView) {
  TestScene s;
  set_up(s);
  // The farther one so far that its rays are parallel.
  for (double distance : {8.0, 2e4}) {
    const glm::dvec3 from = distance * glm::normalize(glm::dvec3(0.1, 0.2, 1));
    const scene::Light bulb = point(glm::vec3(from), float(100 * distance * distance));
    const auto set = placed({bulb});
    ASSERT_EQ(set.lights[0].views.size(), 1u);
    EXPECT_EQ(set.lights[0].views[0]->perspective, distance < 100);
    expect_near(gathered(set), expected(of_point(from, [&](auto) { return double(bulb.power().x); })), 0.03);
  }
}

TEST_F(ReflectiveMapsTest, WindowLosesWhatLiesOutsideAndMixingDoesNot) {
  TestScene s;
  set_up(s);
  const auto set = placed({sun({0, 0, -1}, 3)});
  const double whole = mean(expected([](auto) { return 3.0; }));
  settings.rsm_spread = 1;
  for (bool mixed : {false, true}) {
    settings.rsm_mixed = mixed;
    EXPECT_NEAR(mean(gathered(set)), whole, 0.02 * whole) << mixed;
  }
  settings.rsm_spread = 0.4f;
  EXPECT_NEAR(mean(gathered(set)), whole, 0.02 * whole);

  // The map is the floor and a border; its window has its middle below the cell's.
  settings.rsm_mixed = false;
  const auto found = gathered(set);
  const glm::dvec2 map(set.lights[0].views[0]->half_x, set.lights[0].views[0]->half_y);
  const glm::dvec2 half = map * double(settings.rsm_spread);
  for (size_t i = 0; i < cells.size(); ++i) {
    const glm::dvec2 seed = glm::dvec2(grid.low) + grid.cell * (glm::dvec2(cells[i]) + 2.5 / 4);
    const glm::dvec2 middle = glm::clamp(seed, half - map, map - half);
    const auto due = expected([](auto) { return 3.0; }, glm::max(middle - half, -kHalf), glm::min(middle + half, kHalf));
    EXPECT_NEAR(found[i][0], due[i][0], 0.03 * due[i][0]) << i;
    EXPECT_LT(found[i][0], 0.9 * expected([](auto) { return 3.0; })[i][0]);
  }
}

TEST_F(ReflectiveMapsTest, TheBoundOfDistanceLosesLittleRightAboveAFloor) {
  TestScene s;
  set_up(s);
  cells = {{4, 5, 1}, {6, 3, 1}};
  settings.rsm_spread = 0.25f;
  const Irradiance day = [](auto) { return 3.0; };
  const auto found = gathered(placed({sun({0, 0, -1}, 3)}));
  const auto due = expected(day);
  const auto all = expected(day, glm::dvec2(-kHalf), glm::dvec2(kHalf), 0);
  for (size_t i = 0; i < cells.size(); ++i) {
    EXPECT_NEAR(found[i][0], due[i][0], 0.03 * due[i][0]) << i;
    EXPECT_GT(found[i][0], 5 / 6.0 * all[i][0]) << i;
    EXPECT_LT(found[i][0], 0.98 * all[i][0]) << i;
  }
}

TEST_F(ReflectiveMapsTest, WhatStandsBetweenHidesLight) {
  const auto set = [&] { return placed({point({0.1f, 0.1f, 0.4f}, 100)}); };
  TestScene open;
  set_up(open);
  const double light = mean(gathered(set()));
  EXPECT_GT(light, 0);
  for (int steps : {0, 24}) {
    settings.march_steps = steps;
    TestScene open_again;
    set_up(open_again);
    EXPECT_NEAR(mean(gathered(set())), light, 0.02 * light) << steps;
    TestScene roofed;
    set_up(roofed, floor_at(0.8f, float(kHalf)));
    const double left = mean(gathered(set()));
    // A few points far apart step through a thin roof.
    EXPECT_LE(left, (steps ? 0.5 : 1e-6) * light) << steps;
  }
}

TEST_F(ReflectiveMapsTest, NothingShinesWhereThereIsNothingToShine) {
  TestScene s;
  set_up(s);
  EXPECT_EQ(mean(gathered(placed({}))), 0);
  // Away from all surfaces, of no power, and exactly on the floor.
  EXPECT_EQ(mean(gathered(placed({spot({0, 0, 1}, {0, 0, 1}, 100, 0.5f, 0)}))), 0);
  EXPECT_EQ(mean(gathered(placed({point({0, 0, 1}, 0)}))), 0);
  gathered(placed({point({0, 0, 0}, 100), area({0, 0, 0}, {0, 0, -1}, 100, scene::AreaShape::kDisk, 1, 1)}));
  settings.rsm_samples = 1;
  settings.rsm_resolution = 16;
  gathered(placed({point({0, 0, 1}, 100)}));
  TestScene empty;
  install(empty, {grid}, 0.5f);
  EXPECT_EQ(mean(gathered(placed({}))), 0);
}

TEST(Halton, PointsAreThoseOfTheSequence) {
  const auto points = radiance_cache::halton_points(6);
  const glm::vec2 due[6] = {{1 / 2.f, 1 / 3.f}, {1 / 4.f, 2 / 3.f}, {3 / 4.f, 1 / 9.f},
                            {1 / 8.f, 4 / 9.f}, {5 / 8.f, 7 / 9.f}, {3 / 8.f, 2 / 9.f}};
  for (size_t i = 0; i < 6; ++i)
    for (int axis = 0; axis < 2; ++axis) EXPECT_FLOAT_EQ(points[i][axis], due[i][axis]) << i;
}

// Whole frames in a closed room.
class ReflectiveBounce : public ::testing::Test {
 protected:
  using FirstBounce = radiance_cache::FirstBounce;
  static TestScene room(const std::vector<scene::Light>& lamps) {
    TestScene s;
    s.add_object(box({0, 0, 1.5f}, {2, 2, 1.5f}), {s.add_material(lambert(glm::vec3(0.5f)))});
    s.lights = lamps;
    return s;
  }
  // Without a ceiling.
  static TestScene yard(const std::vector<scene::Light>& lamps) {
    TestScene s;
    Geometry walls = floor_at(0, 2);
    for (float side : {-2.0f, 2.0f})
      walls.add(quad({side, 0, 1.5f}, {0, 2, 0}, {0, 0, 1.5f})).add(quad({0, side, 1.5f}, {2, 0, 0}, {0, 0, 1.5f}));
    s.add_object(walls, {s.add_material(lambert(glm::vec3(0.5f)))});
    s.lights = lamps;
    return s;
  }
  Picture picture(const TestScene& s, FirstBounce first, int bounces = 1) {
    engine::RenderRequest r = request(perspective({-1.7, -1.7, 2.4}, {0.5, 0.5, 0.8}, 1.3, 32, 24), {film::Pass::kDiffInd});
    r.cache.enabled = true;
    r.cache.first_bounce = first;
    r.cache.bounces = bounces;
    r.cache.resolution = 16;
    r.cache.rsm_samples = 1000;
    r.cache.directions = 256;
    r.occlusion.strength = 0;  // which may look through lamps' shadow maps
    return render(s, r);
  }
  // Light that was reflected once, by maps and by surfaces that rays meet: the mean, and apart.
  void expect_same(const TestScene& s, const std::string& label, int bounces = 1) {
    const Picture surfaces = picture(s, FirstBounce::kSurfaces, bounces);
    const Picture maps = picture(s, FirstBounce::kRsm, bounces);
    const auto &due = surfaces[film::Pass::kDiffInd], &found = maps[film::Pass::kDiffInd];
    EXPECT_GT(mean(due), 0) << label;
    EXPECT_NEAR(mean(found), mean(due), 0.03 * mean(due)) << label;
    EXPECT_LT(relative_rmse(found, due), 0.12) << label;
    EXPECT_TRUE(ran(maps, "cache_rsm") && !ran(maps, "cache_first_bounce")) << label;
    EXPECT_TRUE(ran(surfaces, "cache_first_bounce") && !ran(surfaces, "cache_rsm")) << label;
  }
  static bool ran(const Picture& picture, const std::string& effect) {
    for (const engine::EffectReport& e : picture.stats.effects)
      if (e.name == effect) return e.runs;
    ADD_FAILURE() << "no effect " << effect;
    return false;
  }
};

TEST_F(ReflectiveBounce, IsAsBrightAsThatOfSurfacesThatRaysMeet) {
  expect_same(room({point({0.6f, 0.3f, 2}, 100)}), "point");
  expect_same(room({point({0.6f, 0.3f, 2}, 100)}), "two bounces", 2);
  expect_same(room({spot({-0.5f, 0, 2.5f}, {0.2f, 0.1f, -1}, 300, 1, 0.2f)}), "spot");
  expect_same(room({area({0.2f, 0.4f, 2.9f}, {0, 0.1f, -1}, 100, scene::AreaShape::kSquare, 0.5f, 0.5f)}), "area");
  expect_same(yard({sun({0, 0, -1}, 3)}), "sun");
  // In the middle: closer, its points would draw finer spots than points of surfaces tell.
  TestScene glowing = room({});
  glowing.add_object(quad({0.4f, 0.5f, 1.8f}, {0, 0.3f, 0}, {0.3f, 0, 0}),
                     {glowing.add_material(emitter(glm::vec3(20)))});
  expect_same(glowing, "emissive mesh");
  std::vector<scene::Light> many;
  for (int i = 0; i < 12; ++i) many.push_back(point({0.1f * float(i) - 0.5f, 0.8f, 1.5f}, 5));
  expect_same(room(many), "many lamps");
}

TEST_F(ReflectiveBounce, LampsWithoutShadowsShineToo) {
  scene::Light lamp = point({0.6f, 0.3f, 2}, 100);
  const Picture with = picture(room({lamp}), FirstBounce::kRsm);
  lamp.cast_shadow = false;
  const Picture without = picture(room({lamp}), FirstBounce::kRsm);
  EXPECT_LT(relative_rmse(without[film::Pass::kDiffInd], with[film::Pass::kDiffInd]), 1e-3);
}

TEST_F(ReflectiveBounce, HardCasesAreFinite) {
  const auto light = [this](const TestScene& s) {
    const Picture p = picture(s, FirstBounce::kRsm);
    for (float v : p[film::Pass::kDiffInd]) EXPECT_TRUE(std::isfinite(v) && v >= 0);
    return mean(p[film::Pass::kDiffInd]);
  };
  EXPECT_EQ(light(room({})), 0);
  // In the floor, in an edge and in a corner of the room.
  for (const glm::vec3& place : {glm::vec3(0.3f, 0.2f, 0), glm::vec3(2, 0.1f, 0), glm::vec3(2, 2, 3)})
    EXPECT_LT(light(room({point(place, 100)})), 1e3);
  // All of the scene in one plane, or in one point.
  TestScene flat, speck;
  flat.add_object(floor_at(0, 2), {flat.add_material(lambert(glm::vec3(0.5f)))});
  speck.add_object(floor_at(0, 0), {speck.add_material(lambert(glm::vec3(0.5f)))});
  for (TestScene* s : {&flat, &speck}) {
    s->lights = {point({0.1f, 0.2f, 1}, 100), sun({0, 0.1f, -1}, 3)};
    EXPECT_NEAR(light(*s), 0, 1e-6);
  }
}

}  // namespace
}  // namespace panoptes::test
