// The reports of the benchmark: each measures and returns tables.
#pragma once

#include "rays/scenes.h"
#include "rays/tracers.h"
#include "rays/tracing_device.h"
#include "rays_bench/options.h"
#include "rays_bench/table.h"

#include <functional>

namespace panoptes::test {

// Wall clock, and CPU time divided by the cores.
struct Milliseconds {
  double wall = 0, cpu = 0;
};
// Medians of `repeats` runs.
Milliseconds median_time(int repeats, const std::function<void()>& run);
// The least of three runs.
Milliseconds least_time(const std::function<void()>& run);
// The one to compare: on a software renderer CPU time, which others on the machine do not disturb;
// with a GPU, wall clock.
double fair(const Milliseconds& time, const gl::DeviceInfo& device);

// By name or path. Throws Error.
RayScene load_scene(const std::string& name);
std::vector<TracerEntry> chosen_tracers(const BenchOptions& options);

// Traced three times: the least time, and what was found.
struct Speed {
  Milliseconds time;
  std::vector<TracedHit> hits;
};
Speed trace_speed(TracingDevice& device, const tracing::Tracer& tracer,
                  const std::vector<TracedRay>& rays, bool any_hit);

// Builds and rays of each scene, by tracer, with mismatches.
std::vector<Table> speed_report(TracingDevice& device, const BenchOptions& options);
// Thesis, Table 7.1: Mrays/s by kind of ray.
std::vector<Table> table_7_1(TracingDevice& device, const BenchOptions& options);
// Thesis, Figure 7.8: build and trace of frames of growing size where geometry changes each frame.
std::vector<Table> figure_7_8(TracingDevice& device, const BenchOptions& options);
// Thesis, Figure 7.10: memory, build and trace by tiles and buckets.
std::vector<Table> figure_7_10(TracingDevice& device, const BenchOptions& options);
// Frames of a deforming scene, everything built anew for each.
std::vector<Table> deform_report(TracingDevice& device, const BenchOptions& options);

}  // namespace panoptes::test
