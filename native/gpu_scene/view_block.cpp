#include "gpu_scene/view_block.h"

namespace panoptes::gpu_scene {

void ViewBlock::set(const shared::View& view) {
  if (!buffer_) buffer_ = gl::Buffer(sizeof(view));
  buffer_.write(0, sizeof(view), &view);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, buffer_.id());
}

}  // namespace panoptes::gpu_scene
