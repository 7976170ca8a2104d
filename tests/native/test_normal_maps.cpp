// Normal maps, the correction of normals against the view, and the term that fades light out where
// a mapped normal leaves the interpolated one; formulas as measured in Cycles 3.4.
#include "support.h"

#include <cmath>

namespace panoptes::test {
namespace {

using film::Pass;

// Normals are packed to .0037 degrees, 6.5e-5.
constexpr double kPacked = 2e-4;

const char* const kTangentMap =
    "void evaluate_material(const Hit hit, inout Surface surface) {\n"
    "  vec3 n = normal_map_tangent(hit, UV_DEFAULT, param(0).rgb, param(0).a);\n"
    "  closure_diffuse(surface, vec3(1.0), vec3(1.0), 0.0, n);\n"
    "}\n";

// Colour of a texel that stands for the unit vector n.
glm::vec4 texel(const glm::dvec3& n, double strength = 1) {
  return glm::vec4(glm::vec3(0.5 * glm::normalize(n) + 0.5), float(strength));
}

// Turns N towards Ng in their plane until the mirrored view leaves the surface.
glm::dvec3 corrected(const glm::dvec3& n, const glm::dvec3& ng, const glm::dvec3& view) {
  const double t = std::min(0.9 * glm::dot(view, ng), 0.01);
  const glm::dvec3 mirrored = 2 * glm::dot(n, view) * n - view;
  if (glm::dot(mirrored, ng) >= t) return n;
  const glm::dvec3 x = glm::normalize(n - glm::dot(n, ng) * ng);
  const double ix = glm::dot(view, x), iz = glm::dot(view, ng);
  const double a = 0.5 * (std::atan2(ix, iz) + std::acos(t / std::hypot(ix, iz)));
  return std::sin(a) * x + std::cos(a) * ng;
}

double bump(const glm::dvec3& smooth, const glm::dvec3& n, const glm::dvec3& l) {
  const double g = glm::dot(smooth, l) / (glm::dot(n, l) * glm::dot(n, smooth));
  return g >= 1 ? 1 : g <= 0 ? 0 : -g * g * g + g * g + g;
}

const glm::dvec3 kUp(0, 0, 1);

struct Mapped {
  TestScene s;
  Id mesh;
  explicit Mapped(const glm::dvec3& n, const glm::mat4& matrix = glm::mat4(1), double strength = 1,
                  Geometry g = floor_at(0, 2)) {
    mesh = s.add_object(g,
                        {s.add_material(material(kTangentMap, {texel(n, strength)},
                                                 {.normal_map = true, .glossy = false}))},
                        matrix);
  }
  glm::dvec3 normal(const glm::dvec3& view) const {
    const Picture p =
        render(s, request(orthographic(3.0 * glm::normalize(view), {0, 0, 0}, 0.01, 3, 3),
                          {Pass::kNormal}));
    return p.rgb(Pass::kNormal, 1, 1);
  }
};

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance = kPacked) {
  EXPECT_LT(glm::length(a - b), tolerance)
      << fmt::format("({:.5f}, {:.5f}, {:.5f}) where ({:.5f}, {:.5f}, {:.5f}) is due", a.x, a.y,
                     a.z, b.x, b.y, b.z);
}

TEST(NormalMaps, TiltAlongTheTextureAxes) {
  for (const glm::dvec3& raw : {glm::dvec3(0, 0, 1), glm::dvec3(0.3, 0, 1), glm::dvec3(0, 0.3, 1),
                                glm::dvec3(-0.2, 0.4, 1)})
    expect_near(Mapped(raw).normal(kUp), glm::normalize(raw));
}

TEST(NormalMaps, AreCorrectedAgainstTheView) {
  // Three angles that were read off Cycles: view (radians from the normal), n.x, corrected n.x.
  struct Case {
    double view, nx, due;
  };
  for (const Case& c :
       {Case{0, 0.8, 0.70356}, Case{0.9, -0.6, -0.32442}, Case{1.5, -0.6, -0.03039}}) {
    const glm::dvec3 view(std::sin(c.view), 0, std::cos(c.view));
    const glm::dvec3 n = Mapped({c.nx, 0, std::sqrt(1 - c.nx * c.nx)}).normal(view);
    EXPECT_NEAR(n.x, c.due, kPacked);
    EXPECT_NEAR(corrected({c.nx, 0, std::sqrt(1 - c.nx * c.nx)}, kUp, view).x, c.due, 1e-4);
  }
  for (double angle = 0; angle < 6; angle += 0.7)
    for (double tilt : {0.3, 0.9, 1.4}) {
      const glm::dvec3 view = glm::normalize(glm::dvec3(0.9, 0.2, 0.5));
      const glm::dvec3 n(std::sin(tilt) * std::cos(angle), std::sin(tilt) * std::sin(angle),
                         std::cos(tilt));
      // Where the mirrored view just reaches the horizon, the switch may fall to either side.
      expect_near(Mapped(n).normal(view), corrected(n, kUp, view), 5e-4);
    }
}

TEST(NormalMaps, LightFadesBeforeTheSurfacesHorizon) {
  const glm::dvec3 n = glm::normalize(glm::dvec3(0.6, 0.1, 1));
  Mapped m(n);
  for (const glm::dvec3& raw : {glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0.3), glm::dvec3(1, 0, 0.05),
                                glm::dvec3(-1, 0.3, 1), glm::dvec3(1, 0, -0.1)}) {
    const glm::dvec3 l = glm::normalize(raw);
    m.s.lights = {sun(glm::vec3(-l), float(kPi))};
    m.s.lights[0].cast_shadow = false;
    const Picture p =
        render(m.s, request(orthographic(3.0 * kUp, {0, 0, 0}, 0.01, 3, 3), {Pass::kDiffDir}));
    const double due = std::max(glm::dot(n, l), 0.0) * bump(kUp, n, l);
    EXPECT_NEAR(p.value(Pass::kDiffDir, 1, 1), due, 3e-4) << raw.x << " " << raw.z;
  }
}

