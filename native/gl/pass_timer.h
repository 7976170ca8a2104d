// Times of GL passes that tell the truth on every driver.
//
// On a GPU a pass is timed by a pair of timestamp queries, read back after the frame. llvmpipe's
// queries are wrong by orders of magnitude, so there each pass ends in glFinish and wall clock
// counts; a software rasteriser loses nothing by that, since nothing runs beside it.
#pragma once

#include "gl/context.h"

#include <chrono>
#include <string>
#include <vector>

namespace panoptes::gl {

struct PassTime {
  std::string name;
  double ms = 0;
};

class PassTimer {
 public:
  explicit PassTimer(const DeviceInfo& device) : wall_clock_(device.software) {}
  ~PassTimer();
  PassTimer(const PassTimer&) = delete;
  PassTimer& operator=(const PassTimer&) = delete;

  void begin(const std::string& name);
  void end();

  // Collects what has been measured; adds up passes of one name, in the order of first use.
  // Waits for the device.
  std::vector<PassTime> times();
  // Forgets all sums.
  void reset();

 private:
  struct Pending {
    size_t index;
    unsigned queries[2];
  };
  size_t index_of(const std::string& name);
  void collect();

  bool wall_clock_;
  size_t current_ = 0;
  std::chrono::steady_clock::time_point start_;
  std::vector<PassTime> sums_;
  std::vector<Pending> pending_;
};

// Times the enclosing block.
class PassScope {
 public:
  PassScope(PassTimer& timer, const std::string& name) : timer_(timer) { timer_.begin(name); }
  ~PassScope() { timer_.end(); }
  PassScope(const PassScope&) = delete;
  PassScope& operator=(const PassScope&) = delete;

 private:
  PassTimer& timer_;
};

}  // namespace panoptes::gl
