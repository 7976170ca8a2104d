#include "gl/pass_timer.h"

#include <epoxy/gl.h>

namespace panoptes::gl {

PassTimer::~PassTimer() {
  for (Pending& pending : pending_) glDeleteQueries(2, pending.queries);
}

size_t PassTimer::index_of(const std::string& name) {
  for (size_t i = 0; i < sums_.size(); ++i)
    if (sums_[i].name == name) return i;
  sums_.push_back({name, 0});
  return sums_.size() - 1;
}

void PassTimer::begin(const std::string& name) {
  current_ = index_of(name);
  if (wall_clock_) {
    start_ = std::chrono::steady_clock::now();
    return;
  }
  Pending pending{current_, {0, 0}};
  glCreateQueries(GL_TIMESTAMP, 2, pending.queries);
  glQueryCounter(pending.queries[0], GL_TIMESTAMP);
  pending_.push_back(pending);
}

void PassTimer::end() {
  if (!wall_clock_) {
    glQueryCounter(pending_.back().queries[1], GL_TIMESTAMP);
    return;
  }
  glFinish();
  sums_[current_].ms +=
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
}

void PassTimer::collect() {
  for (Pending& pending : pending_) {
    GLuint64 times[2] = {0, 0};
    for (int i = 0; i < 2; ++i)
      glGetQueryObjectui64v(pending.queries[i], GL_QUERY_RESULT, &times[i]);
    sums_[pending.index].ms += double(times[1] - times[0]) * 1e-6;
    glDeleteQueries(2, pending.queries);
  }
  pending_.clear();
}

std::vector<PassTime> PassTimer::times() {
  collect();
  return sums_;
}

void PassTimer::reset() {
  collect();
  sums_.clear();
}

}  // namespace panoptes::gl
