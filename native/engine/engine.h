// The public C++ API: one render thread that owns one GL context, the scene that callers edit, and
// jobs that render it. Callers never touch GL; edits are cheap copies and every call is safe from
// any thread.
#pragma once

#include "engine/request.h"
#include "engine/shared_scene.h"
#include "film/pieces.h"
#include "gl/context.h"
#include "scene/scene.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

namespace panoptes::engine {

// One frame under way. Lives as long as anybody holds it.
class Job {
 public:
  explicit Job(RenderRequest request, TakeOver over = {}) : request_(std::move(request)), over_(std::move(over)) {}

  const RenderRequest& request() const { return request_; }
  void cancel() { cancelled_ = true; }
  bool cancelled() const { return cancelled_; }
  float progress() const { return progress_; }  // 0 .. 1
  std::string status() const;                   // what runs now
  // Waits up to `seconds`; true when the job has ended, however it ended.
  bool wait(double seconds);
  // Throws Error if the job failed.
  void check() const;
  // Samples in the picture that read() gives; grows while a live job runs.
  uint32_t samples_ready() const;
  // Whether read() gives at least a first look: Combined without some of the effects, which counts as no
  // sample. Only for frames of a 3D View.
  bool has_look() const;
  // From when the frame's turn came to its first sample; 0 while there is none.
  double first_sample_seconds() const;
  // A pass, channels a pixel, rows bottom to top. Live jobs offer Combined after each sample, all
  // jobs offer everything at their end. Throws Error when it is not there.
  std::vector<float> read(film::Pass pass) const;
  // What a 3D View shows while paths take over Real-time's picture (TakeOver): RGBA, rows bottom to top;
  // empty until there is something to show by them.
  std::vector<float> read_shown() const;
  // What the finished render kept for merging; null where the request did not ask for it.
  std::shared_ptr<const film::Pieces> pieces() const;
  // Of a live job that runs, those of the picture that read() gives; of others none before their end.
  RenderStats stats() const;

 private:
  friend class RenderThread;
  void publish(film::Pass pass, std::vector<float> pixels, uint32_t samples);
  void look(std::vector<float> pixels);
  void show(std::vector<float> pixels);
  void tell(RenderStats stats);
  void begin();
  void end_first_sample();
  void set_status(std::string text, float progress);
  void end(std::string error);

  RenderRequest request_;
  TakeOver over_;
  std::atomic<bool> cancelled_{false};
  std::atomic<float> progress_{0};
  mutable std::mutex mutex_;
  std::condition_variable ended_condition_;
  bool ended_ = false;
  std::string error_, status_ = "waiting";
  uint32_t samples_ready_ = 0;
  std::chrono::steady_clock::time_point began_;
  double first_sample_seconds_ = 0;
  std::map<film::Pass, std::vector<float>> pixels_;
  std::vector<float> shown_;
  std::shared_ptr<const film::Pieces> pieces_;
  RenderStats stats_;
};

class Engine {
 public:
  // Starts the render thread; throws Error when no driver will do.
  explicit Engine(const gl::ContextOptions& options = {});
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  const gl::DeviceInfo& device() const { return device_; }

  // Whether the graphics driver has failed or run out of memory: what the engine holds there may be incomplete, and
  // another engine should take its place.
  bool spoiled() const { return spoiled_; }

  // Cancels what runs, ends the thread. Idempotent; every later call throws Error.
  void close();

  // Runs `change` on the scene, between frames' uploads, and waits for them.
  template <class F>
  auto edit(F&& change) {
    require_open();
    const SharedScene::Hold held = scene_.hold();
    return change(*held);
  }
  // The same without waiting: while a frame uploads or compiles, `change` happens before the next.
  // What makes no sense is thrown as an Error here or fails the next frame.
  void post(SharedScene::Change change) {
    require_open();
    scene_.post(std::move(change));
  }

  // Lets the render thread upload images while it has nothing to render, so that images that are
  // still being decoded need not wait for those that are done, nor all be in memory at once.
  void upload_images();

  // Queues a frame of the scene as it is when the frame's turn comes. Throws Error when the request
  // makes no sense.
  std::shared_ptr<Job> render(RenderRequest request, TakeOver over = {});

 private:
  void require_open() const;
  void run(const gl::ContextOptions& options, std::function<void(std::string)> started);

  gl::DeviceInfo device_;
  SharedScene scene_;
  std::mutex queue_mutex_;
  std::condition_variable queue_condition_;
  std::deque<std::shared_ptr<Job>> queue_;
  std::shared_ptr<Job> current_;
  std::atomic<bool> closed_{false}, spoiled_{false};
  bool images_waiting_ = false;  // guarded by queue_mutex_
  std::thread thread_;
};

}  // namespace panoptes::engine
