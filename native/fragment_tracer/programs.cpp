#include "fragment_tracer/programs.h"

#include <fmt/format.h>

namespace panoptes::fragment_tracer {

void add_defines(const Settings& s, int views, bool has_camera, gl::ProgramSource& source) {
  const auto add = [&](const char* name, int value) { source.defines.push_back(fmt::format("{} {}", name, value)); };
  add("VIEWS", views);
  add("CAMERA_VIEW", has_camera);
  add("LINKS", links(s.storage));
  add("BUCKETS", has_buckets(s.storage) ? s.buckets : 0);
  add("DECOUPLED", s.decoupled);
  add("SKIPPING", s.skipping);
  add("BINARY", s.binary_search);
  add("TRAVERSAL", int(s.walk));
  add("BY_PLANE", s.by_plane);
}

gl::ProgramSource build_program(const Settings& s, int views, bool has_camera, const char* file) {
  gl::ProgramSource source;
  source.name = fmt::format("fragments: {}", file);
  source.stages = {{GL_COMPUTE_SHADER, fmt::format("fragment_tracer/{}", file)}};
  add_defines(s, views, has_camera, source);
  return source;
}

gl::ProgramSource sift_program(const Settings& s, int views, bool has_camera, bool write) {
  gl::ProgramSource source = build_program(s, views, has_camera, "sift.comp");
  source.defines.push_back(fmt::format("WRITE {}", int(write)));
  return source;
}

gl::ProgramSource raster_program(const Settings& s, int views, bool has_camera, Drawing drawing) {
  gl::ProgramSource source;
  source.name = "fragments: raster";
  source.stages = {{GL_VERTEX_SHADER, "fragment_tracer/raster.vert"},
                   {GL_FRAGMENT_SHADER, "fragment_tracer/raster.frag"}};
  add_defines(s, views, has_camera, source);
  source.defines.push_back(fmt::format("PASS {}", int(drawing)));
  source.defines.push_back(fmt::format("KEEP {}", int(s.layers > 0)));
  return source;
}

gl::ProgramSource boxes_program(const Settings& s, int views, bool has_camera) {
  gl::ProgramSource source;
  source.name = "fragments: bounds by boxes";
  source.stages = {{GL_VERTEX_SHADER, "fragment_tracer/boxes.vert"},
                   {GL_FRAGMENT_SHADER, "fragment_tracer/boxes.frag"}};
  add_defines(s, views, has_camera, source);
  return source;
}

std::vector<gl::ProgramSource> build_programs(const Settings& s, int views, bool has_camera) {
  std::vector<gl::ProgramSource> sources{sift_program(s, views, has_camera, false), sift_program(s, views, has_camera, true),
                                         raster_program(s, views, has_camera, Drawing::kStore)};
  if (has_buckets(s.storage)) {
    if (s.bounds == Bounds::kBoxes) {
      sources.push_back(build_program(s, views, has_camera, "boxes.comp"));
      sources.push_back(boxes_program(s, views, has_camera));
    } else {
      sources.push_back(raster_program(s, views, has_camera, Drawing::kBounds));
    }
  }
  if (s.layers > 0) sources.push_back(raster_program(s, views, has_camera, Drawing::kNearest));
  for (const char* file : {"allocate.comp", "scatter.comp", "sort_short.comp", "merge.comp", "link.comp"})
    sources.push_back(build_program(s, views, has_camera, file));
  if (s.walk == Walk::kHierarchy) sources.push_back(build_program(s, views, has_camera, "pyramid.comp"));
  return sources;
}

}  // namespace panoptes::fragment_tracer
