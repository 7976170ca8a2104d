// One large GPU buffer that many meshes share, with room handed out and taken back in ranges, so
// that an edited mesh uploads its own range and nothing else.
#pragma once

#include "base/runs.h"
#include "gl/handles.h"

#include <cstdint>
#include <map>
#include <span>
#include <string>

namespace panoptes::gpu_scene {

// A run of elements; count 0 means none.
struct Range {
  uint32_t first = 0;
  uint32_t count = 0;
};

// First-fit bookkeeping of free runs; knows no GL.
class RangeAllocator {
 public:
  // Extends the space at its end.
  void grow(uint32_t capacity);
  // A run of `count` elements, or first == kFull when none is long enough.
  Range allocate(uint32_t count);
  // The same, but extends the space by half, or by what is needed, when none is long enough.
  Range allocate_or_grow(uint32_t count);
  void release(const Range& range);
  uint32_t capacity() const { return capacity_; }
  static constexpr uint32_t kFull = 0xffffffffu;

 private:
  uint32_t capacity_ = 0;
  std::map<uint32_t, uint32_t> free_;  // first -> count; neighbours are merged
};

class Heap {
 public:
  // `stride` bytes an element; `format` is that of the buffer texture over it; `texels` of it make
  // one element. `name` is for the message when `max_texels` is exceeded.
  Heap(std::string name, GLenum format, int stride, int texels, int64_t max_texels)
      : name_(std::move(name)), format_(format), stride_(stride), texels_(texels),
        max_texels_(max_texels) {}

  // Makes `range` hold `count` elements from `data`, in place when the count is unchanged.
  void store(Range& range, uint32_t count, const void* data);
  // Replaces just these elements of a range whose new content is `data`.
  void write(const Range& range, std::span<const Run> runs, const void* data);
  void release(Range& range);

  const gl::Buffer& buffer() const { return buffer_; }
  const gl::Texture& texture() const { return texture_; }

 private:
  void grow(uint32_t needed);

  std::string name_;
  GLenum format_;
  int stride_, texels_;
  int64_t max_texels_;
  RangeAllocator ranges_;
  gl::Buffer buffer_;
  gl::Texture texture_;
};

}  // namespace panoptes::gpu_scene
