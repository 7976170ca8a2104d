#include "gl/dispatch.h"

#include <algorithm>

namespace panoptes::gl {

void dispatch(uint32_t invocations, GLbitfield barriers) {
  const uint32_t groups = invocations / 64 + (invocations % 64 != 0);
  const uint32_t across = std::min(groups, 65535u);
  if (across > 0) glDispatchCompute(across, (groups + across - 1) / across, 1);
  glMemoryBarrier(barriers);
}

}  // namespace panoptes::gl
