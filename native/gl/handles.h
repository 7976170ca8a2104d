// Move-only owners of GL objects, one small class each. A default-made one is empty (id() == 0) and
// owns nothing; destroying or overwriting one deletes the object on the thread with the context.
// Allocations are counted in gl/counters.h. All creation goes through direct state access, so no
// binding point is disturbed.
#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace panoptes::gl {

// Shared by the classes below: an id and the bytes that were counted for it.
class Handle {
 public:
  Handle() = default;
  Handle(Handle&& other) noexcept
      : id_(std::exchange(other.id_, 0)), bytes_(std::exchange(other.bytes_, 0)) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle& operator=(Handle&&) = delete;

  GLuint id() const { return id_; }
  explicit operator bool() const { return id_ != 0; }
  int64_t bytes() const { return bytes_; }

 protected:
  void swap(Handle& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(bytes_, other.bytes_);
  }
  GLuint id_ = 0;
  int64_t bytes_ = 0;
};

// Immutable-size storage on the device.
class Buffer : public Handle {
 public:
  Buffer() = default;
  // `bytes` of storage, filled from `data` if given; at least 16 bytes are allocated so that an
  // empty list can still be bound. Throws Error when the driver has no memory left.
  explicit Buffer(int64_t bytes, const void* data = nullptr);
  template <class T>
  explicit Buffer(std::span<const T> data) : Buffer(int64_t(data.size_bytes()), data.data()) {}
  Buffer(Buffer&&) noexcept = default;
  Buffer& operator=(Buffer&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Buffer();

  // Makes it at least so large; what it held is lost when it grows, and freed before the new storage
  // is taken. True if it has grown.
  bool reserve(int64_t bytes);
  void write(int64_t offset, int64_t bytes, const void* data);
  void clear();  // to zero bits
  void read(int64_t offset, int64_t bytes, void* data) const;
};

struct TextureOptions {
  GLenum target = GL_TEXTURE_2D;
  GLenum format = GL_RGBA32F;  // sized internal format
  int width = 1, height = 1, layers = 1;
  int levels = 1;
};

class Texture : public Handle {
 public:
  Texture() = default;
  explicit Texture(const TextureOptions& options);
  // A buffer texture over all of `buffer`, which must outlive it.
  Texture(GLenum format, const Buffer& buffer);
  Texture(Texture&&) noexcept = default;
  Texture& operator=(Texture&& other) noexcept {
    swap(other);
    std::swap(options_, other.options_);
    return *this;
  }
  ~Texture();

  const TextureOptions& options() const { return options_; }
  // Uploads a level of a 2D texture (rows bottom to top, without gaps).
  void write(GLenum format, GLenum type, const void* data, int level = 0);
  void bind(int unit) const { glBindTextureUnit(GLuint(unit), id_); }
  void bind_image(int unit, GLenum access) const;

 private:
  TextureOptions options_;
};

class Framebuffer : public Handle {
 public:
  Framebuffer() = default;
  static Framebuffer make();
  Framebuffer(Framebuffer&&) noexcept = default;
  Framebuffer& operator=(Framebuffer&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Framebuffer();
};

class VertexArray : public Handle {
 public:
  VertexArray() = default;
  static VertexArray make();
  VertexArray(VertexArray&&) noexcept = default;
  VertexArray& operator=(VertexArray&& other) noexcept {
    swap(other);
    return *this;
  }
  ~VertexArray();
};

struct SamplerOptions {
  GLenum min_filter = GL_LINEAR;
  GLenum mag_filter = GL_LINEAR;
  GLenum wrap_s = GL_CLAMP_TO_EDGE;
  GLenum wrap_t = GL_CLAMP_TO_EDGE;
  bool codes = false;          // sRGB textures give their codes, not decoded light
};

class Sampler : public Handle {
 public:
  Sampler() = default;
  explicit Sampler(const SamplerOptions& options);
  Sampler(Sampler&&) noexcept = default;
  Sampler& operator=(Sampler&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Sampler();
  void bind(int unit) const { glBindSampler(GLuint(unit), id_); }
};

}  // namespace panoptes::gl
