#include "support.h"

#include "base/error.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <memory>

namespace panoptes::test {

// --- geometry ------------------------------------------------------------------------------------

scene::MeshInput Geometry::input(const std::string& name) const {
  scene::MeshInput in;
  in.name = name;
  in.positions = positions;
  in.triangle_vertices = triangles;
  in.triangle_loops = loops;
  in.triangle_slots = slots;
  in.loop_normals = normals;
  if (!uv.empty()) in.attributes.push_back({"uv", 2, uv});
  if (!color.empty()) in.attributes.push_back({"color", 4, color});
  in.default_uv = "uv";
  in.default_color = "color";
  return in;
}

scene::Mesh Geometry::mesh(const std::string& name) const { return scene::make_mesh(input(name)); }

Geometry& Geometry::add(const Geometry& other, int slot) {
  const int first_vertex = int(positions.size()), first_loop = int(normals.size());
  positions.insert(positions.end(), other.positions.begin(), other.positions.end());
  normals.insert(normals.end(), other.normals.begin(), other.normals.end());
  uv.insert(uv.end(), other.uv.begin(), other.uv.end());
  color.insert(color.end(), other.color.begin(), other.color.end());
  for (const glm::ivec3& t : other.triangles) triangles.push_back(t + first_vertex);
  for (const glm::ivec3& l : other.loops) loops.push_back(l + first_loop);
  slots.insert(slots.end(), other.triangles.size(), slot);
  return *this;
}

Geometry quad(const glm::vec3& center, const glm::vec3& u, const glm::vec3& v) {
  Geometry g;
  g.positions = {center - u - v, center + u - v, center + u + v, center - u + v};
  g.triangles = g.loops = {{0, 1, 2}, {0, 2, 3}};
  g.slots = {0, 0};
  g.normals.assign(4, glm::normalize(glm::cross(u, v)));
  g.uv = {0, 0, 1, 0, 1, 1, 0, 1};
  return g;
}

Geometry floor_at(float z, float half) { return quad({0, 0, z}, {half, 0, 0}, {0, half, 0}); }

Geometry box(const glm::vec3& center, const glm::vec3& half) {
  Geometry g;
  for (int axis = 0; axis < 3; ++axis)
    for (float side : {1.0f, -1.0f}) {
      glm::vec3 n(0), u(0), v(0);
      n[axis] = side * half[axis];
      u[(axis + 1) % 3] = side * half[(axis + 1) % 3];
      v[(axis + 2) % 3] = half[(axis + 2) % 3];
      g.add(quad(center + n, u, v));
    }
  return g;
}

Geometry sphere(const glm::vec3& center, float radius, int segments, bool smooth) {
  Geometry g;
  const int rings = segments / 2;
  const auto direction = [&](int i, int j) {
    const double theta = kPi * j / rings, phi = 2 * kPi * i / segments;
    return glm::vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                     std::cos(theta));
  };
  for (int j = 0; j < rings; ++j)
    for (int i = 0; i < segments; ++i) {
      const glm::vec3 d[4] = {direction(i, j), direction(i, j + 1), direction(i + 1, j + 1),
                              direction(i + 1, j)};
      for (int half = 0; half < 2; ++half) {
        if ((half == 0 && j == rings - 1) || (half == 1 && j == 0)) continue;  // the poles
        const int a = 0, b = half ? 2 : 1, c = half ? 3 : 2;
        const int first = int(g.positions.size());
        const glm::vec3 corners[3] = {d[a], d[b], d[c]};
        const glm::vec3 flat =
            glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
        for (const glm::vec3& corner : corners) {
          g.positions.push_back(center + radius * corner);
          g.normals.push_back(smooth ? corner : flat);
          g.uv.insert(g.uv.end(), {0, 0});
        }
        g.triangles.push_back({first, first + 1, first + 2});
        g.loops.push_back({first, first + 1, first + 2});
        g.slots.push_back(0);
      }
    }
  return g;
}

// --- materials -----------------------------------------------------------------------------------

const char* const kLambert =
    "void evaluate_material(const Hit hit, inout Surface surface) {\n"
    "  closure_diffuse(surface, vec3(1.0), param(0).rgb, 0.0, hit.normal);\n"
    "}\n";

const char* const kEmit = "void evaluate_material(const Hit hit, inout Surface surface) {\n"
                          "  closure_emission(surface, vec3(1.0), param(0).rgb);\n"
                          "}\n";

scene::Material material(const std::string& code, std::vector<glm::vec4> params,
                         scene::MaterialFacts facts) {
  return {"test", code, std::move(params), {}, {}, facts};
}

scene::Material lambert(const glm::vec3& albedo) {
  return material(kLambert, {glm::vec4(albedo, 1.0f)});
}

scene::Material emitter(const glm::vec3& radiance) {
  return material(kEmit, {glm::vec4(radiance, 1.0f)}, {.emission = true, .glossy = false});
}

