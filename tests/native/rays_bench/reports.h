// The reports of the benchmark: each measures and hands over tables as they are ready.
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

using Emit = std::function<void(const Table&)>;

// Builds and rays of each scene, by tracer, with mismatches.
void speed_report(TracingDevice& device, const BenchOptions& options, const Emit& emit);
// Thesis, Table 7.1: Mrays/s by kind of ray.
void table_7_1(TracingDevice& device, const BenchOptions& options, const Emit& emit);
// Thesis, Table 7.3: the formula of its memory beside what is allocated.
void table_7_3(TracingDevice& device, const BenchOptions& options, const Emit& emit);
// Thesis, Figure 7.8: build and trace of frames of growing size where geometry changes each frame.
void figure_7_8(TracingDevice& device, const BenchOptions& options, const Emit& emit);
// Thesis, Figure 7.10: memory, build and trace by tiles and buckets.
void figure_7_10(TracingDevice& device, const BenchOptions& options, const Emit& emit);
// Frames of a deforming scene, everything built anew for each.
void deform_report(TracingDevice& device, const BenchOptions& options, const Emit& emit);

// Thesis, Table 6.1: fragments, layers, build and trace; and bounds of depth by boxes.
void table_6_1(TracingDevice& device, const BenchOptions& options, const Emit& emit);
// Thesis, Table 6.2: the bytes of each storage beside the thesis' formulas.
void table_6_2(TracingDevice& device, const BenchOptions& options, const Emit& emit);
// Thesis, Figure 6.11: build and trace beside spatial structures.
void figure_6_11(TracingDevice& device, const BenchOptions& options, const Emit& emit);
// Thesis, Figure 6.12: the storages in a single view.
void figure_6_12(TracingDevice& device, const BenchOptions& options, const Emit& emit);
// Thesis, Table 7.2: fragments beside primitives in the same views.
void table_7_2(TracingDevice& device, const BenchOptions& options, const Emit& emit);
// Thesis, Figure 7.11: memory of both by resolution.
void figure_7_11(TracingDevice& device, const BenchOptions& options, const Emit& emit);
// What fragments lose and make up in the catalogue of hard cases.
void hard_cases_report(TracingDevice& device, const BenchOptions& options, const Emit& emit);

}  // namespace panoptes::test
