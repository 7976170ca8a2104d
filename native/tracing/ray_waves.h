// Sends batches of rays through a tracer, in as many dispatches as the longest ray needs.
#pragma once

#include "gl/pass_timer.h"
#include "gl/program.h"
#include "tracing/tracer.h"
#include "tracing/triangle_list.h"

namespace panoptes::tracing {

// Which triangles are there for rays; those with an alpha are told by TRIANGLE_HAS_ALPHA.
enum class Surfaces { kAll, kOpaque, kAlpha };

struct TraceOptions {
  bool any_hit = false;     // whatever is met ends the ray
  bool count_work = false;  // writes RayBatch::work
  Surfaces surfaces = Surfaces::kAll;
};

// Where a program that traces takes its rays from: all of the batch, those of RayBatch::listed, or
// those that were under way.
enum class RaySource { kAll, kListed, kResumed };

// The program that traces with `tracer`; for the validation of shaders too.
gl::ProgramSource trace_program(const Tracer& tracer, const TraceOptions& options,
                                RaySource source);

// Buffers of one batch, which the caller owns.
struct RayBatch {
  const gl::Buffer* rays = nullptr;  // TracedRay
  const gl::Buffer* hits = nullptr;  // TracedHit, written
  const gl::Buffer* work = nullptr;  // TracedWork, written with count_work; may be null without
  uint32_t count = 0;                // rays to trace
  // uint: which of the rays these are; null: from the first one on. What listed rays cost is added
  // to their work, since they have mostly been on their way before.
  const gl::Buffer* listed = nullptr;
};

class RayWaves {
 public:
  // What an invocation may do at a time: llvmpipe stops one after 65 535 iterations, counted over
  // the eight rays that run together.
  static constexpr int kBudget = 7500;

  // Fills batch.hits. Rays that are not through after kBudget iterations are saved, compacted and
  // resumed until none is left.
  void trace(const Tracer& tracer, const TriangleList& triangles, const RayBatch& batch,
             const TraceOptions& options, gl::ProgramCache& programs, int budget = kBudget);

  // Dispatches of the last trace().
  int dispatches() const { return dispatches_; }

 private:
  int dispatches_ = 0;
  gl::Buffer counter_;
  gl::Buffer pending_[2];  // rays under way, as trace.comp saves them
};

}  // namespace panoptes::tracing
