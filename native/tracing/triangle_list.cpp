#include "tracing/triangle_list.h"

#include "base/error.h"
#include "gl/dispatch.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace panoptes::tracing {

namespace {

// The middle of what lies at finite places; objects so large that their own size is none of a scene's
// do not move it.
glm::vec3 middle_of(const scene::Scene& scene) {
  scene::Bounds all;
  for (const scene::Instance& instance : scene.instances()) {
    const scene::Mesh* mesh = scene.mesh_of(instance);
    if (!mesh || mesh->bounds.empty()) continue;
    const scene::Bounds placed = scene::placed_bounds(mesh->bounds, instance.object_to_world);
    // False for what is not a number, too.
    const glm::vec3 size = placed.high - placed.low;
    if (!(size.x <= shared::FARTHEST && size.y <= shared::FARTHEST && size.z <= shared::FARTHEST))
      continue;
    all.add(placed.low);
    all.add(placed.high);
  }
  return all.empty() ? glm::vec3(0) : 0.5f * all.low + 0.5f * all.high;
}

struct Spans {
  std::vector<shared::TriangleSpan> list;
  uint64_t triangles = 0;
};

Spans spans_of(const scene::Scene& scene, const gpu_scene::GpuScene& gpu) {
  Spans spans;
  for (size_t i = 0; i < scene.instances().size(); ++i) {
    const scene::Instance& instance = scene.instances()[i];
    const scene::Mesh* mesh = scene.mesh_of(instance);
    if (!mesh) continue;
    for (const scene::MaterialRange& range : mesh->ranges) {
      if (range.count == 0) continue;
      const uint32_t material = gpu.material_index(scene.material_of(instance, range.slot));
      const bool alpha = gpu.materials()[material].facts.alpha;
      spans.list.push_back({uint32_t(spans.triangles), gpu.place_of(i), range.first,
                            instance.visibility | (alpha ? shared::TRIANGLE_HAS_ALPHA : 0) |
                                material << shared::TRIANGLE_MATERIAL_SHIFT});
      spans.triangles += range.count;
    }
  }
  return spans;
}

float float_of(uint32_t order) {
  return std::bit_cast<float>(order & 0x80000000u ? order & 0x7fffffffu : ~order);
}

}  // namespace

gl::ProgramSource flatten_program() {
  gl::ProgramSource source;
  source.name = "triangles";
  source.stages = {{GL_COMPUTE_SHADER, "tracing/flatten.comp"}};
  return source;
}

bool TriangleList::update(const scene::Scene& scene, const gpu_scene::GpuScene& gpu,
                          gl::ProgramCache& programs, gl::PassTimer& timer) {
  if (revision_ == gpu.geometry_revision()) return false;
  gl::PassScope scope(timer, "triangles");
  revision_ = -1;  // until all is well
  const Spans spans = spans_of(scene, gpu);
  reserve(spans.triangles);
  count_ = uint32_t(spans.triangles);
  origin_ = middle_of(scene);
  bounds_ = {};
  lost_ = 0;
  first_primitives_.clear();
  for (const shared::TriangleSpan& span : spans.list) {
    if (span.instance >= first_primitives_.size()) first_primitives_.resize(span.instance + 1);
    first_primitives_[span.instance] = span.first_primitive - span.first_triangle;
  }
  if (count_ > 0) flatten(spans.list, gpu, programs);
  revision_ = gpu.geometry_revision();
  return true;
}

void TriangleList::flatten(const std::vector<shared::TriangleSpan>& spans,
                           const gpu_scene::GpuScene& gpu, gl::ProgramCache& programs) {
  const int64_t bytes = int64_t(spans.size() * sizeof(shared::TriangleSpan));
  spans_.reserve(bytes);
  spans_.write(0, bytes, spans.data());
  const gl::Texture span_texture(GL_RGBA32UI, spans_);
  shared::FlattenSummary summary{glm::uvec4(~0u), glm::uvec4(0), 0, 0, 0, 0};
  summary_.reserve(sizeof summary);
  summary_.write(0, sizeof summary, &summary);

  programs.get(flatten_program()).use();
  gpu.bind_geometry();
  span_texture.bind(gpu_scene::kParamUnit);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer_.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, summary_.id());
  glUniform2ui(0, count_, uint32_t(spans.size()));
  glUniform3f(1, origin_.x, origin_.y, origin_.z);
  gl::dispatch(count_, GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                           GL_BUFFER_UPDATE_BARRIER_BIT);

  summary_.read(0, sizeof summary, &summary);
  lost_ = summary.lost;
  if (lost_ == count_) return;
  for (int axis = 0; axis < 3; ++axis) {
    bounds_.low[axis] = float_of(summary.low[axis]);
    bounds_.high[axis] = float_of(summary.high[axis]);
  }
}

void TriangleList::reserve(uint64_t count) {
  if (count > uint64_t(device_.max_texture_buffer_texels) / 3 || count >= shared::NO_PRIMITIVE)
    fail("the scene has {} triangles, and this graphics driver lets rays meet {} at most: hide or "
         "simplify objects",
         count, std::min<uint64_t>(uint64_t(device_.max_texture_buffer_texels) / 3,
                                   shared::NO_PRIMITIVE - 1));
  const int64_t bytes = int64_t(count * sizeof(shared::TracedTriangle));
  if (buffer_ && buffer_.bytes() >= bytes && buffer_.bytes() <= 2 * bytes + 4096) return;
  texture_ = gl::Texture();
  buffer_ = gl::Buffer();  // before the new one takes its memory
  buffer_ = gl::Buffer(bytes);
  texture_ = gl::Texture(GL_RGBA32F, buffer_);
}

void TriangleList::assign(std::span<const shared::TracedTriangle> triangles,
                          const glm::vec3& origin) {
  reserve(triangles.size());
  count_ = uint32_t(triangles.size());
  lost_ = 0;
  origin_ = origin;
  revision_ = -1;
  bounds_ = {};
  for (const shared::TracedTriangle& t : triangles) {
    if ((t.flags & shared::TRIANGLE_SEEN_BY) == 0) continue;
    bounds_.add({t.x0, t.y0, t.z0});
    bounds_.add({t.x1, t.y1, t.z1});
    bounds_.add({t.x2, t.y2, t.z2});
  }
  if (count_) buffer_.write(0, int64_t(triangles.size_bytes()), triangles.data());
}

std::vector<shared::TracedTriangle> TriangleList::read() const {
  std::vector<shared::TracedTriangle> triangles(count_);
  if (count_)
    buffer_.read(0, int64_t(count_) * int64_t(sizeof(shared::TracedTriangle)), triangles.data());
  return triangles;
}

}  // namespace panoptes::tracing
