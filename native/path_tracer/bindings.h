// How the programs of paths see their buffers.
#pragma once

#include "gl/handles.h"

namespace panoptes::path_tracer {

// Texture units of path_tracer/*.glsl; those of lights lie below, those of materials below and above.
inline constexpr int kSumsUnit = 4, kRaysUnit = 5, kHitsUnit = 6, kStatesUnit = 7, kRecordsUnit = 8,
                     kPassedUnit = 9, kFilterUnit = 4;

// After a program that wrote what others read, whichever way.
inline constexpr GLbitfield kBarriers = GL_SHADER_STORAGE_BARRIER_BIT |
                                        GL_TEXTURE_FETCH_BARRIER_BIT |
                                        GL_BUFFER_UPDATE_BARRIER_BIT;

inline void bind(unsigned binding, const gl::Buffer& buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.id());
}

inline void bind_texels(const gl::Texture& texture, int unit) {
  texture.bind(unit);
  glBindSampler(GLuint(unit), 0);  // one of a material's images may still sit there
}

}  // namespace panoptes::path_tracer
