// Integrator 2: unidirectional path tracing over any tracer, wave by wave (thesis, section 7.2.4):
// rays are traced, what they met is fetched by one program a material, and all of it is shaded by one
// program that knows no material, until no path is left. Of a path's surfaces only the last, the
// present and the next one are known at any time.
//
// Lamps, glowing triangles and the world are sampled wherever paths turn, and met by paths that go
// their way; multiple importance sampling weighs the two.
#pragma once

#include "film/film.h"
#include "gl/context.h"
#include "gl/pass_timer.h"
#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/view.h"
#include "gpu_scene/view_block.h"
#include "path_tracer/lights.h"
#include "path_tracer/map_shadows.h"
#include "path_tracer/programs.h"
#include "path_tracer/raster_primary.h"
#include "path_tracer/settings.h"
#include "plan/effect.h"
#include "tracing/hit_bins.h"
#include "tracing/opacity.h"
#include "tracing/tracer.h"

#include <atomic>

namespace panoptes::path_tracer {

// What a frame's paths are traced through; all of it as the scene is now.
struct Surroundings {
  const gpu_scene::GpuScene& scene;
  const tracing::Tracer& tracer;
  const tracing::TriangleList& triangles;
};

struct FrameSettings {
  Settings paths;
  uint32_t seed = 0;
  float filter_width = 1.5f;      // pixels, of the Blackman-Harris window to each side
  bool transparent_film = false;  // the world behind the scene is not part of Combined
  int shadow_resolution = 2048;   // of maps, texels a side
};

class PathTracer {
 public:
  PathTracer(const gl::DeviceInfo& device, gl::ProgramCache& programs, gl::PassTimer& timer)
      : device_(device), programs_(programs), timer_(timer), lights_(device),
        map_shadows_(device) {}

  // Prepares for a frame of these passes (completed by what they are divided by): lists the lights and
  // compiles the programs of all materials.
  void begin(const gpu_scene::Camera& camera, const plan::Effects& plan,
             const FrameSettings& settings, const scene::Scene& scene,
             gpu_scene::GpuScene& gpu, const tracing::TriangleList& triangles,
             const film::PassSet& passes);

  // Adds sample `index` to the film; `first`: it is the first of its picture. Throws Cancelled when
  // `cancelled` says so.
  void render_sample(uint32_t index, bool first, const Surroundings& around, film::Film& film,
                     const std::atomic<bool>& cancelled);

  // True while the film holds a part of a sample's pixels, after it was cancelled.
  bool torn() const { return torn_; }
  // What of the lights could not be done as asked, for the artist.
  const std::vector<std::string>& warnings() const { return lights_.warnings(); }
  // Rays of all samples since begin(), those of shadows among them.
  int64_t rays() const { return rays_; }
  // Frees what paths need.
  void release();

 private:
  void describe_frame(const scene::Bounds& bounds);
  void reserve(uint32_t paths);
  void begin_paths(uint32_t count, bool centre, const shared::View& view, const film::Film& film);
  void trace_paths(uint32_t count, const Surroundings& around, const std::atomic<bool>& cancelled);
  void set_list_view();
  shared::View camera_view(uint32_t index) const;
  void trace(uint32_t count, const gl::Buffer* listed, float threshold, const Surroundings& around);
  void fetch(const Surroundings& around);
  void miss(uint32_t first, uint32_t count, const Surroundings& around);
  struct Sent {
    uint32_t paths = 0, shadow_rays = 0, lit = 0;  // lit: reached by light without a shadow ray
  };
  // Sends paths on from the surfaces that they met.
  Sent shade(uint32_t count, uint32_t depth);
  void trace_shadows(uint32_t count, const Surroundings& around);
  void bind_arrivals(const gl::Buffer& listed) const;
  void arrive(uint32_t count, bool traced);
  void arrive_deferred(const Surroundings& around);
  void ambient_occlusion(uint32_t count, const Surroundings& around);
  void write_depth(uint32_t count, const Surroundings& around, film::Film& film);
  void resolve(uint32_t count, film::Film& film);
  void set_frame(uint32_t index, uint32_t first_pixel, uint32_t count);

  gl::DeviceInfo device_;
  gl::ProgramCache& programs_;
  gl::PassTimer& timer_;

  gpu_scene::Camera camera_;
  FrameSettings settings_;
  ProgramOptions options_;
  glm::dvec3 list_origin_{0};
  shared::PathFrame frame_{};
  bool depth_passes_ = false;
  Lights lights_;
  int64_t rays_ = 0;
  bool torn_ = false;

  gpu_scene::ViewBlock camera_block_, list_block_;
  RasterPrimary raster_;
  MapShadows map_shadows_;
  gl::Buffer frame_block_, filter_buffer_;
  gl::Texture filter_offsets_;
  tracing::OpacityWaves opacity_;
  tracing::HitBins bins_;

  // One entry a path.
  gl::Buffer rays_buffer_, hits_, states_, passed_, records_, sums_;
  gl::Buffer shadow_rays_, shadow_hits_, shadow_passed_, arrivals_, shares_;
  gl::Buffer going_, shadow_list_, lit_list_, deferred_, counters_;
  gl::Texture rays_texels_, hits_texels_, states_texels_, passed_texels_, records_texels_,
      sums_texels_;
};

}  // namespace panoptes::path_tracer
