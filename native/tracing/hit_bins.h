// Sorts rays by the material that they met, so that each material's program runs over its own rays.
#pragma once

#include "gl/program.h"
#include "tracing/triangle_list.h"

#include <cstdint>
#include <vector>

namespace panoptes::tracing {

class HitBins {
 public:
  struct Rays {
    const gl::Buffer& hits;    // TracedHit, one a ray
    uint32_t count = 0;
    const gl::Buffer* listed = nullptr;  // uint: which of the rays these are; null: the first ones
    bool alpha_only = false;   // leaves out rays that met an opaque surface or nothing
  };

  // Sorts the rays of one batch by dense index of material, `materials` of them; a last bin holds
  // rays that met nothing. Waits for the GPU.
  void sort(const Rays& rays, uint32_t materials, const TriangleList& triangles,
            gl::ProgramCache& programs);

  // Numbers of rays, sorted; bin b holds counts()[b] of them from the sum of those before on.
  const gl::Buffer& sorted() const { return sorted_; }
  const std::vector<uint32_t>& counts() const { return counts_; }

 private:
  gl::Buffer bins_, sorted_;
  std::vector<uint32_t> counts_;
};

// For the validation of shaders too.
gl::ProgramSource hits_by_material_program(bool listed, bool placed, bool alpha_only);

}  // namespace panoptes::tracing
