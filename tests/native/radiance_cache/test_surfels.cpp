// Surfels of the geometry volume: where they lie, which triangle they are of, what they reflect, and
// which are there by chance.
#include "radiance_cache/volume_fixture.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <cstring>

namespace panoptes::test {
namespace {

class Surfels : public VolumeTest {
 protected:
  double share(size_t count, size_t of) { return double(count) / double(of); }
};

constexpr uint32_t kSamples = 40 * 40;
// A grid whose one layer of voxels, 40 by 40, a floor of 2 m at height 0 passes through.
const Grid kLayer{{-1, -1, -0.02}, 0.2, {10, 10, 1}, 4};

double sigma(double share, double n) { return std::sqrt(share * (1 - share) / n); }

scene::Material coded(const std::string& color, scene::MaterialFacts facts = {.glossy = false}) {
  return material("void evaluate_material(const Hit hit, inout Surface surface) {\n"
                  "  closure_diffuse(surface, vec3(1.0), " + color + ", 0.0, hit.normal);\n"
                  "}\n", {}, facts);
}

// Packing has ten bits of a square root.
void expect_color(uint32_t word, const glm::dvec3& due, double tolerance = 2e-3) {
  const glm::dvec3 color = unpack_color(word);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(color[i], due[i], tolerance);
}

TEST_F(Surfels, LieInTheirVoxelsAndOnTriangles) {
  TestScene s;
  const Geometry ball = sphere({0, 0, 0}, 1, 12);
  const glm::mat4 place = glm::scale(glm::translate(glm::mat4(1), {300, -200, 50}), {-2, 1.5f, 1});
  s.add_object(ball, {s.add_material(lambert())}, place);
  const Grid grid{{297.9, -201.6, 48.9}, 0.5, {9, 7, 5}, 4};
  install(s, {grid}, 0);
  const double size = grid.cell / grid.voxels;
  ASSERT_GT(volume.solid(), 500u);
  for (const auto& [voxel, number] : solid()) {
    const glm::dvec3 p = place_of(number);
    for (int i = 0; i < 3; ++i) {
      const double at = (p[i] - grid.low[i]) / size - voxel[size_t(i)];
      EXPECT_GT(at, -1e-3);
      EXPECT_LT(at, 1.001);
    }
    // The nearest triangle's plane and sides, and its front.
    double nearest = 1e9;
    for (const glm::ivec3& t : ball.triangles) {
      glm::dvec3 c[3];
      for (int k = 0; k < 3; ++k) c[k] = glm::dvec3(place * glm::vec4(ball.positions[size_t(t[k])], 1));
      const glm::dvec3 across = glm::cross(c[1] - c[0], c[2] - c[0]);
      if (glm::length(across) < 1e-9) continue;
      const glm::dvec3 n = glm::normalize(across);
      double off = std::abs(glm::dot(p - c[0], n));
      for (int k = 0; k < 3; ++k) {
        const glm::dvec3 inward = glm::normalize(glm::cross(n, c[(k + 1) % 3] - c[k]));
        off = std::max(off, -glm::dot(p - c[k], inward));
      }
      nearest = std::min(nearest, off);
    }
    EXPECT_LT(nearest, 1e-4);
    EXPECT_EQ(surfels[number].surface.w, gpu.place_of(0));
  }
}

TEST_F(Surfels, FaceAsTheFrontOfAMirroredObjectDoes) {
  TestScene s;
  s.add_object(floor_at(0, 1), {s.add_material(lambert())},
               glm::scale(glm::mat4(1), glm::vec3(-1, 1, 1)));
  install(s, {kLayer}, 0.5f);
  ASSERT_EQ(volume.solid(), kSamples);
  for (const shared::Surfel& surfel : surfels) EXPECT_EQ(surfel.surface.x, 0u);  // (0, 0, 1)
}

TEST_F(Surfels, AreOfTrianglesByTheirArea) {
  // Two sheets in each voxel; on one of them cards cover a quarter.
  TestScene s;
  s.add_object(floor_at(0, 1), {s.add_material(lambert(glm::vec3(1)))});
  Geometry cards;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x)
      cards.add(quad({-0.975f + 0.05f * float(x), -0.975f + 0.05f * float(y), 0.01f}, {0.0125f, 0, 0},
                     {0, 0.0125f, 0}));
  s.add_object(cards, {s.add_material(lambert(glm::vec3(0)))});
  install(s, {kLayer}, 0.5f);
  ASSERT_EQ(volume.solid(), kSamples);
  size_t of_cards = 0;
  for (const shared::Surfel& surfel : surfels) {
    EXPECT_NEAR(surfel.place.w, 1.25 * 0.05 * 0.05, 1e-6);
    of_cards += surfel.surface.y == 0u;
  }
  EXPECT_NEAR(share(of_cards, kSamples), 0.2, 4 * sigma(0.2, kSamples));
}

TEST_F(Surfels, AreSpreadEvenlyOverTheirVoxels) {
  TestScene s;
  s.add_object(floor_at(0, 1), {s.add_material(lambert())});
  install(s, {kLayer}, 0.5f);
  glm::dvec2 mean(0), square(0);
  for (const auto& [voxel, number] : solid()) {
    const glm::dvec2 at = (glm::dvec2(place_of(number)) + 1.0) / 0.05 - glm::dvec2(voxel[0], voxel[1]);
    mean += at / double(kSamples);
    square += at * at / double(kSamples);
  }
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(mean[i], 0.5, 4 * std::sqrt(1.0 / 12 / kSamples));
    EXPECT_NEAR(square[i], 1.0 / 3, 4 * std::sqrt((1.0 / 5 - 1.0 / 9) / kSamples));
  }
}

