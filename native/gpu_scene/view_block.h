// The uniform block that every shader reads its view from (gpu_scene/view_shared.h).
#pragma once

#include "gl/handles.h"
#include "gpu_scene/view_shared.h"

namespace panoptes::gpu_scene {

class ViewBlock {
 public:
  // Uploads `view` and binds the block for all programs.
  void set(const shared::View& view);

 private:
  gl::Buffer buffer_;
};

}  // namespace panoptes::gpu_scene
