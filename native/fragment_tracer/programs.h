// The programs of the structure of fragments.
#pragma once

#include "fragment_tracer/settings.h"
#include "gl/program.h"

#include <vector>

namespace panoptes::fragment_tracer {

// Why triangles are drawn (raster.frag).
enum class Drawing { kBounds, kNearest, kStore };

// What the variant and its views define in every program, those that trace included.
void add_defines(const Settings& settings, int views, bool has_camera, gl::ProgramSource& source);
gl::ProgramSource raster_program(const Settings& settings, int views, bool has_camera, Drawing drawing);
gl::ProgramSource boxes_program(const Settings& settings, int views, bool has_camera);
gl::ProgramSource sift_program(const Settings& settings, int views, bool has_camera, bool write);
// A compute program by its file in shaders/fragment_tracer.
gl::ProgramSource build_program(const Settings& settings, int views, bool has_camera, const char* file);

// All programs of a build, for the validation of shaders.
std::vector<gl::ProgramSource> build_programs(const Settings& settings, int views, bool has_camera);

inline void bind_storage(unsigned binding, const gl::Buffer& buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.id());
}

}  // namespace panoptes::fragment_tracer