TEST_F(Surfels, HaveTheColorOfTheirPoint) {
  TestScene s;
  s.add_object(floor_at(0, 1), {s.add_material(coded("vec3(hit_uv(hit, UV_DEFAULT), 0.25)"))});
  install(s, {kLayer}, 0.5f);
  ASSERT_EQ(volume.solid(), kSamples);
  for (uint32_t i = 0; i < volume.solid(); ++i) {
    const glm::dvec3 p = place_of(i), due(0.5 + 0.5 * p.x, 0.5 + 0.5 * p.y, 0.25);
    expect_color(surfels[i].surface.y, due);
    EXPECT_EQ(surfels[i].surface.y, surfels[i].surface.z);
  }
}

TEST_F(Surfels, HaveTheColorOfAnImage) {
  TestScene s;
  const std::vector<uint8_t> halves{255, 0, 0, 255, 0, 0, 255, 255};
  const Id id = s.add_image(scene::make_image("halves", 2, 1, std::span<const uint8_t>(halves), false,
                                              scene::AlphaMode::kChannelPacked));
  scene::Material textured = coded("sample_image(hit, 0, hit_uv(hit, UV_DEFAULT), false).rgb");
  scene::TextureUse use;
  use.image = id;
  use.closest = true;
  textured.textures = {use};
  s.add_object(floor_at(0, 1), {s.add_material(textured)});
  install(s, {kLayer}, 0.5f);
  for (uint32_t i = 0; i < volume.solid(); ++i)
    expect_color(surfels[i].surface.y, place_of(i).x < 0 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1));
}

TEST_F(Surfels, HaveAColorForEachSide) {
  TestScene s;
  s.add_object(floor_at(0, 1),
               {s.add_material(coded("(hit.backfacing ? vec3(0.25, 0.0, 0.0) : vec3(0.0, 0.5, 0.0))"))});
  install(s, {kLayer}, 0.5f);
  ASSERT_EQ(volume.solid(), kSamples);
  for (const shared::Surfel& surfel : surfels) {
    expect_color(surfel.surface.y, {0, 0.5, 0});
    expect_color(surfel.surface.z, {0.25, 0, 0});
  }
}

TEST_F(Surfels, ReflectWhatAllLobesDoTogetherAndNoMoreThanAll) {
  const auto reflecting = [](const char* closures) {
    return material("void evaluate_material(const Hit hit, inout Surface surface) {\n" +
                    std::string(closures) + "}\n", {});
  };
  TestScene s;
  const Id both = s.add_material(reflecting(
               "  closure_diffuse(surface, vec3(1.0), vec3(0.25), 0.0, hit.normal);\n"
               "  closure_glossy(surface, vec3(1.0), vec3(0.5, 0.25, 0.0), 0.0, hit.normal);\n")),
           more = s.add_material(reflecting(
               "  closure_diffuse(surface, vec3(1.0), vec3(0.9), 0.0, hit.normal);\n"
               "  closure_glossy(surface, vec3(1.0), vec3(0.9), 0.0, hit.normal);\n")),
           white = s.add_material(reflecting(
               "  Principled p = principled_defaults(hit);\n"
               "  p.base_color = vec3(0.8);\n"
               "  closure_principled_v3(surface, vec3(1.0), p);\n"));
  s.add_object(quad({-0.5f, 0, 0}, {0.5f, 0, 0}, {0, 1, 0}), {both});
  s.add_object(quad({0.5f, -0.5f, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}), {more});
  s.add_object(quad({0.5f, 0.5f, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}), {white});
  install(s, {kLayer}, 0.5f);
  ASSERT_EQ(volume.solid(), kSamples);
  for (uint32_t i = 0; i < volume.solid(); ++i) {
    const glm::dvec3 p = place_of(i), color = unpack_color(surfels[i].surface.y);
    if (p.x < 0) expect_color(surfels[i].surface.y, {0.75, 0.5, 0.25}, 0.02);
    else if (p.y < 0) EXPECT_EQ(color, glm::dvec3(1));
    else EXPECT_NEAR(color.x, 0.84, 0.05);  // and what a dielectric of 1.45 mirrors on the mean
  }
}

