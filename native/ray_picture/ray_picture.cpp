#include "ray_picture/ray_picture.h"

#include "base/cancelled.h"
#include "gl/dispatch.h"

#include <fmt/format.h>

#include <algorithm>

namespace panoptes::ray_picture {

namespace {

// Rays at a time: 80 bytes each.
constexpr uint32_t kBatch = 1 << 20;

}  // namespace

gl::ProgramSource camera_rays_program() {
  gl::ProgramSource source;
  source.name = "camera rays";
  source.stages = {{GL_COMPUTE_SHADER, "ray_picture/camera_rays.comp"}};
  return source;
}

gl::ProgramSource false_colour_program(Kind kind, const film::Film& film) {
  gl::ProgramSource source;
  source.name = "false colour";
  source.stages = {{GL_COMPUTE_SHADER, "ray_picture/false_colour.comp"}};
  source.defines = {fmt::format("KIND {}", int(kind))};
  film.add_defines(source);
  return source;
}

void RayPicture::render(const gpu_scene::Camera& camera, Kind kind, const tracing::Tracer& tracer,
                        const tracing::TriangleList& triangles, film::Film& film,
                        gl::ProgramCache& programs, gl::PassTimer& timer,
                        const std::atomic<bool>& cancelled) {
  const uint32_t pixels = uint32_t(camera.width) * uint32_t(camera.height);
  const uint32_t most = std::min(pixels, kBatch);
  rays_.reserve(most * int64_t(sizeof(shared::TracedRay)));
  hits_.reserve(most * int64_t(sizeof(shared::TracedHit)));
  work_.reserve(most * int64_t(sizeof(shared::TracedWork)));
  view_block_.set(gpu_scene::camera_view(camera, {0, 0}));
  const glm::vec3 origin = triangles.origin();
  const glm::vec2 depths(gpu_scene::clip_depths(camera));
  for (uint32_t first = 0; first < pixels; first += kBatch) {
    const uint32_t count = std::min(pixels - first, kBatch);
    gl::PassScope scope(timer, "rays");
    programs.get(camera_rays_program()).use();
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, rays_.id());
    glUniform2ui(0, first, count);
    glUniform3f(1, origin.x, origin.y, origin.z);
    glUniform2f(2, depths.x, depths.y);
    gl::dispatch(count, GL_TEXTURE_FETCH_BARRIER_BIT);

    waves_.trace(tracer, triangles, {&rays_, &hits_, &work_, count, nullptr}, {.count_work = true},
                 programs);

    programs.get(false_colour_program(kind, film)).use();
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, work_.id());
    glUniform2ui(0, first, count);
    film.bind();
    gl::dispatch(count, GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
    stop_if(cancelled);
  }
}

void RayPicture::release() { *this = RayPicture(); }

}  // namespace panoptes::ray_picture
