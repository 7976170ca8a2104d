#include "rays_bench/reports.h"

#include "rays/ray_sets.h"

#include <algorithm>
#include <filesystem>

namespace panoptes::test {

namespace {

constexpr int kTracings = 3;

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

Milliseconds median_time(int repeats, const std::function<void()>& run) {
  std::vector<double> wall, cpu;
  for (int i = 0; i < repeats; ++i) {
    const Stopwatch watch;
    run();
    wall.push_back(watch.wall_ms());
    cpu.push_back(watch.cpu_ms());
  }
  return {median(wall), median(cpu)};
}

Milliseconds least_time(const std::function<void()>& run) {
  Milliseconds least = median_time(1, run);
  for (int i = 1; i < kTracings; ++i) {
    const Milliseconds time = median_time(1, run);
    least = {std::min(least.wall, time.wall), std::min(least.cpu, time.cpu)};
  }
  return least;
}

double fair(const Milliseconds& time, const gl::DeviceInfo& device) {
  return device.software ? time.cpu : time.wall;
}

RayScene load_scene(const std::string& name) {
  return std::filesystem::path(name).extension() == ".scene" ? snapshot_scene(name)
                                                             : generated_scene(name);
}

std::vector<TracerEntry> chosen_tracers(const BenchOptions& options) {
  std::vector<TracerEntry> chosen;
  for (const std::string& name : options.tracers) chosen.push_back(tracer_named(name));
  if (!options.tracers.empty()) return chosen;
  for (const TracerEntry& entry : tracers())
    if (!entry.slow) chosen.push_back(entry);
  return chosen;
}

Speed trace_speed(TracingDevice& device, const tracing::Tracer& tracer,
                  const std::vector<TracedRay>& rays, bool any_hit) {
  Speed speed;
  for (int i = 0; i < kTracings; ++i) {
    Traced traced = device.trace(tracer, rays, {.any_hit = any_hit});
    const auto least = [i](double before, double now) { return i ? std::min(before, now) : now; };
    speed.time.wall = least(speed.time.wall, traced.wall_ms);
    speed.time.cpu = least(speed.time.cpu, traced.cpu_ms);
    speed.hits = std::move(traced.hits);
  }
  return speed;
}

}  // namespace panoptes::test
