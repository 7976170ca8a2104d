// A debug picture: what the rays through the pixels' centres cost on their way to the closest
// surface, opaque or not, in false colours. It is written to Combined, scene-linear and opaque.
//
// Numbers are shown by their logarithm, in colours that change linearly with log2(1 + n) between
//
//     black 0, blue 3, cyan 15, green 63, yellow 255, red 1023, white from 4095 on,
//
// and cells each in a colour of their own, black where no list was met. Passes: camera rays, trace
// (tracing/ray_waves.h), false colour; in batches of pixels, so that memory is bounded.
#pragma once

#include "film/film.h"
#include "gpu_scene/view.h"
#include "gpu_scene/view_block.h"
#include "ray_picture/kind.h"
#include "tracing/ray_waves.h"

#include <atomic>

namespace panoptes::ray_picture {

class RayPicture {
 public:
  // Adds the picture to `film`, as one sample. Throws Cancelled when `cancelled` says so.
  void render(const gpu_scene::Camera& camera, Kind kind, const tracing::Tracer& tracer,
              const tracing::TriangleList& triangles, film::Film& film,
              gl::ProgramCache& programs, gl::PassTimer& timer,
              const std::atomic<bool>& cancelled);
  // Frees all that render() allocated.
  void release();

 private:
  gpu_scene::ViewBlock view_block_;
  tracing::RayWaves waves_;
  gl::Buffer rays_, hits_, work_;
};

// For the validation of shaders too.
gl::ProgramSource camera_rays_program();
gl::ProgramSource false_colour_program(Kind kind, const film::Film& film);

}  // namespace panoptes::ray_picture
