// A context with one list of triangles in it, and what tracers need to be built and used there.
#pragma once

#include "gl/context.h"
#include "gl/pass_timer.h"
#include "rays/triangles.h"
#include "tracing/ray_waves.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace panoptes::test {

using shared::TracedHit;
using shared::TracedRay;
using shared::TracedWork;

struct Traced {
  std::vector<TracedHit> hits;
  std::vector<TracedWork> work;  // with count_work
  int dispatches = 0;
  double wall_ms = 0,
         cpu_ms = 0;  // of the dispatches alone; cpu: of the process, an average core's
};

// Milliseconds of wall clock, and of the process' CPU time divided by the cores: on a busy machine
// the second is what a quiet one would have taken.
class Stopwatch {
 public:
  Stopwatch();
  double wall_ms() const;
  double cpu_ms() const;

 private:
  double wall_, cpu_;
};

class TracingDevice {
 public:
  TracingDevice() : timer_(context_.device()), triangles_(context_.device()) {}

  // Replaces the list; tracers built before must be built again.
  void assign(const Triangles& triangles) { triangles_.assign(triangles); }
  void build(tracing::Tracer& tracer);
  Traced trace(const tracing::Tracer& tracer, std::span<const TracedRay> rays,
               const tracing::TraceOptions& options = {}, int budget = tracing::RayWaves::kBudget);

  const gl::DeviceInfo& device() const { return context_.device(); }
  // Of the passes of all builds since the last call.
  std::vector<gl::PassTime> pass_times();

 private:
  gl::Context context_;
  gl::ProgramCache programs_;
  gl::PassTimer timer_;
  tracing::TriangleList triangles_;
  tracing::RayWaves waves_;
};

}  // namespace panoptes::test
