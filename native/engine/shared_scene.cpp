#include "engine/shared_scene.h"

#include <exception>

namespace panoptes::engine {

SharedScene::Hold SharedScene::hold() {
  Hold held(mutex_, scene_);
  apply();
  return held;
}

void SharedScene::post(Change change) {
  {
    std::lock_guard lock(changes_mutex_);
    changes_.push_back(std::move(change));
  }
  if (std::unique_lock lock(mutex_, std::try_to_lock); lock) apply();
}

void SharedScene::apply() {
  std::exception_ptr first;
  while (true) {
    Change change;
    {
      std::lock_guard lock(changes_mutex_);
      if (changes_.empty()) break;
      change = std::move(changes_.front());
      changes_.pop_front();
    }
    try {
      change(scene_);
    } catch (...) {
      if (!first) first = std::current_exception();
    }
  }
  if (first) std::rethrow_exception(first);
}

}  // namespace panoptes::engine
