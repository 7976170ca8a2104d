// Phantom views: depth at low resolution from places that nobody looks from, for what neither the
// camera nor the lamps see (section 4.4.5.1).
#pragma once

#include "ambient_occlusion/settings.h"
#include "ambient_occlusion/views.h"
#include "gl/pass_timer.h"
#include "rasterize/depth_views.h"
#include "scene/scene.h"

#include <vector>

namespace panoptes::ambient_occlusion {

// The pair of Figure 4.11: two views a little behind the camera and to either side, level with it,
// which look across each other at what is `focus` metres in front of it. An orthographic camera has
// a pair of orthographic views, turned to either side about that point. All lengths are shares of
// the focus; one that no camera can have is replaced by the depth of the scene's middle.
//
// The first is on the camera's left. Where the camera stands within `bounds`, those of the scene,
// both do, since nothing is seen through the walls of a room.
std::vector<gpu_scene::LightView> phantom_pair(const gpu_scene::Camera& camera, double focus,
                                               const scene::Bounds& bounds);

// The frusta of the cameras that the artist chose instead.
std::vector<gpu_scene::LightView> phantom_cameras(const Settings& settings);

class PhantomMaps {
 public:
  // Draws depth as seen from each of `views`, with `resolution` texels along its longer side and as
  // many along the other as make them square. The sample, the seed and the alpha test are those of
  // `camera`. With `keep` the scene has not changed since the last call, so that views which were
  // drawn then are not drawn again. Overwrites the view block.
  void render(const std::vector<gpu_scene::LightView>& views, int resolution,
              const shared::View& camera, const gpu_scene::GpuScene& scene,
              gl::ProgramCache& programs, gl::PassTimer& timer, gpu_scene::ViewBlock& view_block,
              bool keep);

  // What was drawn, for shaders that look from `camera_origin` (world space, metres).
  std::vector<View> views(const glm::dvec3& camera_origin) const;
  // A layer a view; each view fills the lower left part of its layer.
  const gl::Texture& maps() const { return maps_.maps(); }
  void bind(int unit) const { maps_.bind(unit); }
  void release() { *this = PhantomMaps(); }

 private:
  rasterize::DepthViews maps_;
  std::vector<gpu_scene::LightView> drawn_;
  int resolution_ = 0;
};

}  // namespace panoptes::ambient_occlusion
