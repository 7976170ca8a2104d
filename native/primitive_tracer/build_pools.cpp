#include "primitive_tracer/build_pools.h"

#include "base/error.h"
#include "gl/dispatch.h"

#include <algorithm>
#include <cstddef>

namespace panoptes::primitive_tracer {

namespace {

// What a buffer texture over a pool may address, and what 32-bit counts leave room for.
uint64_t most_elements() {
  GLint texels = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels);
  return std::min<uint64_t>(uint64_t(texels), 1u << 30);
}

// Makes room for `count` and a quarter more, so that geometry which moves seldom grows the pool.
void raise(uint32_t& size, uint64_t count, const char* what) {
  if (count <= size) return;
  const uint64_t most = most_elements();
  if (count > most)
    fail("the structure for ray tracing would need {} {}, and this graphics driver holds {}: hide or "
         "simplify objects",
         count, what, most);
  size = uint32_t(std::min(count + count / 4, most));
}

}  // namespace

PoolSizes first_sizes(uint32_t triangles) {
  // About what the shared scenes need; what is missing is found out by the first build.
  const uint32_t n = std::min(triangles, 1u << 27);
  return {.entries = 2 * n + 4096,
          .blocks = n / 16 + 4096,
          .nodes = n / 2 + 4096,
          .offsets = 4 * n + 16384,
          .ids = 3 * n + 16384};
}

void BuildPools::dispatch(uint32_t invocations) {
  gl::dispatch(invocations, GL_SHADER_STORAGE_BARRIER_BIT);
}

void BuildPools::dispatch(Indirect over) const {
  const size_t offsets[] = {offsetof(shared::BuildCounters, dispatch_blocks),
                            offsetof(shared::BuildCounters, dispatch_entries),
                            offsetof(shared::BuildCounters, dispatch_nodes),
                            offsetof(shared::BuildCounters, dispatch_crowded)};
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, counters_.id());
  glDispatchComputeIndirect(GLintptr(offsets[size_t(over)]));
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void BuildPools::begin(const PoolSizes& at_least, uint32_t triangles, uint32_t dense,
                       uint32_t entry_limit, int entry_bytes) {
  sizes_.entries = std::max(sizes_.entries, at_least.entries);
  sizes_.blocks = std::max(sizes_.blocks, at_least.blocks);
  sizes_.nodes = std::max(sizes_.nodes, at_least.nodes);
  sizes_.offsets = std::max(sizes_.offsets, at_least.offsets);
  sizes_.ids = std::max(sizes_.ids, at_least.ids);
  triangles_ = triangles;
  dense_ = dense;
  entry_limit_ = entry_limit;
  if (entries_.reserve(int64_t(sizes_.entries) * entry_bytes))
    entries_texture_ = gl::Texture(entry_bytes == 8 ? GL_RG32UI : GL_RGBA32UI, entries_);
  blocks_.reserve(int64_t(sizes_.blocks) * int64_t(sizeof(shared::RasterBlock)));
  counters_.reserve(sizeof(shared::BuildCounters));
  counters_.clear();
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void BuildPools::use(const gl::Program& program) const {
  program.use();
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, entries_.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, blocks_.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, counters_.id());
  glUniform1ui(0, triangles_);
  glUniform2ui(1, sizes_.entries, sizes_.blocks);
  glUniform4ui(2, dense_, sizes_.nodes, sizes_.offsets, sizes_.ids);
  glUniform1ui(4, entry_limit_);
}

void BuildPools::write_arguments(gl::ProgramCache& programs) const {
  gl::ProgramSource source;
  source.name = "arguments of the structure's passes";
  source.stages = {{GL_COMPUTE_SHADER, "primitive_tracer/arguments.comp"}};
  use(programs.get(source));
  glDispatchCompute(1, 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

bool BuildPools::fitted() {
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  counters_.read(0, sizeof counts_, &counts_);
  if (over_limit()) return false;
  const PoolSizes before = sizes_;
  raise(sizes_.entries, counts_.entries, "entries of triangles in cells");
  raise(sizes_.blocks, counts_.blocks, "blocks of large triangles");
  raise(sizes_.nodes, counts_.nodes, "divided cells");
  raise(sizes_.offsets, counts_.offsets, "buckets");
  raise(sizes_.ids, counts_.ids, "triangles in buckets");
  return sizes_.entries == before.entries && sizes_.blocks == before.blocks &&
         sizes_.nodes == before.nodes && sizes_.offsets == before.offsets &&
         sizes_.ids == before.ids;
}

}  // namespace panoptes::primitive_tracer
