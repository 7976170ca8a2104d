// Shared by the native tests: small scenes, cameras whose rays the tests know in double precision,
// and one engine for all tests of a process.
#pragma once

#include "base/error.h"
#include "engine/engine.h"
#include "scene/scene.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace panoptes::test {

using scene::Id;

constexpr double kPi = 3.14159265358979323846;

// --- geometry ------------------------------------------------------------------------------------

// A mesh as Blender would hand it over; loops carry normals, UVs ("uv") and colours ("color").
struct Geometry {
  std::vector<glm::vec3> positions;
  std::vector<glm::ivec3> triangles, loops;
  std::vector<int> slots;
  std::vector<glm::vec3> normals;
  std::vector<float> uv, color;  // color may be empty

  scene::MeshInput input(const std::string& name = "mesh") const;
  scene::Mesh mesh(const std::string& name = "mesh") const;
  // Appends `other` with all its triangles in `slot`.
  Geometry& add(const Geometry& other, int slot = 0);
};

// The parallelogram center ± u ± v with normal u x v; UVs run from (0,0) at -u-v to (1,1) at +u+v.
Geometry quad(const glm::vec3& center, const glm::vec3& u, const glm::vec3& v);
// A horizontal square that faces up.
Geometry floor_at(float z, float half);
Geometry box(const glm::vec3& center, const glm::vec3& half);
// Latitude-longitude sphere; smooth normals point away from the centre.
Geometry sphere(const glm::vec3& center, float radius, int segments, bool smooth = true);

// --- materials -----------------------------------------------------------------------------------

// Codes: one Lambert lobe of colour param(0), or emission of param(0).
extern const char* const kLambert;
extern const char* const kEmit;
scene::Material material(const std::string& code, std::vector<glm::vec4> params,
                         scene::MaterialFacts facts = {.glossy = false});
scene::Material lambert(const glm::vec3& albedo = glm::vec3(1.0f));
scene::Material emitter(const glm::vec3& radiance);
// A card of Lambert material whose alpha is param(0).a.
scene::Material alpha_card(const glm::vec4& color_alpha);
scene::World constant_world(const glm::vec3& radiance);
scene::World world(const std::string& code, std::vector<glm::vec4> params = {});

// --- lamps ---------------------------------------------------------------------------------------

glm::mat4 lamp_matrix(const glm::vec3& position, const glm::vec3& direction);
scene::Light sun(const glm::vec3& direction, float strength);
scene::Light point(const glm::vec3& position, float watts, float radius = 0);
scene::Light spot(const glm::vec3& position, const glm::vec3& direction, float watts, float size,
                  float blend);
scene::Light area(const glm::vec3& position, const glm::vec3& direction, float watts,
                  scene::AreaShape shape, float size_x, float size_y);

// --- cameras -------------------------------------------------------------------------------------

gpu_scene::Camera perspective(const glm::dvec3& eye, const glm::dvec3& target, double fov_y,
                              int width, int height, double near_depth = 0.01,
                              double far_depth = 1000.0, glm::dvec2 shift = {0, 0});
gpu_scene::Camera orthographic(const glm::dvec3& eye, const glm::dvec3& target, double half_height,
                               int width, int height, double near_depth = 0.01,
                               double far_depth = 1000.0, glm::dvec2 shift = {0, 0});

struct Ray {
  glm::dvec3 origin, direction;  // origin on the near plane, direction unit
  glm::dvec3 at(double t) const { return origin + t * direction; }
};
// The ray through (x, y) in pixels from the lower left corner, by the inverse of the matrices.
Ray camera_ray(const gpu_scene::Camera& camera, double x, double y);
inline Ray pixel_ray(const gpu_scene::Camera& camera, int x, int y) {
  return camera_ray(camera, x + 0.5, y + 0.5);
}
// Where that ray meets the plane through `point` with normal `n`.
glm::dvec3 on_plane(const Ray& ray, const glm::dvec3& point, const glm::dvec3& n);

// --- rendering -----------------------------------------------------------------------------------

struct TestScene {
  std::vector<scene::Mesh> meshes;  // ids are 1 + index, here and below
  std::vector<scene::Material> materials;
  std::vector<scene::Image> images;
  std::vector<scene::Instance> instances;
  std::vector<Id> table;
  std::vector<scene::Light> lights;
  scene::World world;

  Id add_material(scene::Material m);
  Id add_image(scene::Image image);
  // A mesh with one instance; a material a slot.
  Id add_object(const Geometry& geometry, const std::vector<Id>& slots,
                const glm::mat4& object_to_world = glm::mat4(1.0f));
  void add_instance(Id mesh, const std::vector<Id>& slots, const glm::mat4& object_to_world);
  // Hands everything to a scene, which is emptied first.
  void install(scene::Scene& scene) const;
};

struct Picture {
  int width = 0, height = 0;
  std::map<film::Pass, std::vector<float>> passes;
  engine::RenderStats stats;

  const std::vector<float>& operator[](film::Pass pass) const { return passes.at(pass); }
  glm::dvec3 rgb(film::Pass pass, int x, int y) const;
  double value(film::Pass pass, int x, int y, int channel = 0) const;
};

// One engine for the process, made when it is first asked for.
engine::Engine& shared_engine();
void close_shared_engine();

film::PassSet pass_set(const std::vector<film::Pass>& passes);
// Asks for `passes` and Combined with small shadow maps; samples 0 .. `samples` - 1.
engine::RenderRequest request(const gpu_scene::Camera& camera,
                              const std::vector<film::Pass>& passes, uint32_t samples = 1);
// Renders what the shared engine's scene holds; every value must be finite.
Picture render(const engine::RenderRequest& request);
// Installs `setup` first.
Picture render(const TestScene& setup, const engine::RenderRequest& request);

// --- judging -------------------------------------------------------------------------------------

// Remembers the worst of many comparisons, so that a picture that is wrong gives one message.
class Worst {
 public:
  // |actual - expected| divided by max(|expected|, floor); anything not finite counts as infinite.
  void compare(double actual, double expected, double floor, int x, int y);
  double error() const { return error_; }
  int count() const { return count_; }
  std::string where() const;

 private:
  double error_ = 0, actual_ = 0, expected_ = 0;
  int x_ = 0, y_ = 0, count_ = 0;
};

// Expects Diffuse Direct of a picture of the floor z = 0 to be `expected` at the points of the floor
// that the pixels' centres show, within a relative `tolerance`.
void expect_on_floor(const Picture& picture, const gpu_scene::Camera& camera,
                     const std::function<double(glm::dvec3)>& expected, double tolerance);

// Root mean square of a - b divided by the mean of b, over all values.
double relative_rmse(const std::vector<float>& a, const std::vector<float>& b);
double mean(const std::vector<float>& values);

#define EXPECT_WORST_BELOW(worst, tolerance)                         \
  EXPECT_TRUE((worst).count() > 0 && (worst).error() <= (tolerance)) \
      << (worst).where() << ", " << (tolerance) << " allowed "

// Expects panoptes::Error whose message holds `part`, in one sentence that has a remedy.
template <class F>
void expect_error(F&& f, const std::string& part) {
  try {
    f();
    FAIL() << "no error was thrown where '" << part << "' was expected";
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_NE(message.find(':'), std::string::npos) << "no remedy in: " << message;
  }
}

}  // namespace panoptes::test
