// A GPU buffer with a copy on the host: whoever writes says what is due, and only the words that
// differ from what the GPU has are sent. So whole tables may be written again after any edit, and
// still nothing goes to the GPU that is there already. For tables, whose size is that of the list
// of objects; geometry has heaps without a copy (gpu_scene/heap.h).
#pragma once

#include "base/runs.h"
#include "gl/handles.h"
#include "gpu_scene/heap.h"

#include <span>
#include <string>
#include <vector>

namespace panoptes::gpu_scene {

class MirroredBuffer {
 public:
  // `format` is that of the buffer texture over it, `texel` its bytes; format 0 for none. `name` is
  // for the message when `max_texels` is exceeded.
  MirroredBuffer(std::string name, GLenum format = 0, int texel = 4,
                 int64_t max_texels = int64_t(1) << 31)
      : name_(std::move(name)), format_(format), texel_(texel), max_texels_(max_texels) {}

  // What elements from `first` on are to be after the next flush().
  template <class T>
  void write(size_t first, std::span<const T> values) {
    static_assert(sizeof(T) % sizeof(uint32_t) == 0);
    write_words(first * sizeof(T) / sizeof(uint32_t),
                {reinterpret_cast<const uint32_t*>(values.data()),
                 values.size_bytes() / sizeof(uint32_t)});
  }
  template <class T>
  void write(size_t first, const T& value) {
    write(first, std::span<const T>(&value, 1));
  }

  // Sends what differs, in few transfers; grows the buffer first if it must. Throws Error when the
  // driver cannot address that much.
  void flush();

  const gl::Buffer& buffer() const { return buffer_; }
  const gl::Texture& texture() const { return texture_; }

 private:
  void write_words(size_t first, std::span<const uint32_t> words);

  std::string name_;
  GLenum format_;
  int texel_;
  int64_t max_texels_;
  std::vector<uint32_t> words_;
  std::vector<Run> dirty_;  // in words
  gl::Buffer buffer_;
  gl::Texture texture_;
};

// One with room handed out in ranges of T, which keep their places until they are released.
template <class T>
class MirroredHeap : public MirroredBuffer {
 public:
  using MirroredBuffer::MirroredBuffer;

  // Makes `range` hold `values`; it moves only when their number changes.
  void store(Range& range, std::span<const T> values) {
    if (range.count != values.size()) {
      ranges_.release(range);
      range = ranges_.allocate_or_grow(uint32_t(values.size()));
    }
    write(range.first, values);
  }
  void release(Range& range) {
    ranges_.release(range);
    range = {};
  }

 private:
  RangeAllocator ranges_;
};

}  // namespace panoptes::gpu_scene
