#include "tracing/triangle_list.h"

#include "base/error.h"

#include <algorithm>
#include <cmath>

namespace panoptes::tracing {

void TriangleList::reserve(uint32_t count) {
  if (int64_t(count) * 3 > device_.max_texture_buffer_texels)
    fail("the scene has {} triangles, and this graphics driver lets rays meet {} at most: hide or "
         "simplify objects",
         count, device_.max_texture_buffer_texels / 3);
  const int64_t bytes = int64_t(count) * int64_t(sizeof(shared::TracedTriangle));
  if (buffer_ && buffer_.bytes() >= bytes && buffer_.bytes() <= 2 * bytes + 4096) return;
  texture_ = gl::Texture();
  buffer_ = gl::Buffer();  // before the new one takes its memory
  buffer_ = gl::Buffer(bytes);
  texture_ = gl::Texture(GL_RGBA32F, buffer_);
}

void TriangleList::assign(std::span<const shared::TracedTriangle> triangles,
                          const glm::vec3& origin) {
  reserve(uint32_t(triangles.size()));
  count_ = uint32_t(triangles.size());
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
