#include "gpu_scene/heap.h"

#include "base/error.h"

#include <algorithm>

namespace panoptes::gpu_scene {

void RangeAllocator::grow(uint32_t capacity) {
  if (capacity <= capacity_) return;
  const Range added{capacity_, capacity - capacity_};
  capacity_ = capacity;
  release(added);
}

Range RangeAllocator::allocate(uint32_t count) {
  if (count == 0) return {};
  for (auto it = free_.begin(); it != free_.end(); ++it) {
    const auto [first, length] = *it;
    if (length < count) continue;
    free_.erase(it);
    if (length > count) free_[first + count] = length - count;
    return {first, count};
  }
  return {kFull, 0};
}

Range RangeAllocator::allocate_or_grow(uint32_t count) {
  Range found = allocate(count);
  if (found.first != kFull) return found;
  grow(std::max(capacity_ + count, capacity_ + capacity_ / 2));
  return allocate(count);
}

void RangeAllocator::release(const Range& range) {
  if (range.count == 0) return;
  auto [it, inserted] = free_.emplace(range.first, range.count);
  const auto next = std::next(it);
  if (next != free_.end() && it->first + it->second == next->first) {
    it->second += next->second;
    free_.erase(next);
  }
  if (it != free_.begin()) {
    const auto previous = std::prev(it);
    if (previous->first + previous->second == it->first) {
      previous->second += it->second;
      free_.erase(it);
    }
  }
}

void Heap::store(Range& range, uint32_t count, const void* data) {
  if (range.count != count) {
    release(range);
    Range found = ranges_.allocate(count);
    if (found.first == RangeAllocator::kFull) {
      grow(count);
      found = ranges_.allocate(count);
    }
    range = found;
  }
  buffer_.write(int64_t(range.first) * stride_, int64_t(count) * stride_, data);
}

void Heap::write(const Range& range, std::span<const Run> runs, const void* data) {
  for (const Run& run : runs)
    buffer_.write((int64_t(range.first) + int64_t(run.first)) * stride_,
                  int64_t(run.count) * stride_,
                  static_cast<const char*>(data) + int64_t(run.first) * stride_);
}

void Heap::release(Range& range) {
  ranges_.release(range);
  range = {};
}

void Heap::grow(uint32_t needed) {
  const int64_t old = ranges_.capacity();
  // Half as much again as there is, so that many small meshes do not copy the heap each time; the
  // first mesh gets just what it needs.
  const int64_t limit = std::min<int64_t>(max_texels_ / texels_, 0xfffffff0);
  const int64_t wanted = std::max(old + needed, old + old / 2);
  const int64_t capacity = std::min(wanted, limit);
  if (capacity < old + needed)
    fail("the scene has more {} than this graphics driver can address ({}): reduce subdivisions or "
         "hide objects",
         name_, limit);
  gl::Buffer bigger(capacity * stride_);
  if (old > 0)
    glCopyNamedBufferSubData(buffer_.id(), bigger.id(), 0, 0, old * stride_);
  buffer_ = std::move(bigger);
  texture_ = gl::Texture(format_, buffer_);
  ranges_.grow(uint32_t(capacity));
}

}  // namespace panoptes::gpu_scene