TEST(NormalMaps, StrengthMixesUnitVectors) {
  const glm::dvec3 n = glm::normalize(glm::dvec3(0.3, -0.2, 1));
  for (double strength : {0.0, 0.25, 1.0, 2.0})
    expect_near(Mapped(n, glm::mat4(1), strength).normal(kUp),
                glm::normalize(glm::mix(kUp, n, strength)));
}

TEST(NormalMaps, MirrorWithTheObjectAndWithTheTexture) {
  const glm::dvec3 n = glm::normalize(glm::dvec3(0.3, 0.2, 1));
  const glm::dvec3 mirrored(-n.x, n.y, n.z);
  glm::mat4 matrix(1);
  matrix[0].x = -1;
  expect_near(Mapped(n, matrix).normal(kUp), mirrored);
  Geometry flipped = floor_at(0, 2);
  for (size_t i = 0; i < flipped.uv.size(); i += 2) flipped.uv[i] = 1 - flipped.uv[i];
  expect_near(Mapped(n, glm::mat4(1), 1, flipped).normal(kUp), mirrored);
  expect_near(Mapped(n, matrix, 1, flipped).normal(kUp), n);
}

TEST(NormalMaps, FollowRotationsAndScales) {
  const glm::dvec3 n = glm::normalize(glm::dvec3(0.3, 0.2, 1));
  // Object x -> world y, y -> world -x, stretched along one axis; all squeezed along the normal.
  const glm::mat4 matrix(glm::vec4(0, 3, 0, 0), glm::vec4(-1, 0, 0, 0), glm::vec4(0, 0, 0.1f, 0),
                         glm::vec4(0, 0, 0, 1));
  // The map is read in object space and goes on as a normal, by the inverse of the scale.
  expect_near(Mapped(n, matrix).normal(kUp), glm::normalize(glm::dvec3(-n.y, n.x / 3, n.z / 0.1)));
}

TEST(NormalMaps, AreNegatedOnBackFaces) {
  const glm::dvec3 n = glm::normalize(glm::dvec3(0.3, 0.2, 1));
  expect_near(Mapped(n).normal(-kUp), -n);
}

TEST(NormalMaps, ABlackTexelIsADirectionToo) {
  Mapped m({1, 0, 0});
  m.s.materials[0].params[0] = {0, 0, 0, 1};
  expect_near(m.normal(kUp), corrected(glm::normalize(glm::dvec3(-1, -1, -1)), kUp, kUp));
}

TEST(NormalMaps, WithoutTextureCoordinatesDoNothing) {
  Geometry bare = floor_at(0, 2);
  bare.uv.clear();
  expect_near(Mapped({0.3, 0.2, 1}, glm::mat4(1), 1, bare).normal(kUp), kUp);
}

TEST(NormalMaps, DegenerateCoordinatesUseTheObjectsXAxis) {
  Geometry degenerate = floor_at(0, 2);
  degenerate.uv.assign(8, 0.5f);
  const glm::dvec3 n = Mapped({0.3, 0, 1}, glm::mat4(1), 1, degenerate).normal(kUp);
  expect_near(n, glm::normalize(glm::dvec3(0.3, 0, 1)));
}

