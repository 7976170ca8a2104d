// What lamps emit and where their points lie, by Cycles' conventions.
#include "support.h"

#include <cmath>
#include <functional>

namespace panoptes::test {
namespace {

TEST(LampPower, FollowsCyclesConventions) {
  const float p = 12.0f;
  scene::Light lamp = point({0, 0, 1}, p);
  lamp.color = {1, 0.5f, 0.25f};
  // W/sr: a point spreads its watts over the whole sphere; a spot is not brighter for its cone.
  EXPECT_NEAR(lamp.power().r, p / (4 * kPi), 1e-6);
  EXPECT_NEAR(lamp.power().b, 0.25 * p / (4 * kPi), 1e-6);
  EXPECT_NEAR(spot({0, 0, 1}, {0, 0, -1}, p, 0.3f, 0.5f).power().r, p / (4 * kPi), 1e-6);
  // W/m2 at normal incidence.
  EXPECT_EQ(sun({0, 0, -1}, p).power().r, p);
  // A Lambertian emitter of radiance P / (4 A): P / 4 along its axis, whatever its size.
  EXPECT_EQ(area({0, 0, 1}, {0, 0, -1}, p, scene::AreaShape::kDisk, 1, 1).power().r, p / 4);
  EXPECT_EQ(area({0, 0, 1}, {0, 0, -1}, p, scene::AreaShape::kSquare, 9, 1).power().r, p / 4);
}

TEST(LampPower, DoesNotDependOnTheObjectsScale) {
  for (scene::Light lamp :
       {point({0, 0, 1}, 5), spot({0, 0, 1}, {1, 0, -1}, 5, 1, 0), sun({1, 2, -3}, 5),
        area({0, 0, 1}, {0, 1, -1}, 5, scene::AreaShape::kSquare, 1, 1)}) {
    const glm::vec3 before = lamp.power(), direction = lamp.direction();
    for (int c = 0; c < 3; ++c) lamp.object_to_world[c] *= 7.0f;
    EXPECT_EQ(lamp.power(), before);
    EXPECT_LT(glm::length(lamp.direction() - direction), 1e-6f);
  }
}

TEST(LampDirection, PointsDownWhereTheMatrixIsSingular) {
  scene::Light lamp = sun({0, 0, -1}, 1);
  lamp.object_to_world = glm::mat4(0.0f);
  EXPECT_EQ(lamp.direction(), glm::vec3(0, 0, -1));
}

TEST(LampExtent, IsWhatCastsPenumbrae) {
  EXPECT_FALSE(point({0, 0, 0}, 1).extended());
  EXPECT_TRUE(point({0, 0, 0}, 1, 0.1f).extended());
  scene::Light lamp = sun({0, 0, -1}, 1);
  EXPECT_FALSE(lamp.extended());
  lamp.angle = 0.01f;
  EXPECT_TRUE(lamp.extended());
  lamp = area({0, 0, 0}, {0, 0, -1}, 1, scene::AreaShape::kRectangle, 0, 0);
  EXPECT_FALSE(lamp.extended());
  lamp.size_y = 1;
  EXPECT_TRUE(lamp.extended());
}

// Calls visit(sample) for n x n points of the unit square, at the cells' centres.
void for_points(const scene::Light& lamp, int n, const glm::vec3& target,
                const std::function<void(const scene::LightSample&)>& visit) {
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      visit(scene::sample_light(lamp, (float(i) + 0.5f) / float(n), (float(j) + 0.5f) / float(n),
                                target));
}

TEST(SampleLight, SunIsADiskOfTheRightRadiusUniformInArea) {
  scene::Light lamp = sun({0.3f, -0.5f, -1}, 1);
  lamp.angle = 0.6f;
  const glm::dvec3 axis(lamp.direction());
  const double radius = std::tan(0.3);
  double farthest = 0, squares = 0;
  glm::dvec3 sum(0);
  int count = 0, inner = 0;
  for_points(lamp, 200, {}, [&](const scene::LightSample& s) {
    const glm::dvec3 d(s.direction);
    EXPECT_NEAR(glm::length(d), 1.0, 1e-6);
    const glm::dvec3 on_disk = d / glm::dot(d, axis) - axis;
    const double r = glm::length(on_disk);
    farthest = std::max(farthest, r);
    squares += r * r;
    inner += r < radius / 2;
    sum += on_disk;
    ++count;
  });
  EXPECT_NEAR(farthest, radius, 0.01 * radius);  // the outermost cell centres
  EXPECT_LE(farthest, radius * (1 + 1e-5));
  EXPECT_NEAR(squares / count, radius * radius / 2, 1e-3 * radius * radius);
  EXPECT_NEAR(double(inner) / count, 0.25, 5e-3);
  EXPECT_LT(glm::length(sum) / count, 1e-4 * radius);
}

TEST(SampleLight, SunsNearHalfTheSkyStayFinite) {
  scene::Light lamp = sun({0, 0, -1}, 1);
  for (float angle : {1.0f, 3.0f, 3.14159265f, 6.0f}) {
    lamp.angle = angle;
    for_points(lamp, 16, {}, [&](const scene::LightSample& s) {
      ASSERT_TRUE(std::isfinite(s.direction.x) && s.direction.z < 0);
    });
  }
}

TEST(SampleLight, AreasFillTheirShape) {
  struct Case {
    scene::AreaShape shape;
    float size_y;     // as the lamp has it
    double extent_y;  // as it must be used
    bool round;
  };
  for (const Case& c : {Case{scene::AreaShape::kSquare, 9, 2, false},
                        Case{scene::AreaShape::kRectangle, 0.5f, 0.5, false},
                        Case{scene::AreaShape::kDisk, 9, 2, true},
                        Case{scene::AreaShape::kEllipse, 0.5f, 0.5, true}}) {
    scene::Light lamp = area({1, 2, 3}, {0, 0, -1}, 1, c.shape, 2, c.size_y);
    lamp.object_to_world[0] *= 3.0f;  // the object's scale counts along each axis
    const double hx = 3.0, hy = c.extent_y / 2;
    const glm::dvec3 x = glm::normalize(glm::dvec3(lamp.object_to_world[0])),
                     y(lamp.object_to_world[1]);
    glm::dvec2 low(1e9), high(-1e9), sum(0), squares(0);
    int count = 0;
    for_points(lamp, 100, {}, [&](const scene::LightSample& s) {
      const glm::dvec3 d = glm::dvec3(s.position) - glm::dvec3(1, 2, 3);
      const glm::dvec2 p{glm::dot(d, x), glm::dot(d, y)};
      EXPECT_NEAR(glm::length(d - p.x * x - p.y * y), 0, 1e-5);
      if (c.round) {
        EXPECT_LE(std::hypot(p.x / hx, p.y / hy), 1 + 1e-5);
      }
      low = glm::min(low, p);
      high = glm::max(high, p);
      sum += p;
      squares += p * p;
      ++count;
    });
    // Centres of 100 cells end .5 % before the border; a disk's a little more.
    EXPECT_NEAR(high.x, hx, 0.012 * hx);
    EXPECT_NEAR(low.x, -hx, 0.012 * hx);
    EXPECT_NEAR(high.y, hy, 0.012 * hy);
    EXPECT_NEAR(low.y, -hy, 0.012 * hy);
    EXPECT_NEAR(sum.x / count, 0, 1e-3 * hx);
    EXPECT_NEAR(sum.y / count, 0, 1e-3 * hy);
    // Uniform: the mean square is h^2 / 3 on a line, h^2 / 4 on a disk.
    const double share = c.round ? 0.25 : 1.0 / 3;
    EXPECT_NEAR(squares.x / count, share * hx * hx, 2e-3 * hx * hx);
    EXPECT_NEAR(squares.y / count, share * hy * hy, 2e-3 * hy * hy);
  }
}

TEST(SampleLight, PointsFaceTheTargetAndSpotsTheirAxis) {
  const glm::vec3 target(4, -2, 1);
  for (scene::Light lamp : {point({1, 1, 3}, 5, 0.7f), spot({1, 1, 3}, {0, 0, -1}, 5, 1, 0)}) {
    lamp.radius = 0.7f;
    const glm::dvec3 axis = lamp.type == scene::LightType::kSpot
                                ? glm::dvec3(0, 0, -1)
                                : glm::normalize(glm::dvec3(target) - glm::dvec3(1, 1, 3));
    double squares = 0, farthest = 0;
    glm::dvec3 sum(0);
    int count = 0;
    for_points(lamp, 100, target, [&](const scene::LightSample& s) {
      const glm::dvec3 d = glm::dvec3(s.position) - glm::dvec3(1, 1, 3);
      EXPECT_NEAR(glm::dot(d, axis), 0, 1e-6);
      EXPECT_EQ(s.direction, lamp.direction());
      squares += glm::dot(d, d);
      farthest = std::max(farthest, glm::length(d));
      sum += d;
      ++count;
    });
    EXPECT_NEAR(farthest, 0.7, 0.012 * 0.7);
    EXPECT_NEAR(squares / count, 0.7 * 0.7 / 2, 2e-3 * 0.49);
    EXPECT_LT(glm::length(sum) / count, 1e-3 * 0.7);
  }
}

TEST(SampleLight, PointsWithoutAnExtentHaveOnePlace) {
  for (const scene::Light& lamp : {point({1, 2, 3}, 5), spot({1, 2, 3}, {0, 1, 0}, 5, 1, 0),
                                   area({1, 2, 3}, {0, 1, 0}, 5, scene::AreaShape::kEllipse, 0, 0)})
    for_points(lamp, 4, {0, 0, 0},
               [&](const scene::LightSample& s) { EXPECT_EQ(s.position, glm::vec3(1, 2, 3)); });
  const scene::Light lamp = sun({0, 0.6f, -0.8f}, 5);
  for_points(lamp, 4, {}, [&](const scene::LightSample& s) {
    EXPECT_LT(glm::length(s.direction - lamp.direction()), 1e-7f);
  });
}

TEST(SampleLight, ATargetOnTheLampDoesNoHarm) {
  scene::Light lamp = point({1, 2, 3}, 5, 0.5f);
  for_points(lamp, 8, {1, 2, 3}, [&](const scene::LightSample& s) {
    EXPECT_LE(glm::length(s.position - glm::vec3(1, 2, 3)), 0.5f * 1.0001f);
  });
}

TEST(SampleLight, KeepsNeighboursTogether) {
  // What strata are worth: the map to the disk moves no point faster than its steepest derivative,
  // sqrt(2^2 + (pi / 2)^2) = 2.54 radii for a unit step.
  scene::Light lamp = area({0, 0, 0}, {0, 0, -1}, 1, scene::AreaShape::kDisk, 2, 2);
  const int n = 256;
  double fastest = 0;
  for (int i = 0; i + 1 < n; ++i)
    for (int j = 0; j + 1 < n; ++j) {
      const auto at = [&](int a, int b) {
        return scene::sample_light(lamp, (float(a) + 0.5f) / n, (float(b) + 0.5f) / n, {}).position;
      };
      const glm::vec3 p = at(i, j);
      fastest = std::max<double>(fastest, glm::length(at(i + 1, j) - p) * n);
      fastest = std::max<double>(fastest, glm::length(at(i, j + 1) - p) * n);
    }
  EXPECT_LT(fastest, 2.56);
  EXPECT_GT(fastest, 1.9);
}

}  // namespace
}  // namespace panoptes::test
