// Which parts of a large scene a sun's shadow maps should show in detail.
//
// One map over the whole scene is the cheapest: it outlives every move of the camera. Where its texels
// are much coarser than the pixels that look at them, the parts that the camera sees get maps of their
// own, fitted to what is really visible (after Lauritzen et al. 2010), each for a range of distances.
#pragma once

#include "gl/program.h"
#include "gpu_scene/view.h"
#include "rasterize/g_buffer.h"
#include "scene/scene.h"

#include <vector>

namespace panoptes::rasterize {

// What the camera sees at distances from `nearest` to twice that.
struct Slab {
  double nearest = 0;    // metres
  scene::Bounds bounds;  // world space
  uint32_t pixels = 0;
};

// Half of the pixels that show something see it at most so far away, within an octave; 0 if none does.
double median_distance(const std::vector<Slab>& slabs);

constexpr size_t kMostCascades = 4;

// Boxes for a sun's maps, near ones first; empty where one map of the whole scene will do. `slabs`
// are ordered from near to far; `pixel` is the width of a pixel at distance 1, or at any distance for
// an orthographic camera. No GL.
std::vector<scene::Bounds> choose_cascades(const std::vector<Slab>& slabs,
                                           const scene::Bounds& scene, double pixel,
                                           bool perspective, int resolution);

gl::ProgramSource visible_bounds_program();

// Finds the slabs of what the G-buffer holds; waits for the GPU.
std::vector<Slab> visible_slabs(const GBuffer& g_buffer, const scene::Bounds& scene,
                                const glm::dvec3& camera_origin, gl::ProgramCache& programs);

}  // namespace panoptes::rasterize
