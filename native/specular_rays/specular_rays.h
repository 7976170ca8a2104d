// What mirrors and glass show, in Real-time: from each pixel and sample of the film whose surface is
// smooth enough, one path of mirror images and refractions, traced over whichever tracer there is. Not
// of the thesis, whose cache serves diffuse surfaces.
//
// A path leaves the pixel's surface by one of the lobes that it stands for, chosen by how much each
// sends to the viewer, and goes on through mirrors and glass until it meets something rough, glowing or
// the world, or has turned MOST_EVENTS times. Where it ends it is lit as the camera's pixels are: by
// the lamps' shadow maps, batch by batch while these are there, and by the light around. The list of
// paths has no order, so nothing random follows from a path's place in it.
#pragma once

#include "base/cancelled.h"
#include "gl/pass_timer.h"
#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/view.h"
#include "gpu_scene/view_block.h"
#include "plan/effect.h"
#include "rasterize/g_buffer.h"
#include "rasterize/shadow_maps.h"
#include "specular_rays/path_shared.h"
#include "specular_rays/programs.h"
#include "specular_rays/settings.h"
#include "tracing/hit_bins.h"
#include "tracing/opacity.h"
#include "tracing/tracer.h"

#include <atomic>
#include <functional>

namespace panoptes::specular_rays {

class SpecularRays {
 public:
  SpecularRays(gl::ProgramCache& programs, gl::PassTimer& timer) : programs_(programs), timer_(timer) {}

  // Prepares for a frame: allocates what the plan runs, or frees everything.
  void begin(const gpu_scene::Camera& camera, const plan::Effects& plan, const Settings& settings,
             uint32_t seed);
  bool runs() const { return runs_; }

  // One sample of a frame. The view is the one that the G-buffer was shaded with.
  struct Sample {
    uint32_t index;
    const shared::View& view;
    const rasterize::GBuffer& g_buffer;
    const gpu_scene::GpuScene& scene;
    const tracing::Tracer& tracer;
    const tracing::TriangleList& triangles;
    gpu_scene::ViewBlock& view_block;
  };
  // Follows all paths to where they end, with the light that surfaces and the world emit on the way.
  void trace(const Sample& sample, const std::atomic<bool>& cancelled);
  // Adds the light of some lamps there: `first` and those after it, while lights, faces and maps are
  // bound as rasterize/lamp_light.glsl wants them.
  void add_lamps(uint32_t first, uint32_t count, const LampOptions& options);
  // Adds the light that comes from all around, whose blocks and texels `bind` binds.
  void add_surroundings(const SurroundingsOptions& options, const std::function<void()>& bind);

  // What the rays have brought, a pixel that shows a surface; others are undefined.
  //   rgb: light that was scattered once; a: bits of path_shared.h
  const gl::Texture& direct() const { return held_.direct; }
  //   rgb: light that was scattered more often
  const gl::Texture& indirect() const { return held_.indirect; }

  // Traced since begin().
  int64_t rays() const { return rays_; }

 private:
  uint32_t select(const Sample& sample);
  void reserve(uint32_t paths);
  void describe(const Sample& sample);
  void begin_paths(const Sample& sample);
  void follow(const Sample& sample, uint32_t count, const gl::Buffer* listed);
  void fetch(const Sample& sample);
  void miss(const Sample& sample, uint32_t first, uint32_t count, uint32_t events);
  uint32_t go_on(uint32_t count, uint32_t events);
  void bind_paths() const;
  void bind_ends() const;

  gl::ProgramCache& programs_;
  gl::PassTimer& timer_;

  bool runs_ = false;
  gpu_scene::Camera camera_;
  Settings settings_;
  uint32_t seed_ = 0;
  ProgramOptions options_;
  int64_t rays_ = 0;
  uint32_t paths_ = 0, ended_ = 0;  // of the sample

  // All that is held on the GPU.
  struct Held {
    tracing::OpacityWaves opacity;
    tracing::HitBins bins;
    gpu_scene::ViewBlock list_block;
    gl::Texture direct, indirect;
    gl::Buffer frame_block, pixels, first_primitives, counters;
    // One entry a path.
    gl::Buffer rays, hits, states, records, passed, going, ended;
    gl::Texture rays_texels, states_texels, records_texels;
  };
  Held held_;
};

}  // namespace panoptes::specular_rays
