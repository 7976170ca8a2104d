#include "bvh_tracer/bvh_tracer.h"

#include "base/error.h"
#include "bvh_tracer/bvh.h"

namespace panoptes::bvh_tracer {

namespace {

using shared::BvhNode;
using shared::TracedTriangle;

void check_room(size_t count, size_t bytes_each, const gl::DeviceInfo& device, const char* what) {
  const size_t most = size_t(device.max_texture_buffer_texels) * 16 / bytes_each;
  if (count > most)
    fail("rays need {} {}, and this graphics driver has room for {}: hide or simplify objects",
         count, what, most);
}

}  // namespace

void BvhTracer::build(const tracing::TriangleList& list, gl::ProgramCache&, gl::PassTimer& timer) {
  const gl::PassScope scope(timer, "structure_hierarchy");
  nodes_ = gl::Texture(), triangles_ = gl::Texture();
  node_buffer_ = gl::Buffer(), triangle_buffer_ = gl::Buffer();  // before new ones take memory

  const std::vector<TracedTriangle> triangles = list.read();
  const Bvh bvh = build_bvh(triangles);
  check_room(bvh.nodes.size(), sizeof(BvhNode), device_, "nodes of a hierarchy");
  check_room(bvh.order.size(), sizeof(TracedTriangle), device_, "triangles");
  std::vector<TracedTriangle> ordered;
  ordered.reserve(bvh.order.size());
  for (uint32_t primitive : bvh.order) {
    ordered.push_back(triangles[primitive]);
    ordered.back().instance = primitive;
  }
  node_buffer_ = gl::Buffer(std::span<const BvhNode>(pack(bvh)));
  triangle_buffer_ = gl::Buffer(std::span<const TracedTriangle>(ordered));
  nodes_ = gl::Texture(GL_RGBA32UI, node_buffer_);
  triangles_ = gl::Texture(GL_RGBA32F, triangle_buffer_);
}

void BvhTracer::add_to(gl::ProgramSource& source) const {
  source.snippets["generated/tracer.glsl"] = "#include \"bvh_tracer/traverse.glsl\"\n";
}

void BvhTracer::bind() const {
  nodes_.bind(tracing::kStructureUnit);
  triangles_.bind(tracing::kStructureUnit + 1);
}

uint32_t BvhTracer::traversal_words() const { return 10 + shared::BVH_DEPTH; }

int64_t BvhTracer::bytes() const { return node_buffer_.bytes() + triangle_buffer_.bytes(); }

}  // namespace panoptes::bvh_tracer
