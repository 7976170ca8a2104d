// The geometry volume (thesis, section 5.5): the scene in voxels, and one point of a surface, a
// surfel, in each voxel that is solid.
//
// Binary voxelisation as the thesis has it, after Eisemann and Decoret (2006), sets a voxel that a
// triangle touches, which closes small gaps and leaves too little light. Here the area of surface in a
// voxel is summed exactly, and decides. Triangles are rasterised along the axis to which they are
// closest in compute shaders, into words of 32 voxels along x: of any number, not 128.
#pragma once

#include "gl/pass_timer.h"
#include "gpu_scene/view_block.h"
#include "radiance_cache/volume_shared.h"
#include "tracing/hit_bins.h"
#include "tracing/triangle_list.h"

#include <span>
#include <vector>

namespace panoptes::radiance_cache {

// A box of cubic cells, world space, metres.
struct Grid {
  glm::dvec3 low{0};     // lowest corner
  double cell = 1;       // side of a cell
  glm::ivec3 cells{1};   // along each axis
  int voxels = 4;        // along a cell's side
  bool operator==(const Grid&) const = default;
};

// Voxels of all grids together, in rows of whole words: what one storage block holds on every driver.
constexpr int64_t kMostVoxels = int64_t(1) << 24;

class GeometryVolume {
 public:
  // Makes what has changed: all if shapes, places or grids (at most MOST_CASCADES) are others, surfels
  // if only materials are. A voxel is solid if its surfaces' area is at least `fill` faces of it; 0:
  // if anything lies in it. Surfaces that diffuse rays do not see are not there, and what light
  // passes, by alpha or transmission, is there by chance. `triangles` must be up to date with `gpu`.
  // Another view is set in `view_block` afterwards. True if anything was made. Throws Error when there
  // are more than kMostVoxels.
  bool update(std::span<const Grid> grids, float fill, const tracing::TriangleList& triangles,
              const gpu_scene::GpuScene& gpu, gpu_scene::ViewBlock& view_block,
              gl::ProgramCache& programs, gl::PassTimer& timer);
  // Gives all memory back.
  void release() { *this = GeometryVolume(); }

  // As shaders/radiance_cache/volume.glsl reads them: a uniform block, RG32UI buffer texture with one
  // texel a word, RGBA32UI with two texels a surfel.
  const gl::Buffer& block() const { return block_; }
  const gl::Texture& words() const { return word_texture_; }
  const gl::Texture& surfels() const { return surfel_texture_; }
  // uvec2 a word; Surfel.
  const gl::Buffer& word_buffer() const { return words_; }
  const gl::Buffer& surfel_buffer() const { return surfels_; }
  // What the block holds.
  const shared::CacheVolumes& volumes() const { return volumes_; }
  uint32_t word_count() const { return word_count_; }
  // Solid voxels, each with a surfel.
  uint32_t solid() const { return solid_; }

 private:
  struct Frame;  // what stays the same during an update()
  void place(std::span<const Grid> grids, const glm::vec3& origin);
  void voxelize(const Frame& frame);
  void run_triangles(const Frame& frame);
  void make_surfels(const Frame& frame);
  void evaluate(const Frame& frame);
  void number_words();

  std::vector<Grid> grids_;
  float fill_ = 0;
  int64_t geometry_revision_ = -1, surface_revision_ = -1;
  shared::CacheVolumes volumes_{};
  glm::ivec3 lattice_[MOST_CASCADES] = {};
  uint32_t word_count_ = 0, contender_count_ = 0, candidates_ = 0, solid_ = 0;
  gl::Buffer block_, words_, surfels_;
  gl::Texture word_texture_, surfel_texture_;
  // Of voxelisation, kept until shapes change: area and key of voxels, bits before any vanished, and
  // the solid voxels among them with who was drawn for each.
  gl::Buffer voxels_, large_, contenders_, bits_, listed_, winners_;
  gl::Texture voxel_texture_, bit_texture_;
  gl::Buffer drafts_, hits_;
  tracing::HitBins bins_;
};

// The programs, for the validation of shaders too.
std::vector<gl::ProgramSource> volume_programs();
gl::ProgramSource surfels_program(const gpu_scene::GpuMaterial& material);

}  // namespace panoptes::radiance_cache
