// Which cells of the radiance cache hold light: fewer of them must not change the picture.
#include "support.h"

namespace panoptes::test {
namespace {

using film::Pass;
using radiance_cache::Occupancy;

// Two rooms of white walls, one above the other, a lamp in each; the camera is in the upper one.
TestScene rooms() {
  TestScene s;
  const Id white = s.add_material(lambert(glm::vec3(0.8f))), red = s.add_material(lambert({0.8f, 0.1f, 0.1f}));
  for (float z : {0.0f, 3.0f, 6.0f}) s.add_object(floor_at(z, 3), {white});
  s.add_object(quad({-3, 0, 3}, {0, 3, 0}, {0, 0, 3}), {red});
  s.add_object(quad({3, 0, 3}, {0, 3, 0}, {0, 0, 3}), {white});
  s.add_object(quad({0, 3, 3}, {3, 0, 0}, {0, 0, 3}), {white});
  s.lights = {point({1, 0, 5}, 100), point({-1, 0, 2}, 100)};
  return s;
}

gpu_scene::Camera inside(int scale) {
  return perspective({0, -4, 4.5}, {0, 0, 4}, 0.9, 40 * scale, 30 * scale);
}

Picture picture_by(Occupancy occupancy, int bounces, int stride, bool dilate = false, int scale = 1) {
  engine::RenderRequest r = request(inside(scale), {Pass::kDiffInd});
  r.cache.enabled = true;
  r.cache.resolution = 16;
  r.cache.cascades = 1;
  r.cache.bounces = bounces;
  r.cache.occupancy = occupancy;
  r.cache.depth_stride = stride;
  r.cache.dilate = dilate;
  return render(r);
}

class CacheOccupancy : public ::testing::Test {
 protected:
  CacheOccupancy() {
    shared_engine().edit([](scene::Scene& scene) { rooms().install(scene); });
  }
};

TEST_F(CacheOccupancy, CellsThatAreSeenAreAllThatOneBounceNeeds) {
  const Picture all = picture_by(Occupancy::kAll, 1, 4), seen = picture_by(Occupancy::kDepth, 1, 1);
  ASSERT_GT(mean(all[Pass::kDiffInd]), 0.01);
  EXPECT_EQ(all[Pass::kDiffInd], seen[Pass::kDiffInd]);
  EXPECT_LT(seen.stats.cache.cells, all.stats.cache.cells / 2);
  EXPECT_GT(seen.stats.cache.cells, 20);
  // It is what is chosen then.
  EXPECT_EQ(picture_by(Occupancy::kAuto, 1, 1).stats.cache.cells, seen.stats.cache.cells);
}

TEST_F(CacheOccupancy, AWiderStrideMissesLittle) {
  const Picture exact = picture_by(Occupancy::kDepth, 1, 1, false, 8), wide = picture_by(Occupancy::kDepth, 1, 4, false, 8);
  EXPECT_LE(wide.stats.cache.cells, exact.stats.cache.cells);
  EXPECT_LT(relative_rmse(wide[Pass::kDiffInd], exact[Pass::kDiffInd]), 0.05);
}

TEST_F(CacheOccupancy, MoreBouncesAreLitByCellsThatNobodySees) {
  const Picture geometry = picture_by(Occupancy::kGeometry, 2, 1), seen = picture_by(Occupancy::kDepth, 2, 1);
  EXPECT_GT(geometry.stats.cache.cells, seen.stats.cache.cells);
  EXPECT_EQ(geometry.stats.cache.fewer, 0);
  // Those look in fewer directions, which is hardly seen.
  const Picture tiers = picture_by(Occupancy::kTiers, 2, 1);
  EXPECT_EQ(tiers.stats.cache.cells - tiers.stats.cache.fewer, seen.stats.cache.cells);
  EXPECT_GE(tiers.stats.cache.cells, geometry.stats.cache.cells);
  EXPECT_LT(relative_rmse(tiers[Pass::kDiffInd], geometry[Pass::kDiffInd]), 0.03);
  EXPECT_NEAR(mean(tiers[Pass::kDiffInd]), mean(geometry[Pass::kDiffInd]), 0.01 * mean(geometry[Pass::kDiffInd]));
  // It is what is chosen then.
  EXPECT_EQ(picture_by(Occupancy::kAuto, 2, 1)[Pass::kDiffInd], tiers[Pass::kDiffInd]);
}

TEST_F(CacheOccupancy, CellsThatFewPixelsSeeHaveAllBounces) {
  // Pixels are larger than cells: of those that the picture looks up, most are not known to be seen.
  engine::RenderRequest r = request(perspective({0, -4, 4.5}, {0, 0, 4}, 0.9, 8, 6), {Pass::kDiffInd}, 16);
  r.cache.enabled = true;
  r.cache.resolution = 48;
  r.cache.cascades = 1;
  r.cache.bounces = 2;
  r.cache.occupancy = Occupancy::kTiers;
  const Picture tiers = render(r);
  r.cache.occupancy = Occupancy::kGeometry;
  const Picture geometry = render(r);
  EXPECT_NEAR(mean(tiers[Pass::kDiffInd]), mean(geometry[Pass::kDiffInd]), 0.02 * mean(geometry[Pass::kDiffInd]));
}

TEST_F(CacheOccupancy, DoesNotDependOnTheSampleThatIsRenderedFirst) {
  engine::RenderRequest r = request(inside(1), {Pass::kDiffInd}, 2);
  r.cache.enabled = true;
  r.cache.resolution = 16;
  r.cache.bounces = 1;
  r.cache.occupancy = Occupancy::kDepth;
  r.pieces = true;  // each sample looks the same in every range
  const Picture both = render(r);
  r.first_sample = 0;
  r.last_sample = 1;
  const Picture first = render(r);
  r.first_sample = 1;
  r.last_sample = 2;
  const Picture second = render(r);
  Worst worst;
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x)
      worst.compare(0.5 * (first.value(Pass::kDiffInd, x, y) + second.value(Pass::kDiffInd, x, y)),
                    both.value(Pass::kDiffInd, x, y), 1e-3, x, y);
  EXPECT_WORST_BELOW(worst, 1e-4);
}

}  // namespace
}  // namespace panoptes::test
