#include "gpu_scene/mirrored_buffer.h"

#include "base/error.h"

#include <algorithm>

namespace panoptes::gpu_scene {

namespace {

// Fewer equal words than this between two runs are sent along: 256 bytes.
constexpr size_t kGap = 64;

}  // namespace

void MirroredBuffer::write_words(size_t first, std::span<const uint32_t> words) {
  const size_t end = first + words.size();
  const size_t known = std::clamp(words_.size(), first, end) - first;
  // What was never written differs from anything.
  if (words_.size() < end) {
    dirty_.push_back({words_.size(), end - words_.size()});
    words_.resize(end);
  }
  for (Run run : differing_runs(std::span<const uint32_t>(words_).subspan(first, known),
                                words.first(known), kGap))
    dirty_.push_back({first + run.first, run.count});
  std::copy(words.begin(), words.end(), words_.begin() + std::ptrdiff_t(first));
}

void MirroredBuffer::flush() {
  const int64_t bytes = int64_t(words_.size()) * 4;
  if (!buffer_ || buffer_.bytes() < bytes) {
    const int64_t limit = max_texels_ * texel_;
    if (bytes > limit)
      fail("the scene has more {} than this graphics driver can address ({}): hide objects or "
           "join them",
           name_, max_texels_);
    // Half as much again as there was, so that a list that grows is not copied each time.
    gl::Buffer bigger(std::min(std::max(bytes, buffer_.bytes() * 3 / 2), limit));
    if (buffer_) glCopyNamedBufferSubData(buffer_.id(), bigger.id(), 0, 0, buffer_.bytes());
    buffer_ = std::move(bigger);
    if (format_) texture_ = gl::Texture(format_, buffer_);
  }
  merge_runs(dirty_, kGap);
  for (const Run& run : dirty_)
    buffer_.write(int64_t(run.first) * 4, int64_t(run.count) * 4, &words_[run.first]);
  dirty_.clear();
}

}  // namespace panoptes::gpu_scene
