// The radiance cache: light that has left a first surface, and the world's light past what stands in
// its way, on a lattice of cells (thesis, chapter 5).
//
// Frames that follow each other keep what has not changed, and a share of the light that was shown.
//
// Once a frame, surfels of the geometry volume are lit by the lamps through their shadow maps; rays
// that were marched from the cells bring what surfels send on, and the world's light where they leave
// the scene; and surfels are lit by the cells for the next bounce. What rays meet is kept while
// geometry rests. Nothing here depends on the camera but where the volumes lie.
#pragma once

#include "film/film.h"
#include "gl/context.h"
#include "gl/pass_timer.h"
#include "gl/program.h"
#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/view.h"
#include "gpu_scene/view_block.h"
#include "plan/effect.h"
#include "radiance_cache/geometry_volume.h"
#include "radiance_cache/history.h"
#include "radiance_cache/reflective_maps.h"
#include "radiance_cache/settings.h"
#include "radiance_cache/world_light.h"
#include "rasterize/g_buffer.h"
#include "scene/scene.h"
#include "tracing/triangle_list.h"

#include <glm/glm.hpp>

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace panoptes::radiance_cache {

// What look-ups compile for.
struct LookUpOptions {
  Encoding encoding = Encoding::kY3Co1Cg1;
  bool split = false;  // world and bounced light are told apart
  bool scaled = false; // bounced light is multiplied by what the artist says; with `split`
  int unit = 0;        // texture unit of the cells
  int block = 0;       // binding of the uniform block; the scales' is the next
  bool walls = true;   // Settings::walls
  void add_defines(gl::ProgramSource& source) const;
};

// RGBA texels that a cell takes.
int cell_texels(Encoding encoding);

class RadianceCache {
 public:
  RadianceCache(gl::ProgramCache& programs, gl::PassTimer& timer)
      : programs_(programs), timer_(timer), reflective_(programs, timer), history_(programs, timer) {}

  struct Frame {
    const gpu_scene::Camera& camera;
    const plan::Effects& plan;
    const Settings& settings;
    uint32_t seed = 0;
    const scene::Scene& scene;
    const gpu_scene::GpuScene& gpu;
    WorldLight& world;                       // up to date
    // One of frames that come one after the other while the scene changes little, as in a 3D View.
    bool follows = false;
  };
  // Prepares for a frame. Releases everything if the plan does not run it.
  void begin(const Frame& frame);
  // Whether place() depends on how far away the camera sees things.
  bool looks_far() const;
  // Chooses the volumes, and makes what depends on geometry alone: once a frame, before all that
  // follows. `distance`: m, typical of what the camera sees in the picture's first sample; 0: unknown.
  // `triangles` are those of the scene of begin(); `view_block` is overwritten.
  void place(double distance, const tracing::TriangleList& triangles, const gpu_scene::GpuScene& gpu,
             gpu_scene::ViewBlock& view_block);
  void release();
  bool runs() const { return runs_; }
  Occupied occupied() const {
    return runs_ ? occupied_cells() : Occupied{};
  }

  // What an artist should know of the frame; empty if there is nothing.
  std::string warning() const;

  // Lamps light the surfels batch by batch: begin_lamps() once before them all, then add_lamps() for
  // each while its maps are there. Positions of lamps are relative to `origin`.
  struct Lamps {
    glm::dvec3 origin;
    bool shadows = false;
    float share = 1;  // of their light, where several points stand for each
    uint32_t first = 0, count = 0;
    const gl::Buffer& lights;
    const gl::Buffer& faces;
    std::function<void(int unit)> bind_maps;
  };
  // Before, in sample 0 of the picture: what the camera sees there, about `origin`. Cells may be chosen
  // by that.
  void see(const rasterize::GBuffer& g_buffer, const glm::dvec3& origin);
  void begin_lamps();
  void add_lamps(const Lamps& lamps);
  // Whether light of the first bounce comes from reflective shadow maps instead: then reflect_lamps(),
  // before gather().
  bool reflective() const { return runs_ && rsm_ && !kept_; }
  void reflect_lamps(const ReflectiveMaps::Lamps& lamps);
  // Makes the cells' light.
  void gather();
  // From here on look-ups find the light of this frame alone.
  void settle() { blended_ = false; }
  // Whether the geometry volume is that of an earlier frame, since it is not rebuilt in each.
  bool stale() const { return runs_ && stale_; }
  // Rebuilds it: then see(), lamps and gather() follow as in the picture's first sample.
  void catch_up(const tracing::TriangleList& triangles, const gpu_scene::GpuScene& gpu,
                gpu_scene::ViewBlock& view_block);

  // The side of the finest voxels, m: what stands nearer to a surface than that, rays do not meet.
  double voxel() const { return grids_.empty() ? 0 : grids_.front().cell / grids_.front().voxels; }
  // For look-ups about points relative to `origin`, by the program in use.
  LookUpOptions look_up(int unit, int block) const;
  void bind(const LookUpOptions& options, const gpu_scene::GpuScene& gpu, const glm::dvec3& origin);

  // Puts the settings' picture into the film's Combined, for a sample whose G-buffer is bound.
  void show(const LookUpOptions& options, const glm::dvec3& origin, const film::Film& film);

 private:
  // What the light depends on. Of the camera it does only in that more cells are seen.
  struct State {
    Settings settings;
    uint32_t seed = 0;
    std::vector<bool> effects;  // of the plan, whether they run
    std::vector<Grid> grids;
    std::vector<scene::Light> lights;
    std::array<int64_t, 5> revisions{};
    bool operator==(const State&) const = default;
  };
  // Cells of a kind, which look in equally many directions.
  struct Tier {
    gl::Buffer list;  // their numbers
    uint32_t cells = 0;
    int directions = 0;
    gl::Buffer met;   // by their rays, as march.comp writes it
    gl::Texture met_texels;
  };
  // All of it but the grids.
  static State state_of(const Frame& frame);
  // Whether the volume may lag behind geometry that moves.
  bool may_lag(const tracing::TriangleList& triangles) const;
  void update_volume(const tracing::TriangleList& triangles, const gpu_scene::GpuScene& gpu,
                     gpu_scene::ViewBlock& view_block);
  const gl::Texture& shown() const { return blended_ ? history_.texels() : cells_texels_; }
  void remember(float share);
  void find_seeds();
  void find_reach();
  void list_cells();
  void choose_directions();
  Occupied occupied_cells() const;
  void march();
  void march(Tier& tier);
  void bounce(bool cache);
  void gather_rays(bool bounced, bool reflected);
  void gather_rays(const Tier& tier, bool bounced, bool reflected);
  // Whether light comes from no surfaces but those that rays have met: nobody else looks at the others.
  bool met_alone() const { return occupancy_ == Occupancy::kDepth || occupancy_ == Occupancy::kTiers; }
  void bind_scales(const LookUpOptions& options, const gpu_scene::GpuScene& gpu,
                   const glm::dvec3& origin);
  void write_block(gl::Buffer& block, const glm::dvec3& origin) const;
  void bind_lattice(int location) const;
  void bind_volume() const;

  gl::ProgramCache& programs_;
  gl::PassTimer& timer_;
  bool runs_ = false, split_ = false, scaled_ = false, world_light_ = false, lamps_ = false,
       rsm_ = false;
  int bounces_ = 0;
  Settings settings_;
  uint32_t seed_ = 0;
  WorldLight* world_ = nullptr;
  std::vector<Grid> grids_;
  bool whole_ = false;  // the last of them holds the scene
  glm::dvec3 list_origin_{0};
  GeometryVolume volume_;
  // With Occupancy::kTiers the first holds the cells that are seen and the second the others, which look in
  // fewer directions; otherwise the first holds all.
  std::array<Tier, 2> tiers_;
  gl::Buffer seeds_, contents_, reach_, met_sides_, radiosity_, direct_, cells_;
  gl::Texture seeds_texels_, reach_texels_, met_sides_texels_, radiosity_texels_, cells_texels_;
  gl::Buffer list_block_, view_block_, scales_block_;  // CacheVolumes about the list's origin, and about the camera
  Occupancy occupancy_ = Occupancy::kGeometry;  // never kAuto
  bool transmission_ = false;
  bool reached_ = false;            // reach_ is that of the volume
  std::vector<Grid> reach_grids_;   // that reach_ and contents_ are of
  ReflectiveMaps reflective_;

  CellHistory history_;
  State state_, next_;        // of the cells' light; of the frame
  gpu_scene::Camera camera_;
  scene::Bounds bounds_;
  double distance_ = 0;       // that the volumes were chosen by
  bool follows_ = false;
  bool lit_ = false;      // cells hold the light of state_
  bool kept_ = false;     // they did when the frame began, and nobody has seen any others since
  bool blended_ = false;  // what is shown has a share of earlier frames
  bool stale_ = false;
  int lag_ = 0;           // frames that the volume is behind
};

gl::ProgramSource find_seeds_program();
gl::ProgramSource find_reach_program();
gl::ProgramSource mark_seen_program();
gl::ProgramSource list_cells_program(Occupancy occupancy, bool dilate);
gl::ProgramSource march_program(int steps, bool walls, bool mark_met);
struct GatherOptions {
  Encoding encoding = Encoding::kY3Co1Cg1;
  bool split = false, world = false, bounced = false;
  bool reflected = false;  // by what reflective shadow maps show
};
gl::ProgramSource gather_program(const GatherOptions& options);
// `met_alone`: of surfels that rays have met.
gl::ProgramSource bounce_program(const LookUpOptions& options, bool lamps, bool cache, bool met_alone);
gl::ProgramSource light_surfels_program(bool shadows, bool met_alone);
gl::ProgramSource picture_program(Picture picture, const LookUpOptions& options,
                                  const film::Film& film);

}  // namespace panoptes::radiance_cache
