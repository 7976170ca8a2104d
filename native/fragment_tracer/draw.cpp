// What of the build of fragments is drawn: which triangles each view sees, depth bounds, the nearest, and all.
#include "base/error.h"
#include "fragment_tracer/fragment_tracer.h"
#include "gl/dispatch.h"

#include <algorithm>
#include <numeric>

namespace panoptes::fragment_tracer {

namespace {

constexpr GLbitfield kBarriers = GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT;

uint32_t parts_of(uint32_t count, uint32_t size) { return (count + size - 1) / size; }

}  // namespace

void FragmentTracer::sift(uint32_t triangles, gl::ProgramCache& programs, gl::PassTimer& timer) {
  gl::PassScope scope(timer, "structure_sift");
  seen_.reserve(std::max<int64_t>(triangles, 4) * 4);
  sifted_counts_.reserve(shared::MOST_VIEWS * 4 + 4);
  sifted_counts_.clear();
  const auto pass = [&](bool write) {
    programs.get(sift_program(settings_, views_, has_camera_, write)).use();
    bind_storage(0, seen_);
    bind_storage(1, sifted_counts_);
    if (write) bind_storage(2, sifted_);
    glUniform1ui(0, triangles);
    gl::dispatch(parts_of(triangles, shared::SIFTED_AT_ONCE), kBarriers);
  };
  seen_counts_.fill(0);
  if (triangles > 0) pass(false);
  sifted_counts_.read(0, int64_t(sizeof seen_counts_), seen_counts_.data());
  // Each view's triangles behind those of the one before.
  std::array<uint32_t, shared::MOST_VIEWS> firsts{};
  std::exclusive_scan(seen_counts_.begin(), seen_counts_.end(), firsts.begin(), 0u);
  const uint64_t all = std::accumulate(seen_counts_.begin(), seen_counts_.end(), uint64_t(0));
  if (int64_t(all) > most_words())
    fail("the views see {} triangles in all, and this graphics driver lists {}: hide objects or simplify them", all,
         most_words());
  if (sifted_.reserve(std::max<int64_t>(int64_t(all), 4) * 4) || !sifted_texture_)
    sifted_texture_ = gl::Texture(GL_R32UI, sifted_);
  sifted_counts_.write(0, int64_t(sizeof firsts), firsts.data());
  if (all > 0) pass(true);
}

void FragmentTracer::begin_drawing() {
  if (!framebuffer_) framebuffer_ = gl::Framebuffer::make();
  if (!vertex_array_) vertex_array_ = gl::VertexArray::make();
  bind_storage(0, counter_buffer_);
  bind_storage(1, bounds_);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glBindVertexArray(vertex_array_.id());
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_SCISSOR_TEST);
}

void FragmentTracer::end_drawing() {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glMemoryBarrier(kBarriers);
}

void FragmentTracer::look_from(int view) {
  const glm::ivec4 size = block_.views[view].size;
  glNamedFramebufferParameteri(framebuffer_.id(), GL_FRAMEBUFFER_DEFAULT_WIDTH, size.x);
  glNamedFramebufferParameteri(framebuffer_.id(), GL_FRAMEBUFFER_DEFAULT_HEIGHT, size.y);
  glViewport(0, 0, size.x, size.y);
  glUniform1i(0, view);
}

void FragmentTracer::draw(Drawing drawing, gl::ProgramCache& programs) {
  programs.get(raster_program(settings_, views_, has_camera_, drawing)).use();
  begin_drawing();
  if (settings_.layers > 0) bind_storage(2, nearest_);
  if (drawing == Drawing::kStore) {
    bind_storage(3, entries_);
    bind_storage(4, counts_);
    bind_storage(5, data_);
  }
  sifted_texture_.bind(tracing::kStructureUnit);
  glUniform1ui(1, room_);
  glUniform1ui(2, uint32_t(settings_.layers));
  // So that the counter never wraps.
  glUniform1ui(4, uint32_t(std::min<int64_t>(4 * most_fragments(), int64_t(1) << 31)));
  uint32_t first = 0;
  for (int view = 0; view < views_; ++view) {
    look_from(view);
    glUniform1i(3, int(first));
    if (seen_counts_[size_t(view)] > 0) glDrawArrays(GL_TRIANGLES, 0, GLsizei(seen_counts_[size_t(view)] * 3));
    first += seen_counts_[size_t(view)];
  }
  end_drawing();
}

void FragmentTracer::draw_boxes(const tracing::TriangleList& triangles, gl::ProgramCache& programs) {
  const uint32_t boxes = parts_of(triangles.count(), shared::TRIANGLES_OF_BOX);
  if (boxes == 0) return;
  if (boxes_.reserve(int64_t(boxes) * 32)) boxes_texture_ = gl::Texture(GL_RGBA32F, boxes_);
  programs.get(build_program(settings_, views_, has_camera_, "boxes.comp")).use();
  bind_storage(0, boxes_);
  float width = 0;
  for (int view = 0; view < views_; ++view) width = std::max(width, block_.views[view].x.w);
  glUniform1ui(0, triangles.count());
  glUniform1f(1, width);
  gl::dispatch(boxes, kBarriers);
  programs.get(boxes_program(settings_, views_, has_camera_)).use();
  begin_drawing();
  boxes_texture_.bind(tracing::kTriangleUnit);
  for (int view = 0; view < views_; ++view) {
    look_from(view);
    glDrawArrays(GL_TRIANGLES, 0, GLsizei(boxes * 36));
  }
  end_drawing();
  triangles.texture().bind(tracing::kTriangleUnit);
}

void FragmentTracer::find_nearest(gl::ProgramCache& programs) {
  nearest_.reserve(int64_t(pixels_) * settings_.layers * 4);
  glClearNamedBufferData(nearest_.id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &shared::NO_FRAGMENT);
  draw(Drawing::kNearest, programs);
}

}  // namespace panoptes::fragment_tracer
