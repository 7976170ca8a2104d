#include "rays/tracing_device.h"

#include <time.h>

#include <chrono>
#include <thread>

namespace panoptes::test {

namespace {

double wall_now() {
  return std::chrono::duration<double, std::milli>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

double cpu_now() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double(t.tv_sec) * 1e3 + double(t.tv_nsec) * 1e-6) /
         std::max(std::thread::hardware_concurrency(), 1u);
}

}  // namespace

Stopwatch::Stopwatch() : wall_(wall_now()), cpu_(cpu_now()) {}
double Stopwatch::wall_ms() const { return wall_now() - wall_; }
double Stopwatch::cpu_ms() const { return cpu_now() - cpu_; }

void TracingDevice::build(tracing::Tracer& tracer) {
  tracer.build(triangles_, programs_, timer_);
  glFinish();
  gl::check_errors("the build of a tracer");
}

Traced TracingDevice::trace(const tracing::Tracer& tracer, std::span<const TracedRay> rays,
                            const tracing::TraceOptions& options, int budget) {
  Traced result;
  result.hits.resize(rays.size());
  if (options.count_work) result.work.resize(rays.size());
  if (rays.empty()) return result;
  const gl::Buffer ray_buffer{rays};
  const gl::Buffer hits{int64_t(rays.size() * sizeof(TracedHit))};
  gl::Buffer work{int64_t(result.work.size() * sizeof(TracedWork))};
  const tracing::RayBatch batch{&ray_buffer, &hits, &work, uint32_t(rays.size())};
  glFinish();
  const Stopwatch watch;
  waves_.trace(tracer, triangles_, batch, options, programs_, budget);
  glFinish();
  result.wall_ms = watch.wall_ms();
  result.cpu_ms = watch.cpu_ms();
  result.dispatches = waves_.dispatches();
  hits.read(0, hits.bytes(), result.hits.data());
  if (options.count_work)
    work.read(0, int64_t(result.work.size() * sizeof(TracedWork)), result.work.data());
  gl::check_errors("the tracing of rays");
  return result;
}

std::vector<gl::PassTime> TracingDevice::pass_times() {
  std::vector<gl::PassTime> times = timer_.times();
  timer_.reset();
  return times;
}

}  // namespace panoptes::test
