// The structure of chapter 7 (DIRT) in its fastest arrangement: one orthographic view along the
// shortest axis of the scene's box, divided into tiles, crowded tiles into parts, and each of these
// into buckets over depth that list the triangles which cross it.
//
// It departs from the thesis (section 7.3.1) where measurement said so. There is no centre, so the
// structure outlives every move of the camera. Hi-Z's minimum and maximum of depth are a mask of 64
// slices, OR-ed up the pyramid, which also sees gaps between surfaces. Lists are runs in one array,
// not linked, with as many buckets as a node's triangles deserve, so that what a ray passes in a
// node is one run. Hits are never rejected by tile (Algorithm 2, line 14) nor is a search ended by
// the first hit (line 18): a ray stops where the next cell begins behind its closest hit.
//
// Passes, in order: density (triangles a tile), divide (crowded tiles), raster_triangles and
// raster_blocks (to count a node's triangles), begin_lists, both again (to list them),
// order_lists (by length), sort_lists (into buckets), gather and pyramid (masks).
#pragma once

#include "primitive_tracer/build_pools.h"
#include "primitive_tracer/orthographic_shared.h"
#include "primitive_tracer/settings.h"
#include "tracing/tracer.h"

namespace panoptes::primitive_tracer {

class OrthographicTracer : public tracing::Tracer {
 public:
  // `first` are the sizes of pools to begin with, where not what the number of triangles suggests.
  explicit OrthographicTracer(const OrthographicSettings& settings = {}, const PoolSizes& first = {});

  void build(const tracing::TriangleList& triangles, gl::ProgramCache& programs,
             gl::PassTimer& timer) override;
  void add_to(gl::ProgramSource& source) const override;
  void bind() const override;
  uint32_t traversal_words() const override { return 8; }
  int64_t bytes() const override;

  // Of the last build.
  int tiles() const { return view_.grid.y; }
  const shared::BuildCounters& counts() const { return pools_.counts(); }

 private:
  void place(const scene::Bounds& bounds, int tiles);
  void run_passes(uint32_t triangles, gl::ProgramCache& programs, gl::PassTimer& timer);
  void reserve();

  OrthographicSettings settings_;
  PoolSizes first_;
  BuildPools pools_;
  shared::OrthographicView view_{};
  gl::Buffer view_block_, nodes_, lists_, order_, offsets_, ids_;
  gl::Texture node_texture_, offset_texture_, id_texture_;
};

// The programs of the build, for it and for the validation of shaders.
std::vector<gl::ProgramSource> orthographic_build_programs();

}  // namespace panoptes::primitive_tracer
