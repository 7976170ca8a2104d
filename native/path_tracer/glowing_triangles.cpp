#include "path_tracer/glowing_triangles.h"

#include "rasterize/emitter_radiance.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace panoptes::path_tracer {

namespace {

// Points at which triangles are asked whose radiance varies: many where there are few triangles, so
// that a screen's picture is known; a few each of many.
constexpr size_t kAllPoints = 65536;
constexpr size_t kLeastPoints = 4, kMostPoints = 64;

// Of the mean radiance of its neighbours a triangle has at least this share, as far as choice goes: a
// spot that all points have missed is still found.
constexpr float kLeastShare = 1.0f / 16;

// Asked at once, which bounds the memory that asking takes.
constexpr size_t kProbesAtOnce = 1 << 20;

// Triangles of one material of one instance.
struct Part {
  const scene::Instance* instance;
  const scene::Mesh* mesh;
  scene::MaterialRange range;
  uint32_t place;            // of the instance on the GPU
  uint32_t first_primitive;
  scene::Id material;
  bool varies;
};

std::vector<Part> glowing_parts(const scene::Scene& scene, const gpu_scene::GpuScene& gpu) {
  std::vector<Part> parts;
  uint32_t primitive = 0;
  for (size_t i = 0; i < scene.instances().size(); ++i) {
    const scene::Instance& instance = scene.instances()[i];
    const scene::Mesh* mesh = scene.mesh_of(instance);
    if (!mesh) continue;
    for (const scene::MaterialRange& range : mesh->ranges) {
      const scene::Id id = scene.material_of(instance, range.slot);
      const auto material = scene.materials().find(id);
      if (range.count > 0 && (instance.visibility & shared::SEEN_BY_SCATTERED) && material != scene.materials().end() &&
          material->second.facts.emission)
        parts.push_back({&instance, mesh, range, gpu.place_of(i), primitive, id,
                         material->second.facts.emission_varies});
      primitive += range.count;
    }
  }
  return parts;
}

class Prober {
 public:
  Prober(const gpu_scene::GpuScene& gpu, gl::ProgramCache& programs) : gpu_(gpu), programs_(programs) {}

  void ask(const Part& part, uint32_t triangle, float u, float v) {
    probes_.push_back({part.material, {part.place, triangle, u, v}});
    if (probes_.size() == kProbesAtOnce) flush();
  }
  // All answers, in the order of the questions.
  std::vector<shared::EmitterRadiance> answers() {
    flush();
    return std::move(answers_);
  }

 private:
  void flush() {
    const auto more = rasterize::emitted_radiance(probes_, gpu_, programs_);
    answers_.insert(answers_.end(), more.begin(), more.end());
    probes_.clear();
  }

  const gpu_scene::GpuScene& gpu_;
  gl::ProgramCache& programs_;
  std::vector<rasterize::EmitterProbe> probes_;
  std::vector<shared::EmitterRadiance> answers_;
};

// A triangle's `i`-th point, evenly spread (Roberts' R2 sequence).
glm::vec2 point_in_triangle(size_t i) {
  double u = 0.5 + double(i) * 0.7548776662466927, v = 0.5 + double(i) * 0.5698402909980532;
  u -= std::floor(u);
  v -= std::floor(v);
  const double root = std::sqrt(u);
  return {float(root * (1 - v)), float(root * v)};
}

// Front and back of each triangle of a part.
using Radiances = std::vector<std::pair<glm::vec3, glm::vec3>>;

// One answer a material where the radiance is the same everywhere, `points` a triangle otherwise.
std::vector<Radiances> measure(const std::vector<Part>& parts, size_t points, Prober& prober) {
  std::map<scene::Id, size_t> constant;  // number of its answer
  size_t asked = 0;
  for (const Part& part : parts)
    if (!part.varies && constant.try_emplace(part.material, asked).second) {
      const glm::vec2 p = point_in_triangle(0);
      prober.ask(part, part.range.first, p.x, p.y);
      ++asked;
    }
  for (const Part& part : parts)
    for (uint32_t t = 0; part.varies && t < part.range.count; ++t)
      for (size_t i = 0; i < points; ++i) {
        const glm::vec2 p = point_in_triangle(i);
        prober.ask(part, part.range.first + t, p.x, p.y);
      }
  const std::vector<shared::EmitterRadiance> answers = prober.answers();

  std::vector<Radiances> radiances;
  size_t next = asked;
  for (const Part& part : parts) {
    Radiances& list = radiances.emplace_back();
    if (!part.varies) {
      const shared::EmitterRadiance& r = answers[constant.at(part.material)];
      list.assign(part.range.count, {glm::vec3(r.front), glm::vec3(r.back)});
      continue;
    }
    glm::dvec4 mean(0);
    for (uint32_t t = 0; t < part.range.count; ++t) {
      glm::vec4 front(0), back(0);
      for (size_t i = 0; i < points; ++i, ++next) {
        front += answers[next].front / float(points);
        back += answers[next].back / float(points);
      }
      mean += glm::dvec4(front + back) / (2.0 * part.range.count);
      list.emplace_back(glm::vec3(front), glm::vec3(back));
    }
    const glm::vec3 least = kLeastShare * glm::vec3(mean);
    for (auto& [front, back] : list) {
      front = glm::max(front, least);
      back = glm::max(back, least);
    }
  }
  return radiances;
}

}  // namespace

std::vector<DescribedLight> glowing_triangles(const scene::Scene& scene,
                                              const gpu_scene::GpuScene& gpu, const glm::vec3& origin,
                                              gl::ProgramCache& programs,
                                              gpu_scene::ViewBlock& view_block) {
  const std::vector<Part> parts = glowing_parts(scene, gpu);
  if (parts.empty()) return {};
  size_t varying = 0;
  for (const Part& part : parts) varying += part.varies ? part.range.count : 0;
  const size_t points =
      std::clamp(kAllPoints / std::max<size_t>(varying, 1), kLeastPoints, kMostPoints);
  shared::View view{};
  view.world_origin = glm::vec4(origin, 0);
  view_block.set(view);
  Prober prober(gpu, programs);
  const std::vector<Radiances> radiances = measure(parts, points, prober);

  std::vector<DescribedLight> lights;
  for (size_t p = 0; p < parts.size(); ++p) {
    const Part& part = parts[p];
    const glm::dmat4 place(part.instance->object_to_world);
    GlowingTriangle triangle;
    triangle.mirrored = glm::determinant(glm::dmat3(place)) < 0;
    triangle.seen_by = part.instance->visibility;
    triangle.varies = part.varies;
    for (uint32_t t = 0; t < part.range.count; ++t) {
      const glm::uvec3& v = part.mesh->triangles[part.range.first + t];
      for (int k = 0; k < 3; ++k)
        triangle.corners[size_t(k)] =
            glm::dvec3(place * glm::dvec4(glm::dvec3(part.mesh->positions[v[k]]), 1)) - glm::dvec3(origin);
      triangle.primitive = part.first_primitive + t;
      std::tie(triangle.front, triangle.back) = radiances[p][t];
      if (auto light = describe(triangle)) lights.push_back(std::move(*light));
    }
  }
  return lights;
}

}  // namespace panoptes::path_tracer
