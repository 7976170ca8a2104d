// How a frame that is no longer wanted is left: between passes, by an exception that is no error.
#pragma once

#include <atomic>

namespace panoptes {

struct Cancelled {};

inline void stop_if(const std::atomic<bool>& cancelled) {
  if (cancelled) throw Cancelled{};
}

}  // namespace panoptes
