// Buffers that grow with room to spare, so that they are not made anew each time; what they held is lost.
#pragma once

#include "gl/handles.h"

namespace panoptes::radiance_cache {

// Of at least so many bytes.
inline void want(gl::Buffer& buffer, int64_t bytes) {
  // A whole number of texels: others could not be cleared.
  if (!buffer || buffer.bytes() < bytes) buffer.reserve((bytes + bytes / 4 + 15) / 16 * 16);
}

// With a buffer texture of all of it.
inline void want(gl::Buffer& buffer, gl::Texture& texels, GLenum format, int64_t bytes) {
  if (buffer && buffer.bytes() >= bytes) return;
  texels = gl::Texture();
  want(buffer, bytes);
  texels = gl::Texture(format, buffer);
}

}  // namespace panoptes::radiance_cache
