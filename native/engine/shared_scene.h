// The scene between the threads that edit it and the one that renders it.
#pragma once

#include "scene/scene.h"

#include <deque>
#include <functional>
#include <mutex>
#include <utility>

namespace panoptes::engine {

class SharedScene {
 public:
  using Change = std::function<void(scene::Scene&)>;

  // Nobody else touches the scene while it lives; everything that was posted before has happened.
  class Hold {
   public:
    scene::Scene& operator*() const { return scene_; }
    scene::Scene* operator->() const { return &scene_; }

   private:
    friend class SharedScene;
    Hold(std::mutex& mutex, scene::Scene& scene) : lock_(mutex), scene_(scene) {}
    std::unique_lock<std::mutex> lock_;
    scene::Scene& scene_;
  };

  // Waits for others that hold it. Throws Error when a change that was posted made no sense; the
  // others have happened then, and the next call throws no more.
  Hold hold();

  // Changes the scene without waiting for anyone: at once if nobody holds it, otherwise before the next
  // one does. Throws Error when the change makes no sense, and it is known by now.
  void post(Change change);

 private:
  void apply();  // while mutex_ is held

  std::mutex mutex_;  // of the scene
  scene::Scene scene_;
  std::mutex changes_mutex_;
  std::deque<Change> changes_;
};

}  // namespace panoptes::engine
