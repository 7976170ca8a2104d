// Depth of the scene from any number of views, in the layers of one array: shadow maps, and views
// that ambient occlusion adds.
#pragma once

#include "gl/program.h"
#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/view.h"
#include "gpu_scene/view_block.h"

#include <glm/glm.hpp>

namespace panoptes::rasterize {

class DepthViews {
 public:
  // (Re)allocates when the size differs or layers are missing; true if so: what was drawn is lost.
  bool resize(int width, int height, int layers);

  // Draws into the lower left `texels` of a layer what casts shadows, as seen `from`; depth is
  // reversed, and 0 where nothing is. The sample, the seed, the alpha test and the textures'
  // levels are those of `camera`; random thresholds are those of view number `number`, which no
  // other view of the sample has (shared::View::alpha.y). Overwrites the view block.
  void draw(int layer, const gpu_scene::LightView& from, glm::ivec2 texels, float number,
            const shared::View& camera, const gpu_scene::GpuScene& scene,
            gl::ProgramCache& programs, gpu_scene::ViewBlock& view_block) const;

  // The array, for the texture unit `unit`, and a sampler that reads texels as they are.
  void bind(int unit) const;
  void release() { *this = DepthViews(); }

  const gl::Texture& maps() const { return maps_; }

 private:
  gl::Texture maps_;
  gl::Framebuffer framebuffer_;
  gl::Sampler sampler_;
};

}  // namespace panoptes::rasterize
