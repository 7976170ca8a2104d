// The structure of chapter 7 (DIRT) as the thesis has it (section 7.3.1): six perspective views in
// the arrangement of a cube, or one camera's, divided into tiles with bounds of depth, mipmapped
// for Hi-Z, and into buckets over depth that list the triangles which cross them. Two forms of
// lists:
//
// - linked_lists: the thesis', with a fixed number of buckets and a linked list each (7.1);
// - else runs in one array, with as many buckets as a tile's triangles deserve, so that what a ray
//   passes in a tile is one run.
//
// Departures: tiles are rasterised by compute, where the thesis relies on conservative
// rasterisation (NVIDIA only, here a choice); a triangle's depths in a tile are the plane's over it
// and never less than what clipping would give; depths are whole numbers of 22 bits, since atomics
// want integers; and the traversal corrects Algorithm 2
// (shaders/primitive_tracer/cube_traverse.glsl).
//
// Passes, in order: raster_triangles and raster_blocks (entries and depth bounds), cube_bounds (a
// level at a time), then for linked lists cube_fill, else cube_buckets (how many), cube_fill
// (counts), cube_buckets (places), cube_fill (lists).
#pragma once

#include "primitive_tracer/build_pools.h"
#include "primitive_tracer/cube_shared.h"
#include "primitive_tracer/settings.h"
#include "tracing/tracer.h"

namespace panoptes::primitive_tracer {

class CubeTracer : public tracing::Tracer {
 public:
  // `first` are the sizes of pools to begin with, where not what the number of triangles suggests.
  // Throws Error where settings are out of range.
  explicit CubeTracer(const CubeSettings& settings = {}, const PoolSizes& first = {});

  void build(const tracing::TriangleList& triangles, gl::ProgramCache& programs,
             gl::PassTimer& timer) override;
  void add_to(gl::ProgramSource& source) const override;
  void bind() const override;
  uint32_t traversal_words() const override { return 8; }
  int64_t bytes() const override;

  // Of the last build.
  int tiles() const { return views_.grid.x; }
  const shared::BuildCounters& counts() const { return pools_.counts(); }
  // Bytes as Table 7.3 of the thesis divides them.
  struct Bytes {
    int64_t depth_bounds = 0;  // with their mipmaps
    int64_t buckets = 0;       // where the lists of buckets begin
    int64_t ids = 0;           // the lists
  };
  Bytes bytes_of_parts() const;
  // Tiles that list any triangle; reads the structure back.
  int64_t used_tiles() const;

 private:
  void place(const scene::Bounds& bounds, int tiles);
  void reserve();
  void run_passes(uint32_t triangles, gl::ProgramCache& programs, gl::PassTimer& timer);
  void raster(uint32_t triangles, gl::ProgramCache& programs);
  void raster_by_hardware(uint32_t triangles, gl::ProgramCache& programs);
  void link_lists(gl::ProgramCache& programs);
  void run_lists(gl::ProgramCache& programs);
  int64_t base_tiles() const;
  int64_t nodes() const;

  CubeSettings settings_;
  PoolSizes first_;
  BuildPools pools_;
  shared::CubeViews views_{};
  gl::Buffer view_block_, nodes_, ranges_, offsets_, ids_;
  gl::Framebuffer framebuffer_;   // without attachments, for raster_by_hardware()
  gl::VertexArray vertex_array_;  // without attributes
  gl::Texture node_texture_, offset_texture_, id_texture_;
};

// The programs of the build, for it and for the validation of shaders.
std::vector<gl::ProgramSource> cube_build_programs(const CubeSettings& settings);

}  // namespace panoptes::primitive_tracer
