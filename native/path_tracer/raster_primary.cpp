#include "path_tracer/raster_primary.h"

#include "gl/dispatch.h"

namespace panoptes::path_tracer {

gl::ProgramSource visible_hits_program() {
  gl::ProgramSource source;
  source.name = "hits by rasterisation";
  source.stages = {{GL_COMPUTE_SHADER, "path_tracer/visible_hits.comp"}};
  return source;
}

void RasterPrimary::rasterize(const shared::View& view, const gpu_scene::GpuScene& scene,
                              gpu_scene::ViewBlock& view_block, gl::ProgramCache& programs,
                              gl::PassTimer& timer) {
  g_buffer_.resize_visibility(view.size.x, view.size.y);
  view_block.set(view);
  g_buffer_.rasterize(scene, programs, timer);
}

void RasterPrimary::write_hits(uint32_t count, const gl::Buffer& rays, const gl::Buffer& hits,
                               const gpu_scene::GpuScene& scene,
                               const tracing::TriangleList& triangles,
                               gl::ProgramCache& programs) {
  const std::vector<uint32_t>& firsts = triangles.first_primitives();
  first_primitives_.reserve(int64_t(firsts.size()) * 4);
  first_primitives_.write(0, int64_t(firsts.size()) * 4, firsts.data());
  programs.get(visible_hits_program()).use();
  scene.bind_geometry();
  g_buffer_.bind_visibility();
  const gl::Buffer* buffers[] = {&scene.records(), &rays, &hits, &first_primitives_};
  for (GLuint i = 0; i < 4; ++i)
    if (buffers[i]->id()) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, buffers[i]->id());
  gl::dispatch(count, GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
}

void RasterPrimary::release() { *this = RasterPrimary(); }

}  // namespace panoptes::path_tracer
