// The cache's light as it was shown in the frame before, of which frames that follow keep a share, so
// that voxels which appear and vanish under moving surfaces do not flicker (thesis, section 5.3,
// "Temporal Blending").
#pragma once

#include "gl/handles.h"
#include "gl/pass_timer.h"
#include "gl/program.h"
#include "radiance_cache/geometry_volume.h"
#include "radiance_cache/names.h"

#include <vector>

namespace panoptes::radiance_cache {

class CellHistory {
 public:
  CellHistory(gl::ProgramCache& programs, gl::PassTimer& timer) : programs_(programs), timer_(timer) {}

  // This frame's cells, as look_up.glsl reads them.
  struct Frame {
    const gl::Buffer& cells;
    const gl::Texture& texels;
    Encoding encoding = Encoding::kY3Co1Cg1;
    bool split = false;
    const std::vector<Grid>& grids;
    const shared::CacheVolumes& volumes;
    const gl::Buffer& block;  // the volumes
    const gl::Buffer& list;   // numbers of the active cells that hold light
    uint32_t active = 0;
  };
  // Shows `share` (0 .. below 1) of what was shown before, where that is about the same light at the
  // same place, and the frame's own for the rest.
  void add(const Frame& frame, float share);
  // What is shown.
  const gl::Texture& texels() const { return shown_texels_; }
  void release();

 private:
  bool comparable(const Frame& frame) const;
  void blend(const Frame& frame, float share);

  gl::ProgramCache& programs_;
  gl::PassTimer& timer_;
  gl::Buffer shown_, previous_;
  gl::Texture shown_texels_, previous_texels_;
  // Of what is shown.
  Encoding encoding_ = Encoding::kY3Co1Cg1;
  bool split_ = false;
  std::vector<Grid> grids_;
  shared::CacheVolumes volumes_{};
};

gl::ProgramSource blend_program(Encoding encoding, bool split);

}  // namespace panoptes::radiance_cache
