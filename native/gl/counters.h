// Counts what the GL layer made, so that "only what is called for" can be proved: a skipped effect
// must leave every one of these numbers as it was. Written by the render thread, read by any.
#pragma once

#include <atomic>
#include <cstdint>

namespace panoptes::gl {

struct Counters {
  std::atomic<int64_t> buffers{0};         // alive
  std::atomic<int64_t> textures{0};        // alive
  std::atomic<int64_t> memory_bytes{0};    // held by the buffers and textures alive
  std::atomic<int64_t> peak_bytes{0};      // the most that memory_bytes has been
  std::atomic<int64_t> programs{0};        // compiled and linked so far
  std::atomic<int64_t> uploads{0};         // transfers to the device so far
  std::atomic<int64_t> uploaded_bytes{0};

  void allocated(int64_t bytes) {
    const int64_t now = memory_bytes += bytes;
    int64_t peak = peak_bytes;
    while (now > peak && !peak_bytes.compare_exchange_weak(peak, now)) {
    }
  }
  void freed(int64_t bytes) { memory_bytes -= bytes; }
  void uploaded(int64_t bytes) {
    ++uploads;
    uploaded_bytes += bytes;
  }
};

// The process-wide instance: one render thread owns one context.
Counters& counters();

}  // namespace panoptes::gl
