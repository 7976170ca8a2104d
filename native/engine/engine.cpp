#include "engine/engine.h"

#include "base/error.h"
#include "engine/render_thread.h"

#include <future>

namespace panoptes::engine {

std::string Job::status() const {
  std::lock_guard lock(mutex_);
  return status_;
}

bool Job::wait(double seconds) {
  std::unique_lock lock(mutex_);
  return ended_condition_.wait_for(lock, std::chrono::duration<double>(seconds),
                                   [&] { return ended_; });
}

void Job::check() const {
  std::lock_guard lock(mutex_);
  if (!error_.empty()) throw Error(error_);
}

uint32_t Job::samples_ready() const {
  std::lock_guard lock(mutex_);
  return samples_ready_;
}

std::vector<float> Job::read(film::Pass pass) const {
  std::lock_guard lock(mutex_);
  const auto found = pixels_.find(pass);
  if (found == pixels_.end())
    fail("pass '{}' is not there yet: it was not asked for, or the render has not come that far",
         pass == film::Pass::kCount ? "?" : film::info(pass).name);
  return found->second;
}

std::vector<float> Job::read_shown() const {
  std::lock_guard lock(mutex_);
  return shown_;
}

std::shared_ptr<const film::Pieces> Job::pieces() const {
  std::lock_guard lock(mutex_);
  return pieces_;
}

RenderStats Job::stats() const {
  std::lock_guard lock(mutex_);
  return stats_;
}

void Job::publish(film::Pass pass, std::vector<float> pixels, uint32_t samples) {
  std::lock_guard lock(mutex_);
  pixels_[pass] = std::move(pixels);
  samples_ready_ = samples;
}

void Job::tell(RenderStats stats) {
  std::lock_guard lock(mutex_);
  stats_ = std::move(stats);
}

void Job::look(std::vector<float> pixels) {
  publish(film::Pass::kCombined, std::move(pixels), 0);
}

void Job::show(std::vector<float> pixels) {
  std::lock_guard lock(mutex_);
  shown_ = std::move(pixels);
}

bool Job::has_look() const {
  std::lock_guard lock(mutex_);
  return pixels_.count(film::Pass::kCombined) > 0;
}

void Job::begin() {
  std::lock_guard lock(mutex_);
  began_ = std::chrono::steady_clock::now();
}

void Job::end_first_sample() {
  std::lock_guard lock(mutex_);
  first_sample_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
}

double Job::first_sample_seconds() const {
  std::lock_guard lock(mutex_);
  return first_sample_seconds_;
}

void Job::set_status(std::string text, float progress) {
  progress_ = progress;
  std::lock_guard lock(mutex_);
  status_ = std::move(text);
}

void Job::end(std::string error) {
  {
    std::lock_guard lock(mutex_);
    ended_ = true;
    status_ = error.empty() ? "done" : "failed";
    error_ = std::move(error);
  }
  ended_condition_.notify_all();
}

Engine::Engine(const gl::ContextOptions& options) {
  std::promise<std::string> promise;
  std::future<std::string> started = promise.get_future();
  thread_ = std::thread([this, options, &promise] {
    run(options, [&promise](std::string error) { promise.set_value(std::move(error)); });
  });
  const std::string error = started.get();
  if (!error.empty()) {
    thread_.join();
    closed_ = true;
    throw Error(error);
  }
}

Engine::~Engine() { close(); }

void Engine::close() {
  if (closed_.exchange(true)) return;
  {
    std::lock_guard lock(queue_mutex_);
    for (const auto& job : queue_) job->cancel();
    if (current_) current_->cancel();
  }
  queue_condition_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Engine::require_open() const {
  if (closed_) fail("the render engine has been closed: start it again");
}

std::shared_ptr<Job> Engine::render(RenderRequest request, TakeOver over) {
  require_open();
  request.check();
  over.check(request.camera);
  request.camera.check(device_.max_texture_size);
  auto job = std::make_shared<Job>(std::move(request), std::move(over));
  {
    std::lock_guard lock(queue_mutex_);
    queue_.push_back(job);
  }
  queue_condition_.notify_one();
  return job;
}

void Engine::upload_images() {
  require_open();
  {
    std::lock_guard lock(queue_mutex_);
    images_waiting_ = true;
  }
  queue_condition_.notify_one();
}

void Engine::run(const gl::ContextOptions& options, std::function<void(std::string)> started) {
  std::unique_ptr<RenderThread> renderer;
  try {
    renderer = std::make_unique<RenderThread>(options);
    device_ = renderer->device();
  } catch (const std::exception& error) {
    renderer.reset();
    started(error.what());
    return;
  }
  started("");
  while (true) {
    std::shared_ptr<Job> job;
    {
      std::unique_lock lock(queue_mutex_);
      current_.reset();
      queue_condition_.wait(lock, [&] { return closed_ || !queue_.empty() || images_waiting_; });
      if (!queue_.empty()) {
        job = current_ = queue_.front();
        queue_.pop_front();
      } else if (closed_) {
        break;  // every job has been told
      }
      if (!job) images_waiting_ = false;
    }
    if (!job) {
      if (renderer->upload_ahead(scene_)) {
        std::lock_guard lock(queue_mutex_);
        images_waiting_ = true;  // there may be more
      }
      continue;
    }
    renderer->render(*job, scene_, spoiled_);
  }
}

}  // namespace panoptes::engine
