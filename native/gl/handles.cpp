#include "gl/handles.h"

#include "base/error.h"
#include "gl/context.h"
#include "gl/counters.h"

#include <algorithm>

namespace panoptes::gl {

namespace {

int bytes_per_texel(GLenum format) {
  switch (format) {
    case GL_R8:
    case GL_R8UI: return 1;
    case GL_R16:
    case GL_R16F:
    case GL_RG8: return 2;
    case GL_RGBA8:
    case GL_RG16:
    case GL_RG16F:
    case GL_R32F:
    case GL_R32UI:
    case GL_DEPTH_COMPONENT32F: return 4;
    case GL_RGBA16:
    case GL_RGBA16F:
    case GL_RG32F:
    case GL_RG32UI: return 8;
    default: return 16;
  }
}

// Creation is the only place where the driver can run out of memory: turn that into a sentence.
void check_allocation(int64_t bytes, const char* what) {
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return;
  fail_driver("the graphics driver could not allocate {} MiB for a {}: lower the resolution, the texture "
              "sizes or the shadow resolution",
              (bytes >> 20) + 1, what);
}

}  // namespace

Buffer::Buffer(int64_t bytes, const void* data) {
  bytes_ = std::max<int64_t>(bytes, 16);
  glCreateBuffers(1, &id_);
  glNamedBufferStorage(id_, bytes_, bytes == bytes_ ? data : nullptr, GL_DYNAMIC_STORAGE_BIT);
  const GLenum error = glGetError();
  if (error != GL_NO_ERROR) {
    glDeleteBuffers(1, &id_);
    fail_driver("the graphics driver could not allocate {} MiB for a buffer: simplify the scene, or lower "
                "the resolution",
                (bytes_ >> 20) + 1);
  }
  ++counters().buffers;
  counters().allocated(bytes_);
  if (data && bytes > 0) {
    if (bytes != bytes_) glNamedBufferSubData(id_, 0, bytes, data);
    counters().uploaded(bytes);
  }
}

Buffer::~Buffer() {
  if (!id_) return;
  glDeleteBuffers(1, &id_);
  --counters().buffers;
  counters().freed(bytes_);
}

bool Buffer::reserve(int64_t bytes) {
  if (id_ && bytes_ >= bytes) return false;
  *this = Buffer();
  *this = Buffer(bytes);
  return true;
}

void Buffer::write(int64_t offset, int64_t bytes, const void* data) {
  if (bytes <= 0) return;
  glNamedBufferSubData(id_, offset, bytes, data);
  counters().uploaded(bytes);
}

void Buffer::clear() {
  glClearNamedBufferData(id_, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

void Buffer::read(int64_t offset, int64_t bytes, void* data) const {
  glGetNamedBufferSubData(id_, offset, bytes, data);
}

Texture::Texture(const TextureOptions& options) : options_(options) {
  glCreateTextures(options.target, 1, &id_);
  const bool layered = options.target == GL_TEXTURE_2D_ARRAY || options.target == GL_TEXTURE_3D;
  if (layered)
    glTextureStorage3D(id_, options.levels, options.format, options.width, options.height,
                       options.layers);
  else
    glTextureStorage2D(id_, options.levels, options.format, options.width, options.height);
  bytes_ = int64_t(options.width) * options.height * options.layers *
           bytes_per_texel(options.format);
  if (options.levels > 1) bytes_ += bytes_ / 3;
  try {
    check_allocation(bytes_, "texture");
  } catch (...) {
    glDeleteTextures(1, &id_);
    throw;
  }
  // Without a sampler object, textures are read by texelFetch; integer formats allow no filter.
  glTextureParameteri(id_, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(id_, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  ++counters().textures;
  counters().allocated(bytes_);
}

Texture::Texture(GLenum format, const Buffer& buffer) {
  glCreateTextures(GL_TEXTURE_BUFFER, 1, &id_);
  glTextureBuffer(id_, format, buffer.id());
  options_.target = GL_TEXTURE_BUFFER;
  options_.format = format;
  ++counters().textures;  // holds no memory of its own
}

Texture::~Texture() {
  if (!id_) return;
  glDeleteTextures(1, &id_);
  --counters().textures;
  counters().freed(bytes_);
}

void Texture::write(GLenum format, GLenum type, const void* data, int level) {
  const int width = std::max(options_.width >> level, 1),
            height = std::max(options_.height >> level, 1);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(id_, level, 0, 0, width, height, format, type, data);
  counters().uploaded(int64_t(width) * height * bytes_per_texel(options_.format));
}

void Texture::bind_image(int unit, GLenum access) const {
  const bool layered = options_.target == GL_TEXTURE_2D_ARRAY || options_.target == GL_TEXTURE_3D;
  glBindImageTexture(GLuint(unit), id_, 0, layered, 0, access, options_.format);
}

Framebuffer Framebuffer::make() {
  Framebuffer made;
  glCreateFramebuffers(1, &made.id_);
  return made;
}

Framebuffer::~Framebuffer() {
  if (id_) glDeleteFramebuffers(1, &id_);
}

VertexArray VertexArray::make() {
  VertexArray made;
  glCreateVertexArrays(1, &made.id_);
  return made;
}

VertexArray::~VertexArray() {
  if (id_) glDeleteVertexArrays(1, &id_);
}

Sampler::Sampler(const SamplerOptions& options) {
  glCreateSamplers(1, &id_);
  glSamplerParameteri(id_, GL_TEXTURE_MIN_FILTER, GLint(options.min_filter));
  glSamplerParameteri(id_, GL_TEXTURE_MAG_FILTER, GLint(options.mag_filter));
  glSamplerParameteri(id_, GL_TEXTURE_WRAP_S, GLint(options.wrap_s));
  glSamplerParameteri(id_, GL_TEXTURE_WRAP_T, GLint(options.wrap_t));
  if (options.codes && epoxy_has_gl_extension("GL_EXT_texture_sRGB_decode"))
    glSamplerParameteri(id_, GL_TEXTURE_SRGB_DECODE_EXT, GL_SKIP_DECODE_EXT);
}

Sampler::~Sampler() {
  if (id_) glDeleteSamplers(1, &id_);
}

}  // namespace panoptes::gl