scene::Material alpha_card(const glm::vec4& color_alpha) {
  return material("void evaluate_material(const Hit hit, inout Surface surface) {\n"
                  "  closure_diffuse(surface, vec3(param(0).a), param(0).rgb, 0.0, hit.normal);\n"
                  "  closure_transparent(surface, vec3(1.0 - param(0).a), vec3(1.0));\n"
                  "}\n",
                  {color_alpha}, {.alpha = true, .glossy = false});
}

scene::World world(const std::string& code, std::vector<glm::vec4> params) {
  scene::World w;
  w.code = code;
  w.params = std::move(params);
  w.constant.reset();
  return w;
}

scene::World constant_world(const glm::vec3& radiance) {
  scene::World w = world("vec3 evaluate_world(vec3 direction) { return param(0).rgb; }\n",
                         {glm::vec4(radiance, 1.0f)});
  w.constant = radiance;
  return w;
}

// --- lamps ---------------------------------------------------------------------------------------

glm::mat4 lamp_matrix(const glm::vec3& position, const glm::vec3& direction) {
  const glm::vec3 z = -glm::normalize(direction);
  const glm::vec3 up = std::abs(z.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  const glm::vec3 x = glm::normalize(glm::cross(up, z));
  return glm::mat4(glm::vec4(x, 0), glm::vec4(glm::cross(z, x), 0), glm::vec4(z, 0),
                   glm::vec4(position, 1));
}

scene::Light sun(const glm::vec3& direction, float strength) {
  scene::Light l;
  l.type = scene::LightType::kSun;
  l.object_to_world = lamp_matrix({0, 0, 0}, direction);
  l.energy = strength;
  return l;
}

scene::Light point(const glm::vec3& position, float watts, float radius) {
  scene::Light l;
  l.object_to_world = lamp_matrix(position, {0, 0, -1});
  l.energy = watts;
  l.radius = radius;
  return l;
}

scene::Light spot(const glm::vec3& position, const glm::vec3& direction, float watts, float size,
                  float blend) {
  scene::Light l = point(position, watts);
  l.type = scene::LightType::kSpot;
  l.object_to_world = lamp_matrix(position, direction);
  l.spot_size = size;
  l.spot_blend = blend;
  return l;
}

scene::Light area(const glm::vec3& position, const glm::vec3& direction, float watts,
                  scene::AreaShape shape, float size_x, float size_y) {
  scene::Light l;
  l.type = scene::LightType::kArea;
  l.object_to_world = lamp_matrix(position, direction);
  l.energy = watts;
  l.shape = shape;
  l.size_x = size_x;
  l.size_y = size_y;
  return l;
}

// --- cameras -------------------------------------------------------------------------------------

namespace {

glm::dmat4 world_to_camera(const glm::dvec3& eye, const glm::dvec3& target) {
  const glm::dvec3 axis = glm::normalize(target - eye);
  const glm::dvec3 up = std::abs(axis.z) < 0.99 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  return glm::lookAt(eye, target, up);
}

}  // namespace

gpu_scene::Camera perspective(const glm::dvec3& eye, const glm::dvec3& target, double fov_y,
                              int width, int height, double n, double f, glm::dvec2 shift) {
  gpu_scene::Camera camera{world_to_camera(eye, target), glm::dmat4(0.0), width, height};
  glm::dmat4& p = camera.projection;
  p[1][1] = 1.0 / std::tan(0.5 * fov_y);
  p[0][0] = p[1][1] * height / width;
  p[2] = {shift.x, shift.y, -(f + n) / (f - n), -1.0};
  p[3][2] = -2.0 * f * n / (f - n);
  return camera;
}

gpu_scene::Camera orthographic(const glm::dvec3& eye, const glm::dvec3& target, double half_height,
                               int width, int height, double n, double f, glm::dvec2 shift) {
  gpu_scene::Camera camera{world_to_camera(eye, target), glm::dmat4(0.0), width, height};
  glm::dmat4& p = camera.projection;
  p[1][1] = 1.0 / half_height;
  p[0][0] = p[1][1] * height / width;
  p[2][2] = -2.0 / (f - n);
  p[3] = {-shift.x, -shift.y, -(f + n) / (f - n), 1.0};
  return camera;
}

Ray camera_ray(const gpu_scene::Camera& camera, double x, double y) {
  const glm::dmat4 inverse = glm::inverse(camera.projection * camera.world_to_camera);
  const auto unproject = [&](double z) {
    const glm::dvec4 p =
        inverse * glm::dvec4(2 * x / camera.width - 1, 2 * y / camera.height - 1, z, 1.0);
    return glm::dvec3(p) / p.w;
  };
  const glm::dvec3 start = unproject(-1.0);
  return {start, glm::normalize(unproject(0.0) - start)};
}

glm::dvec3 on_plane(const Ray& ray, const glm::dvec3& point, const glm::dvec3& n) {
  return ray.at(glm::dot(point - ray.origin, n) / glm::dot(ray.direction, n));
}

// --- rendering -----------------------------------------------------------------------------------

Id TestScene::add_material(scene::Material m) {
  materials.push_back(std::move(m));
  return Id(materials.size());
}

Id TestScene::add_image(scene::Image image) {
  images.push_back(std::move(image));
  return Id(images.size());
}

Id TestScene::add_object(const Geometry& geometry, const std::vector<Id>& slots,
                         const glm::mat4& object_to_world) {
  meshes.push_back(geometry.mesh());
  add_instance(Id(meshes.size()), slots, object_to_world);
  return Id(meshes.size());
}

void TestScene::add_instance(Id mesh, const std::vector<Id>& slots,
                             const glm::mat4& object_to_world) {
  instances.push_back({mesh, object_to_world, int(table.size())});
  table.insert(table.end(), slots.begin(), slots.end());
}

void TestScene::install(scene::Scene& s) const {
  while (!s.meshes().empty()) s.remove_mesh(s.meshes().begin()->first);
  while (!s.materials().empty()) s.remove_material(s.materials().begin()->first);
  while (!s.images().empty()) s.remove_image(s.images().begin()->first);
  for (size_t i = 0; i < meshes.size(); ++i) s.set_mesh(Id(i + 1), meshes[i]);
  for (size_t i = 0; i < images.size(); ++i) s.set_image(Id(i + 1), images[i]);
  for (size_t i = 0; i < materials.size(); ++i) s.set_material(Id(i + 1), materials[i]);
  s.set_instances(instances, table);
  s.set_lights(lights);
  s.set_world(world);
}

glm::dvec3 Picture::rgb(film::Pass pass, int x, int y) const {
  return {value(pass, x, y, 0), value(pass, x, y, 1), value(pass, x, y, 2)};
}

double Picture::value(film::Pass pass, int x, int y, int channel) const {
  return passes.at(pass)[size_t((y * width + x) * film::info(pass).channels + channel)];
}

namespace {
std::unique_ptr<engine::Engine> the_engine;
}

engine::Engine& shared_engine() {
  if (!the_engine) the_engine = std::make_unique<engine::Engine>();
  return *the_engine;
}

void close_shared_engine() { the_engine.reset(); }

film::PassSet pass_set(const std::vector<film::Pass>& passes) {
  film::PassSet set;
  for (film::Pass pass : passes) set.set(size_t(pass));
  return set;
}

engine::RenderRequest request(const gpu_scene::Camera& camera,
                              const std::vector<film::Pass>& passes, uint32_t samples) {
  engine::RenderRequest r;
  r.camera = camera;
  r.last_sample = samples;
  r.passes = pass_set(passes);
  r.passes.set(size_t(film::Pass::kCombined));
  r.shadow_resolution = 256;
  // What lamps and the world do by themselves is known exactly; tests of the rest switch it on.
  r.cache.enabled = false;
  r.specular_rays.mode = specular_rays::Mode::kOff;
  return r;
}

Picture render(const engine::RenderRequest& request) {
  const auto job = shared_engine().render(request);
  while (!job->wait(60)) throw Error("a render of the tests did not end within a minute");
  job->check();
  Picture picture;
  picture.width = request.camera.width;
  picture.height = request.camera.height;
  picture.stats = job->stats();
  for (int i = 0; i < film::kPassCount; ++i) {
    if (!request.passes[size_t(i)]) continue;
    const film::Pass pass = film::Pass(i);
    picture.passes[pass] = job->read(pass);
    size_t broken = 0;
    for (float value : picture.passes[pass]) broken += !std::isfinite(value);
    EXPECT_EQ(broken, 0u) << "values that are not finite in pass " << film::info(pass).name;
  }
  return picture;
}

Picture render(const TestScene& setup, const engine::RenderRequest& request) {
  shared_engine().edit([&](scene::Scene& scene) { setup.install(scene); });
  return render(request);
}

// --- judging -------------------------------------------------------------------------------------

void Worst::compare(double actual, double expected, double floor, int x, int y) {
  ++count_;
  double error = std::abs(actual - expected) / std::max(std::abs(expected), floor);
  if (!std::isfinite(error)) error = std::numeric_limits<double>::infinity();
  if (error < error_) return;
  error_ = error;
  actual_ = actual;
  expected_ = expected;
  x_ = x;
  y_ = y;
}

std::string Worst::where() const {
  return fmt::format("at ({}, {}): {} where {} is due, {:.3g} off", x_, y_, actual_, expected_,
                     error_);
}

void expect_on_floor(const Picture& picture, const gpu_scene::Camera& camera,
                     const std::function<double(glm::dvec3)>& expected, double tolerance) {
  Worst worst;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const glm::dvec3 p = on_plane(pixel_ray(camera, x, y), {0, 0, 0}, {0, 0, 1});
      worst.compare(picture.value(film::Pass::kDiffDir, x, y), expected(p), 1e-6, x, y);
    }
  EXPECT_WORST_BELOW(worst, tolerance);
}

double relative_rmse(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (double(a[i]) - b[i]) * (double(a[i]) - b[i]);
  return std::sqrt(sum / double(a.size())) / mean(b);
}

double mean(const std::vector<float>& values) {
  double sum = 0;
  for (float v : values) sum += v;
  return sum / double(values.size());
}

}  // namespace panoptes::test
