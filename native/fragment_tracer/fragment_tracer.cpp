#include "fragment_tracer/fragment_tracer.h"

#include "base/error.h"
#include "fragment_tracer/programs.h"
#include "gl/dispatch.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace panoptes::fragment_tracer {

namespace {

// Lists up to this length are sorted by insertion.
constexpr uint32_t kShort = 32;

// Axes of the faces of a cube: right, up, forward.
constexpr std::array<std::array<glm::vec3, 3>, 6> kFaces{{{{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}},
                                                          {{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}},
                                                          {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}},
                                                          {{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}},
                                                          {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                                                          {{{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}}}}};

}  // namespace

FragmentTracer::FragmentTracer(const Settings& settings, const glm::vec3& centre,
                               const std::optional<CameraView>& camera, uint32_t room, int64_t most)
    : settings_(settings), room_(room), most_(most) {
  settings.check();
  place(centre, camera);
}

void FragmentTracer::place(const glm::vec3& centre, const std::optional<CameraView>& camera) {
  has_camera_ = camera && settings_.views != Views::kCube;
  if (settings_.views == Views::kCamera && !camera)
    fail("fragments of the camera's view alone were asked for, and this camera has no perspective: choose the cube");
  uint64_t pixels = 0, cells = 0;
  const auto add = [&](const CameraView& view) {
    shared::FragmentView& v = block_.views[views_];
    const glm::vec2 size(view.size);
    const glm::vec3 x = view.right / view.half_extent.x, y = view.up / view.half_extent.y;
    v.x = glm::vec4((x + view.forward) * (0.5f * size.x),
                    2.0f * std::max(view.half_extent.x / size.x, view.half_extent.y / size.y));
    v.y = glm::vec4((y + view.forward) * (0.5f * size.y), 0);
    v.z = glm::vec4(view.forward, 0);
    const int levels = std::bit_width(unsigned(std::max(view.size.x, view.size.y) - 1));
    v.size = {view.size, int(pixels), levels};
    pixels += uint64_t(view.size.x) * view.size.y;
    for (int level = 0; level <= levels; ++level) {
      const int at = views_ * int(shared::MOST_LEVELS) + level;
      block_.level_first[at / 4][at % 4] = int(cells);
      const glm::ivec2 narrow = (view.size + (1 << level) - 1) >> level;
      cells += uint64_t(narrow.x) * narrow.y;
    }
    ++views_;
  };
  if (has_camera_) add(*camera);
  if (settings_.views != Views::kCamera)
    for (const auto& [right, up, forward] : kFaces) add({right, up, forward, glm::vec2(1), glm::ivec2(settings_.side)});
  pixels_ = uint32_t(pixels);
  cells_ = uint32_t(cells);
  block_.centre = glm::vec4(centre, 0);
  block_.walk = {settings_.steps, 0, 0, 0};
  block_.limits = {settings_.thickness, 0, 0, 0};
}

void FragmentTracer::frame(const scene::Bounds& bounds) {
  const bool empty = bounds.empty();
  const glm::vec3 low = empty ? glm::vec3(0) : bounds.low, high = empty ? glm::vec3(0) : bounds.high;
  const glm::vec3 far = glm::max(glm::abs(low), glm::abs(high));
  const glm::vec3 margin = (high - low) * 1e-5f + 4e-6f * std::max(far.x, std::max(far.y, far.z));
  block_.low = glm::vec4(low - margin, 0);
  block_.high = glm::vec4(high + margin, 0);
  if (!view_block_) view_block_ = gl::Buffer(sizeof block_);
  view_block_.write(0, sizeof block_, &block_);
}

void FragmentTracer::check_pixels() const {
  const double words_of_each = std::max(pixel_bytes(settings_) / 4, settings_.layers);
  const double words = double(pixels_) * words_of_each, most = double(most_words());
  if (words > most)
    fail("the views have {} pixels, and this graphics driver holds {} in this storage: choose {} pixels a side of the "
         "cube or fewer, a narrower view of the camera, or fewer buckets or layers",
         pixels_, int64_t(most / words_of_each),
         std::max(1, int(settings_.side * std::sqrt(most / words))));
}