TEST_F(Surfels, AreThereByTheirAlpha) {
  TestScene s;
  s.add_object(floor_at(0, 1), {s.add_material(alpha_card({0.5f, 0.5f, 0.5f, 0.3f}))});
  install(s, {kLayer}, 0.5f);
  EXPECT_NEAR(share(volume.solid(), kSamples), 0.3, 4 * sigma(0.3, kSamples));
  // What is there is as bright as the card is where it is opaque.
  for (const shared::Surfel& surfel : surfels) expect_color(surfel.surface.y, glm::dvec3(0.5));
}

TEST_F(Surfels, LetPassWhatIsTransmitted) {
  TestScene s;
  s.add_object(floor_at(0, 1),
               {s.add_material(material(
                   "void evaluate_material(const Hit hit, inout Surface surface) {\n"
                   "  closure_refraction(hit, surface, vec3(0.5), vec3(1.0), 0.0, 1.5, hit.normal);\n"
                   "  closure_diffuse(surface, vec3(0.5), vec3(0.5), 0.0, hit.normal);\n"
                   "}\n", {}, {.transmission = true}))});
  install(s, {kLayer}, 0.5f);
  EXPECT_NEAR(share(volume.solid(), kSamples), 0.5, 4 * sigma(0.5, kSamples));
  for (const shared::Surfel& surfel : surfels) expect_color(surfel.surface.y, glm::dvec3(0.5), 0.01);
}

TEST_F(Surfels, AreNotOfWhatDiffuseRaysDoNotSee) {
  TestScene s;
  s.add_object(floor_at(0, 1), {s.add_material(lambert())});
  s.instances[0].visibility = shared::SEEN_BY_ALL & ~shared::SEEN_BY_DIFFUSE;
  install(s, {kLayer}, 0);
  EXPECT_EQ(volume.solid(), 0u);
}

TEST_F(Surfels, FollowAMaterialWithoutNewVoxels) {
  TestScene s;
  const Id id = s.add_material(lambert(glm::vec3(0.25f)));
  s.add_object(floor_at(0, 1), {id});
  install(s, {kLayer}, 0.5f);
  EXPECT_FALSE(update({kLayer}, 0.5f));
  timer.reset();
  scene.set_material_params(id, {glm::vec4(0.75f)});
  EXPECT_TRUE(update({kLayer}, 0.5f));
  for (const gl::PassTime& time : timer.times()) EXPECT_NE(time.name, "radiance_cache_voxels");
  ASSERT_EQ(volume.solid(), kSamples);
  for (const shared::Surfel& surfel : surfels) expect_color(surfel.surface.y, glm::dvec3(0.75));
}

TEST_F(Surfels, AreTheSameBitsEachTime) {
  TestScene s;
  s.add_object(sphere({0, 0, 0}, 0.9f, 64), {s.add_material(alpha_card({0.5f, 0.5f, 0.5f, 0.5f}))});
  const Grid grid{{-1, -1, -1}, 0.25, {8, 8, 8}, 4};
  install(s, {grid}, 0.5f);
  const std::vector<glm::uvec2> first_words = words;
  const std::vector<shared::Surfel> first = surfels;
  for (int i = 0; i < 3; ++i) {
    volume.release();
    update({grid}, 0.5f);
    EXPECT_EQ(words, first_words);
    ASSERT_EQ(surfels.size(), first.size());
    EXPECT_EQ(std::memcmp(surfels.data(), first.data(), first.size() * sizeof first[0]), 0);
  }
}

TEST_F(Surfels, StayWhereTheyAreWhenAVolumeMoves) {
  TestScene s;
  s.add_object(sphere({0, 0, 0}, 0.9f, 32), {s.add_material(alpha_card({0.5f, 0.5f, 0.5f, 0.5f}))});
  Grid grid{{-1, -1, -1}, 0.25, {8, 8, 8}, 4};
  install(s, {grid}, 0.5f);
  const auto before = solid();
  const std::vector<shared::Surfel> first = surfels;
  grid.low += glm::dvec3(0.25, -0.5, 0.25);
  update({grid}, 0.5f);
  size_t same = 0, kept = 0;
  const auto after = solid();
  for (const auto& [voxel, number] : before) {
    const std::array<int, 3> moved{voxel[0] - 4, voxel[1] + 8, voxel[2] - 4};
    if (moved[0] < 0 || moved[1] > 31 || moved[2] < 0) continue;
    ++kept;
    const auto found = after.find(moved);
    same += found != after.end() && glm::distance(glm::vec3(surfels[found->second].place),
                                                  glm::vec3(first[number].place)) < 1e-4f;
  }
  ASSERT_GT(kept, 300u);
  // All but those whose area is at the threshold by rounding.
  EXPECT_GE(double(same), 0.995 * double(kept));
}

}  // namespace
}  // namespace panoptes::test
