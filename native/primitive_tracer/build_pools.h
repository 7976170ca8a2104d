// The pools that every arrangement's build fills, and their growth.
//
// A pool counts past its end and guards its writes; the counts are read back once, after the build,
// which starts again with larger pools when something did not fit. Pools keep their size for the
// next build, so geometry that moves builds in one go.
#pragma once

#include "gl/handles.h"
#include "gl/program.h"
#include "primitive_tracer/build_shared.h"

#include <cstdint>
#include <string>
#include <vector>

namespace panoptes::primitive_tracer {

// Elements that fit at first; tests choose less to see them grow.
struct PoolSizes {
  uint32_t entries = 0, blocks = 0, nodes = 0, offsets = 0, ids = 0;
};

// A first guess for so many triangles.
PoolSizes first_sizes(uint32_t triangles);

class BuildPools {
 public:
  // Work groups of 64 over x and y, with barriers for what follows.
  static void dispatch(uint32_t invocations);
  enum class Indirect { kBlocks, kEntries, kNodes, kCrowded };
  void dispatch(Indirect over) const;

  // Sets what a build begins with; a pool never shrinks. `dense` nodes exist anyhow. Rasterisation
  // stops soon after `entry_limit` entries, which have `entry_bytes` (8 or 16) each.
  void begin(const PoolSizes& at_least, uint32_t triangles, uint32_t dense, uint32_t entry_limit,
             int entry_bytes = sizeof(shared::CellEntry));
  // Binds pools and sets the uniforms that build.glsl declares, for the program in use.
  void use(const gl::Program& program) const;
  // Writes the arguments of indirect dispatches from the counts so far.
  void write_arguments(gl::ProgramCache& programs) const;
  // Reads the counts. False when something did not fit: sizes have been raised then, and the build
  // must start again.
  bool fitted();
  // Valid after fitted(): there were more entries than the limit, or as many blocks as would surely
  // have given more (build.glsl), and sizes are as they were.
  bool over_limit() const {
    return counts_.entries > entry_limit_ || counts_.blocks > entry_limit_ / 16;
  }

  // The entries as a buffer texture of whole numbers, one texel each.
  const gl::Texture& entries() const { return entries_texture_; }

  const PoolSizes& sizes() const { return sizes_; }
  const shared::BuildCounters& counts() const { return counts_; }
  int64_t bytes() const { return entries_.bytes() + blocks_.bytes() + counters_.bytes(); }

 private:
  PoolSizes sizes_;
  uint32_t triangles_ = 0, dense_ = 0, entry_limit_ = 0;
  gl::Buffer entries_, blocks_, counters_;
  gl::Texture entries_texture_;
  shared::BuildCounters counts_{};
};

}  // namespace panoptes::primitive_tracer