void FragmentTracer::build(const tracing::TriangleList& triangles, gl::ProgramCache& programs, gl::PassTimer& timer) {
  check_pixels();
  frame(triangles.bounds());
  triangles.texture().bind(tracing::kTriangleUnit);
  glBindBufferBase(GL_UNIFORM_BUFFER, tracing::kStructureBlock, view_block_.id());
  counter_buffer_.reserve(sizeof(shared::FragmentCounters));
  bounds_.reserve(int64_t(pixels_) * 8);
  counts_.reserve(int64_t(lists()) * 4);
  firsts_.reserve(int64_t(lists()) * 4);
  if (room_ == 0) room_ = uint32_t(std::min<int64_t>(int64_t(pixels_) + 4096, most_fragments()));
  const uint32_t bounds[2] = {0xffffffffu, 0};
  glClearNamedBufferData(bounds_.id(), GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT, bounds);
  sift(triangles.count(), programs, timer);
  if (has_buckets(settings_.storage)) {
    gl::PassScope scope(timer, "structure_bounds");
    if (settings_.bounds == Bounds::kBoxes) draw_boxes(triangles, programs);
    else draw(Drawing::kBounds, programs);
  }
  if (settings_.layers > 0) {
    gl::PassScope scope(timer, "structure_nearest");
    find_nearest(programs);
  }
  store(programs, timer);
  {
    gl::PassScope scope(timer, "structure_sort");
    sort(programs);
  }
  gl::PassScope scope(timer, "structure_links");
  link(programs);
  if (settings_.walk == Walk::kHierarchy) build_pyramid(programs);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

// What a buffer texture may address.
int64_t FragmentTracer::most_words() {
  GLint texels = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels);
  return texels;
}

int64_t FragmentTracer::most_fragments() const {
  const int node = fragment_bytes(settings_) + (settings_.decoupled ? 0 : kDataBytes);
  const int64_t addressed = most_words() * 4 / std::max(node, kDataBytes);
  return most_ > 0 ? std::min(most_, addressed) : addressed;
}

void FragmentTracer::reserve_fragments(uint32_t count) {
  const int64_t most = most_fragments();
  if (int64_t(count) > most)
    fail("the scene has at least {} fragments in these views, and this graphics driver holds {}: choose {} pixels a side of the "
         "cube or fewer, or hide objects",
         count, most, std::max(1, int(settings_.side * std::sqrt(double(most) / count))));
  room_ = uint32_t(std::min<int64_t>(most, int64_t(count) + count / 4));
  const int64_t node = fragment_bytes(settings_) + (settings_.decoupled ? 0 : kDataBytes);
  entries_.reserve(int64_t(room_) * int64_t(sizeof(shared::FragmentEntry)));
  for (gl::Buffer& run : sorted_) run.reserve(int64_t(room_) * 8);
  if (data_.reserve(int64_t(room_) * kDataBytes)) data_texture_ = gl::Texture(GL_R32UI, data_);
  if (nodes_.reserve(int64_t(room_) * node)) node_texture_ = gl::Texture(GL_R32UI, nodes_);
  if (pixel_words_.reserve(int64_t(pixels_) * pixel_bytes(settings_)))
    pixel_texture_ = gl::Texture(GL_R32UI, pixel_words_);
}

void FragmentTracer::store(gl::ProgramCache& programs, gl::PassTimer& timer) {
  gl::PassScope scope(timer, "structure_raster");
  reserve_fragments(room_);
  while (true) {
    counter_buffer_.clear();
    counts_.clear();
    draw(Drawing::kStore, programs);
    counter_buffer_.read(0, sizeof counters_, &counters_);
    if (counters_.fragments <= room_) return;
    reserve_fragments(counters_.fragments);
  }
}

