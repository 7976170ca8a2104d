// Rays through surfaces that let some light pass straight on: leaves cut out by an image, veils.
//
// Materials say how opaque they are where a ray meets them, which only their own programs can tell.
// So rays are traced to their next surface; those that met one with an alpha are sorted by its
// material; each material's program runs over its own rays, since on llvmpipe a branch skips no
// arithmetic; and the rays that pass go on behind the surface, until none is left. A scene without
// such materials is traced as if this was not here.
//
// Whether a surface stops a ray is a matter of chance, by the ray's seed and the primitive: it does
// not depend on the order in which things run. Layers at the same t are met in the order of their
// primitives, each once (rays_shared.h).
#pragma once

#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/view_block.h"
#include "tracing/hit_bins.h"
#include "tracing/ray_waves.h"

namespace panoptes::tracing {

enum class OpacityMode {
  kClosest,        // hits are the closest surfaces that stop their rays
  kAnyHit,         // hits are any of these: is there one?
  kTransmittance,  // nothing is left to chance: what passes all surfaces, as a colour
};

// A batch of rays, which are changed: those that pass a surface begin there.
struct OpacityBatch : RayBatch {
  // vec4, a ray; with kTransmittance always, with kClosest if wanted.
  //   rgb: kTransmittance: written, what passes, 0 where an opaque surface is met. Rays that nothing
  //     stops have no hit, whatever they have lost on their way. kClosest: multiplied by the colour
  //     of each surface that is passed, over the luminance that it is passed by, so that
  //     many rays together have the colours right.
  //   a: the surfaces passed, counted on.
  const gl::Buffer* passed = nullptr;
  uint32_t most_layers = ~0u;  // a ray that has passed so many, by `passed`, stops at the next
  float threshold = -1;        // what has a lower alpha is passed; below 0: by chance
};

class OpacityWaves {
 public:
  // Fills batch.hits. `triangles` are those of `scene`, as it is now.
  void trace(const Tracer& tracer, const TriangleList& triangles, const gpu_scene::GpuScene& scene,
             const OpacityBatch& batch, OpacityMode mode, bool count_work,
             gl::ProgramCache& programs);

  // Of the last trace(): how often rays went on, and the rays traced with all who did.
  int rounds() const { return rounds_; }
  int64_t rays() const { return rays_; }

 private:
  struct Frame;  // what stays the same during a trace()
  void run_waves(const Frame& frame, Surfaces surfaces, uint32_t count, const gl::Buffer* listed);
  uint32_t list_open(const Frame& frame);
  // Evaluates the surfaces of the rays in bins_ and lists those that pass in list_; their number.
  uint32_t decide(const Frame& frame);

  RayWaves waves_;
  gpu_scene::ViewBlock view_block_;
  HitBins bins_;     // of rays that met a surface with an alpha
  gl::Buffer counter_;
  gl::Buffer list_;  // numbers of the rays that go on
  int rounds_ = 0;
  int64_t rays_ = 0;
};

// The programs, for the validation of shaders too.
gl::ProgramSource open_rays_program(bool listed, bool transmittance);
struct OpacityOptions {
  bool transmittance = false;  // as in the mode
  bool weighted = false;       // `passed` is kept: with transmittance always
};
gl::ProgramSource opacity_program(const gpu_scene::GpuMaterial& material,
                                  const OpacityOptions& options);

}  // namespace panoptes::tracing
