// Rays through a bounding volume hierarchy that the host builds: the yardstick of the structures
// that are made by rasterisation, and their reference.
#pragma once

#include "gl/context.h"
#include "tracing/tracer.h"

namespace panoptes::bvh_tracer {

class BvhTracer : public tracing::Tracer {
 public:
  explicit BvhTracer(const gl::DeviceInfo& device) : device_(device) {}

  // Reads the triangles back from the device, and keeps them once more in the order of the leaves:
  // neighbours lie together, and no table stands between leaves and triangles.
  void build(const tracing::TriangleList& triangles, gl::ProgramCache& programs,
             gl::PassTimer& timer) override;
  void add_to(gl::ProgramSource& source) const override;
  void bind() const override;
  uint32_t traversal_words() const override;
  int64_t bytes() const override;

 private:
  gl::DeviceInfo device_;
  gl::Buffer node_buffer_, triangle_buffer_;
  gl::Texture nodes_, triangles_;
};

}  // namespace panoptes::bvh_tracer