void FragmentTracer::sort(gl::ProgramCache& programs) {
  constexpr GLbitfield kBarriers = GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT;
  const uint32_t fragments = counters_.fragments;
  const auto run = [&](const char* file, uint32_t count, std::optional<uint32_t> number, int from) {
    programs.get(build_program(settings_, views_, has_camera_, file)).use();
    bind_storage(0, counter_buffer_);
    bind_storage(3, entries_);
    bind_storage(4, counts_);
    bind_storage(6, firsts_);
    bind_storage(7, sorted_[from]);
    bind_storage(8, sorted_[from ^ 1]);
    glUniform1ui(0, count);
    if (number) glUniform1ui(1, *number);
    gl::dispatch(count, kBarriers);
  };
  run("allocate.comp", lists(), {}, 0);
  counter_buffer_.read(0, sizeof counters_, &counters_);
  run("scatter.comp", fragments, {}, 0);
  if (counters_.longest <= kShort) {
    run("sort_short.comp", lists(), kShort, 0);
    return;
  }
  // All lists are merged, since those that are short cost nothing more there.
  int from = 0;
  for (uint32_t width = 1; width < counters_.longest; width *= 2, from ^= 1) run("merge.comp", fragments, width, from);
  if (from == 1) std::swap(sorted_[0], sorted_[1]);
}

void FragmentTracer::link(gl::ProgramCache& programs) {
  const uint32_t nothing = has_buckets(settings_.storage) || links(settings_.storage) ? shared::NO_FRAGMENT : 0;
  glClearNamedBufferData(pixel_words_.id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &nothing);
  programs.get(build_program(settings_, views_, has_camera_, "link.comp")).use();
  bind_storage(0, counter_buffer_);
  bind_storage(1, bounds_);
  bind_storage(3, entries_);
  bind_storage(4, counts_);
  bind_storage(5, data_);
  bind_storage(6, firsts_);
  bind_storage(7, sorted_[0]);
  bind_storage(8, nodes_);
  bind_storage(9, pixel_words_);
  glUniform1ui(0, counters_.fragments);
  glUniform1ui(1, settings_.layers > 0 ? uint32_t(settings_.layers) : ~0u);
  gl::dispatch(counters_.fragments, GL_SHADER_STORAGE_BARRIER_BIT);
}

void FragmentTracer::build_pyramid(gl::ProgramCache& programs) {
  if (levels_.reserve(int64_t(cells_) * 8)) level_texture_ = gl::Texture(GL_RG32UI, levels_);
  programs.get(build_program(settings_, views_, has_camera_, "pyramid.comp")).use();
  bind_storage(1, bounds_);
  bind_storage(3, levels_);
  for (int view = 0; view < views_; ++view) {
    const glm::ivec4 size = block_.views[view].size;
    for (int level = 0; level <= size.w; ++level) {
      const glm::ivec2 narrow = (glm::ivec2(size) + (1 << level) - 1) >> level;
      glUniform1i(0, view);
      glUniform1i(1, level);
      gl::dispatch(uint32_t(narrow.x * narrow.y), GL_SHADER_STORAGE_BARRIER_BIT);
    }
  }
}

void FragmentTracer::add_to(gl::ProgramSource& source) const {
  add_defines(settings_, views_, has_camera_, source);
  source.snippets["generated/tracer.glsl"] = "#include \"fragment_tracer/traverse.glsl\"\n";
}

void FragmentTracer::bind() const {
  pixel_texture_.bind(tracing::kStructureUnit);
  node_texture_.bind(tracing::kStructureUnit + 1);
  data_texture_.bind(tracing::kStructureUnit + 2);
  if (settings_.walk == Walk::kHierarchy) level_texture_.bind(tracing::kStructureUnit + 3);
  glBindBufferBase(GL_UNIFORM_BUFFER, tracing::kStructureBlock, view_block_.id());
}

FragmentTracer::Bytes FragmentTracer::bytes_of_parts() const {
  const int64_t count = counters_.fragments;
  return {int64_t(pixels_) * pixel_bytes(settings_), count * fragment_bytes(settings_), count * kDataBytes,
          settings_.walk == Walk::kHierarchy ? int64_t(cells_) * 8 : 0};
}

int64_t FragmentTracer::bytes() const {
  const Bytes parts = bytes_of_parts();
  return parts.pixels + parts.fragments + parts.data + parts.pyramid;
}

}  // namespace panoptes::fragment_tracer
