// Rays through the fragments of several views (thesis, chapter 6): the camera's and the six faces of a cube about its
// eye, all layers of each. Rays are traced against pixels, so the answer is an approximation, which the number of pixels
// decides; by Settings::by_plane one of the triangles that fragments come from.
//
// Passes: sift (the triangles that each view sees), bounds of depth (with buckets), nearest (which depths a pixel keeps,
// where their number is bounded: no others are stored, so memory is bounded while it is built, too), store (fragments in their order of arrival, with the number of their list),
// sort (runs by list and depth; short lists by insertion, long ones by merging, so that none is too long), link (the
// variant's own arrays or lists), pyramid (with Walk::kHierarchy).
//
// Departures from the thesis: views are drawn one after the other, where a geometry shader sends each triangle to all;
// lists are linked after they are sorted, since a list that is too long for one invocation could not be sorted in
// place; depths are along the view's axis, so that a shifted frustum is not needed for what lies before a near plane.
#pragma once

#include "fragment_tracer/programs.h"
#include "fragment_tracer/settings.h"
#include "fragment_tracer/views_shared.h"
#include "tracing/tracer.h"

#include <glm/glm.hpp>

#include <array>
#include <optional>

namespace panoptes::fragment_tracer {

// A camera's frustum about its axis; positions relative to the list's origin.
struct CameraView {
  glm::vec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};  // unit
  glm::vec2 half_extent{1};  // tangents of half the angles, along right and up
  glm::ivec2 size{256};      // pixels
};

class FragmentTracer : public tracing::Tracer {
 public:
  // `centre`: the eye, relative to the list's origin. Without a camera Views::kCubeAndCamera is the cube alone. `room`:
  // for how many fragments there is at first; 0: what the number of pixels suggests. `most`: how many there may be at
  // all; 0: what the driver can address. Throws Error where settings are out of range or only the camera is wanted and
  // there is none.
  FragmentTracer(const Settings& settings, const glm::vec3& centre, const std::optional<CameraView>& camera,
                 uint32_t room = 0, int64_t most = 0);

  void build(const tracing::TriangleList& triangles, gl::ProgramCache& programs, gl::PassTimer& timer) override;
  void add_to(gl::ProgramSource& source) const override;
  void bind() const override;
  uint32_t traversal_words() const override { return 13; }
  int64_t bytes() const override;

  // Of the last build.
  uint32_t fragments() const { return counters_.fragments; }
  uint32_t longest_list() const { return counters_.longest; }
  uint32_t used_lists() const { return counters_.used; }
  // Bytes as Table 6.2 divides them.
  struct Bytes {
    int64_t pixels = 0;     // pixel_bytes() of each
    int64_t fragments = 0;  // fragment_bytes() of each
    int64_t data = 0;
    int64_t pyramid = 0;    // which the table has not
  };
  Bytes bytes_of_parts() const;

 private:
  void place(const glm::vec3& centre, const std::optional<CameraView>& camera);
  void frame(const scene::Bounds& bounds);
  uint32_t lists() const { return pixels_ * uint32_t(has_buckets(settings_.storage) ? settings_.buckets : 1); }
  // Lists the triangles of each view.
  void sift(uint32_t triangles, gl::ProgramCache& programs, gl::PassTimer& timer);
  void begin_drawing();
  void look_from(int view);
  void end_drawing();
  void draw(Drawing drawing, gl::ProgramCache& programs);
  void draw_boxes(const tracing::TriangleList& triangles, gl::ProgramCache& programs);
  void find_nearest(gl::ProgramCache& programs);
  void store(gl::ProgramCache& programs, gl::PassTimer& timer);
  void sort(gl::ProgramCache& programs);
  void link(gl::ProgramCache& programs);
  void build_pyramid(gl::ProgramCache& programs);
  // Throws Error where the driver cannot address the pixels' lists, with a resolution that fits.
  void check_pixels() const;
  static int64_t most_words();     // that the driver can address
  int64_t most_fragments() const;
  void reserve_fragments(uint32_t count);

  Settings settings_;
  int views_ = 0;
  bool has_camera_ = false;
  uint32_t pixels_ = 0, cells_ = 0;  // of all views; of all levels
  uint32_t room_ = 0;
  int64_t most_ = 0;  // fragments, or 0
  shared::FragmentViews block_{};
  shared::FragmentCounters counters_{};
  gl::Framebuffer framebuffer_;  // without attachments
  gl::VertexArray vertex_array_;  // without attributes
  gl::Buffer view_block_, counter_buffer_, bounds_, entries_, counts_, firsts_, data_, sorted_[2], nodes_, pixel_words_,
      levels_, seen_, sifted_, sifted_counts_, boxes_, nearest_;
  gl::Texture pixel_texture_, node_texture_, data_texture_, level_texture_, sifted_texture_, boxes_texture_;
  std::array<uint32_t, shared::MOST_VIEWS> seen_counts_{};  // triangles of each view
};

}  // namespace panoptes::fragment_tracer
