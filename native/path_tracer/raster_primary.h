// The camera's rays by rasterisation in place of tracing (thesis, section 7.2.4: primary hits from the
// G-buffer). All pixels of a sample are seen through the same place of the pixel, which converges to
// the same picture, and nothing is out of focus.
#pragma once

#include "gl/pass_timer.h"
#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/view_block.h"
#include "rasterize/g_buffer.h"
#include "tracing/triangle_list.h"

namespace panoptes::path_tracer {

gl::ProgramSource visible_hits_program();

class RasterPrimary {
 public:
  // Finds what each pixel of `view` shows. Random alpha thresholds follow from its sample and seed.
  void rasterize(const shared::View& view, const gpu_scene::GpuScene& scene,
                 gpu_scene::ViewBlock& view_block, gl::ProgramCache& programs,
                 gl::PassTimer& timer);
  // Writes hits of the first `count` rays, whose tags are pixels. The view block has to be that of
  // the list's origin, the block of the paths' frame bound.
  void write_hits(uint32_t count, const gl::Buffer& rays, const gl::Buffer& hits,
                  const gpu_scene::GpuScene& scene, const tracing::TriangleList& triangles,
                  gl::ProgramCache& programs);
  void release();

 private:
  rasterize::GBuffer g_buffer_;
  gl::Buffer first_primitives_;
};

}  // namespace panoptes::path_tracer
