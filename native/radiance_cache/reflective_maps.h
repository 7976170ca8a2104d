// The first bounce by reflective shadow maps, as the thesis has it (section 5.2, (5.1) to (5.3)): what
// a lamp sees first are the surfaces that send its light on, and each texel of its map is a small lamp.
//
// One map is there at a time: it is drawn, cells take samples of it, and the next one takes its place.
// Departures: samples of the window of (5.3) alone lose all light from outside it, so half of them
// may come from the whole map, weighted by the balance heuristic. Each lamp (and all glowing meshes
// together) has its own samples, shared by the faces of its map.
//
// 1 / d^2 has no bound of its own: d counts as half a cell at least. From a height h < 1/2 above a lit
// plane, in cells, 4 h - 4 h^2 of its light is left (all of it from there on): of what a cell sees of a floor
// that bounds it 1/6 is lost. Without the bound nothing would be lost, and few samples would outshine
// all others.
// A map shows what a lamp sees first, so light of lamps without shadows stops there too.
#pragma once

#include "gl/pass_timer.h"
#include "gl/program.h"
#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/view_block.h"
#include "radiance_cache/settings.h"
#include "rasterize/g_buffer.h"
#include "rasterize/shadow_maps.h"

#include <glm/glm.hpp>

#include <atomic>
#include <functional>
#include <vector>

namespace panoptes::radiance_cache {

// Points of the unit square: Halton's sequence by 2 and 3, from its second point on. No GL.
std::vector<glm::vec2> halton_points(int count);

class ReflectiveMaps {
 public:
  ReflectiveMaps(gl::ProgramCache& programs, gl::PassTimer& timer)
      : programs_(programs), timer_(timer) {}

  // Lamps of a sample. Each has to have the views of a shadow map; suns have one, of the whole scene.
  struct Lamps {
    const rasterize::LightSet& set;
    glm::dvec3 origin;           // that they were placed relative to
    const shared::View& camera;  // whose sample, alpha test and levels of textures hold here too
    const gpu_scene::GpuScene& gpu;
    gpu_scene::ViewBlock& view_block;  // overwritten
    const std::atomic<bool>& cancelled;
  };
  // The cells that take the light.
  struct Cells {
    uint32_t count = 0;
    glm::dvec3 origin;       // of positions in the geometry volume
    uint32_t longest_march = 1;  // voxels that a ray may pass
    uint32_t seed = 0;
    // Binds the geometry volume, the list (storage block 0), seeds (unit 0) and, to the program in
    // use, the lattice of cells (location 1).
    std::function<void()> bind;
  };
  // Makes light() what of the lamps' light arrives at the cells after its first bounce. Throws
  // Cancelled.
  void update(const Lamps& lamps, const Cells& cells, const Settings& settings);
  void release();
  // GL_RGBA32F: nine coefficients of radiance for each cell of the list.
  const gl::Texture& light() const { return light_texels_; }
  const gl::Buffer& light_buffer() const { return light_; }

 private:
  // `number`: of the view, among those of all lamps, from 1 on.
  void draw(const Lamps& lamps, uint32_t lamp, const gpu_scene::LightView& view, uint32_t number,
            const Cells& cells);
  void gather(const gpu_scene::LightView& view, uint32_t samples, uint32_t number,
              const Cells& cells, const Settings& settings);
  void store_points(int count);

  gl::ProgramCache& programs_;
  gl::PassTimer& timer_;
  int resolution_ = 0;
  rasterize::GBuffer g_buffer_;
  gl::Buffer lights_, places_, flux_, points_, light_;
  gl::Texture places_texels_, flux_texels_, points_texels_, light_texels_;
};

// The programs, for the validation of shaders too.
gl::ProgramSource rsm_surfaces_program(const gpu_scene::GpuMaterial& material);
gl::ProgramSource rsm_gather_program(bool mixed, int march_steps, bool walls);

}  // namespace panoptes::radiance_cache
