#include "tracing/ray_waves.h"

#include "gl/dispatch.h"

#include <fmt/format.h>

namespace panoptes::tracing {

namespace {

// Rays that may wait at first; most batches have none.
constexpr uint32_t kFirstCapacity = 1024;

}  // namespace

gl::ProgramSource trace_program(const Tracer& tracer, const TraceOptions& options, RaySource from) {
  gl::ProgramSource source;
  source.name = "trace";
  source.stages = {{GL_COMPUTE_SHADER, "tracing/trace.comp"}};
  source.defines = {fmt::format("ANY_HIT {}", int(options.any_hit)),
                    fmt::format("COUNT_WORK {}", int(options.count_work)),
                    fmt::format("SURFACES {}", int(options.surfaces)),
                    fmt::format("LISTED {}", int(from == RaySource::kListed)),
                    fmt::format("RESUMED {}", int(from == RaySource::kResumed))};
  tracer.add_to(source);
  return source;
}

void RayWaves::trace(const Tracer& tracer, const TriangleList& triangles, const RayBatch& batch,
                     const TraceOptions& options, gl::ProgramCache& programs, int budget) {
  dispatches_ = 0;
  if (batch.count == 0) return;
  counter_.reserve(4);
  const int64_t record = 4 * (5 + int64_t(tracer.traversal_words()));
  const gl::Texture rays(GL_RGBA32F, *batch.rays);
  const auto reserve = [&](gl::Buffer& pending, uint32_t rays_waiting) {
    pending.reserve(rays_waiting * record);
  };
  const auto run = [&](RaySource source, uint32_t count, const gl::Buffer* from, gl::Buffer& to) {
    programs.get(trace_program(tracer, options, source)).use();
    triangles.texture().bind(kTriangleUnit);
    tracer.bind();
    rays.bind(kRayUnit);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, batch.hits->id());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, to.id());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, counter_.id());
    if (from) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, from->id());
    if (options.count_work) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 4, batch.work->id());
    counter_.clear();
    glUniform1ui(0, count);
    glUniform1ui(1, uint32_t(to.bytes() / record));
    glUniform1i(2, budget);
    gl::dispatch(count, GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                            GL_BUFFER_UPDATE_BARRIER_BIT);
    ++dispatches_;
    uint32_t waiting = 0;
    counter_.read(0, 4, &waiting);
    return waiting;
  };

  const RaySource source = batch.listed ? RaySource::kListed : RaySource::kAll;
  // What listed rays cost is added up, so none of them may start twice.
  reserve(pending_[0], batch.listed && options.count_work ? batch.count : kFirstCapacity);
  uint32_t waiting = run(source, batch.count, batch.listed, pending_[0]);
  if (waiting > uint64_t(pending_[0].bytes() / record)) {
    // Some have been counted but not saved: with room for all of them, the same rays wait again.
    reserve(pending_[0], waiting);
    waiting = run(source, batch.count, batch.listed, pending_[0]);
  }
  for (int turn = 0; waiting > 0; turn ^= 1) {
    reserve(pending_[turn ^ 1], waiting);  // no more can wait then than wait now
    waiting = run(RaySource::kResumed, waiting, &pending_[turn], pending_[turn ^ 1]);
  }
}

}  // namespace panoptes::tracing