TEST(NormalMaps, InObjectAndWorldSpace) {
  const char* code = "void evaluate_material(const Hit hit, inout Surface surface) {\n"
                     "  vec3 n = param(1).x > 0.5 ? normal_map_object(hit, param(0).rgb, 1.0)\n"
                     "                            : normal_map_world(hit, param(0).rgb, 1.0);\n"
                     "  closure_diffuse(surface, vec3(1.0), vec3(1.0), 0.0, n);\n"
                     "}\n";
  const glm::dvec3 n = glm::normalize(glm::dvec3(0.3, 0.2, 1));
  // A turn by 90 degrees about z with a stretch along the object's x.
  const glm::mat4 turned(glm::vec4(0, 2, 0, 0), glm::vec4(-1, 0, 0, 0), glm::vec4(0, 0, 1, 0),
                         glm::vec4(0, 0, 0, 1));
  glm::mat4 mirrored = turned;
  mirrored[0] *= -1.0f;
  for (const glm::mat4& matrix : {turned, mirrored})
    for (float object : {1.0f, 0.0f}) {
      TestScene s;
      s.add_object(floor_at(0, 2),
                   {s.add_material(material(code, {texel(n), glm::vec4(object)},
                                            {.normal_map = true, .glossy = false}))},
                   matrix);
      const Picture p =
          render(s, request(orthographic({0, 0, 3}, {0, 0, 0}, 0.01, 3, 3), {Pass::kNormal}));
      const glm::dmat3 inverse = glm::transpose(glm::inverse(glm::dmat3(matrix)));
      expect_near(p.rgb(Pass::kNormal, 1, 1), object > 0.5f ? glm::normalize(inverse * n) : n);
    }
}

// --- interpolated normals ------------------------------------------------------------------------

TEST(SmoothNormals, AreCorrectedAgainstTheViewAsMappedOnesAre) {
  // Measured: a smooth normal tilted by .7, seen from -.5: N' = (sin .5304, 0, cos .5304).
  Geometry g = floor_at(0, 2);
  const glm::dvec3 smooth(std::sin(0.7), 0, std::cos(0.7));
  g.normals.assign(4, glm::vec3(smooth));
  TestScene s;
  s.add_object(g, {s.add_material(lambert())});
  const glm::dvec3 view(std::sin(-0.5), 0, std::cos(0.5));
  const gpu_scene::Camera camera = orthographic(3.0 * view, {0, 0, 0}, 0.01, 3, 3);
  const glm::dvec3 n = corrected(smooth, kUp, view);
  EXPECT_NEAR(n.x, std::sin(0.5304), 1e-4);
  expect_near(render(s, request(camera, {Pass::kNormal})).rgb(Pass::kNormal, 1, 1), n);
  for (const glm::dvec3& raw :
       {glm::dvec3(0, 0, 1), glm::dvec3(-1, 0, 0.6), glm::dvec3(1, 1, 0.2)}) {
    const glm::dvec3 l = glm::normalize(raw);
    s.lights = {sun(glm::vec3(-l), float(kPi))};
    s.lights[0].cast_shadow = false;
    const double due = std::max(glm::dot(n, l), 0.0) * bump(smooth, n, l);
    EXPECT_NEAR(render(s, request(camera, {Pass::kDiffDir})).value(Pass::kDiffDir, 1, 1), due,
                3e-4);
  }
}

TEST(SmoothNormals, AreNotCutWhereTheFacetLooksAway) {
  // Light arrives by the shading normal alone, even from below the facet's own plane.
  Geometry g = floor_at(0, 2);
  const glm::dvec3 smooth(std::sin(0.7), 0, std::cos(0.7));
  g.normals.assign(4, glm::vec3(smooth));
  TestScene s;
  s.add_object(g, {s.add_material(lambert())});
  const glm::dvec3 l = glm::normalize(glm::dvec3(1, 0, -0.3));
  s.lights = {sun(glm::vec3(-l), float(kPi))};
  s.lights[0].cast_shadow = false;
  const gpu_scene::Camera camera =
      orthographic({3 * std::sin(0.5), 0, 3 * std::cos(0.5)}, {0, 0, 0}, 0.01, 3, 3);
  EXPECT_NEAR(render(s, request(camera, {Pass::kDiffDir})).value(Pass::kDiffDir, 1, 1),
              glm::dot(smooth, l), 3e-4);
}

TEST(SmoothNormals, TurnWithNonUniformScales) {
  TestScene s;
  s.add_object(sphere({0, 0, 0}, 1, 64), {s.add_material(lambert())},
               glm::mat4(glm::vec4(2, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 0.5f, 0),
                         glm::vec4(0, 0, 0, 1)));
  const gpu_scene::Camera camera = orthographic({0, 0, 3}, {0, 0, 0}, 1, 16, 16);
  const Picture p = render(s, request(camera, {Pass::kNormal, Pass::kDepth}));
  int seen = 0;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const glm::dvec3 at = on_plane(pixel_ray(camera, x, y), {0, 0, 0}, {0, 0, 1});
      const double q = 1 - at.x * at.x / 4 - at.y * at.y;  // x^2/4 + y^2 + 4 z^2 = 1
      if (q < 0.2) continue;
      ++seen;
      const double z = 0.5 * std::sqrt(q);
      expect_near(p.rgb(Pass::kNormal, x, y), glm::normalize(glm::dvec3(at.x / 4, at.y, 4 * z)),
                  0.02);
    }
  EXPECT_GT(seen, 100);
}

}  // namespace
}  // namespace panoptes::test
