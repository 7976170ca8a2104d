#include "radiance_cache/history.h"

#include "gl/dispatch.h"
#include "radiance_cache/bindings.h"
#include "radiance_cache/radiance_cache.h"

#include <array>

namespace panoptes::radiance_cache {

void CellHistory::release() {
  for (gl::Texture* texture : {&shown_texels_, &previous_texels_}) *texture = gl::Texture();
  for (gl::Buffer* buffer : {&shown_, &previous_}) *buffer = gl::Buffer();
  grids_.clear();
}

void CellHistory::add(const Frame& frame, float share) {
  const bool known = comparable(frame);
  std::swap(shown_, previous_);
  std::swap(shown_texels_, previous_texels_);
  const int64_t bytes = int64_t(frame.volumes.count.y) * cell_texels(frame.encoding) *
                        (frame.split ? 2 : 1) * 16;
  if (shown_.reserve(bytes)) shown_texels_ = gl::Texture(GL_RGBA32F, shown_);
  glCopyNamedBufferSubData(frame.cells.id(), shown_.id(), 0, 0, bytes);
  if (known && share > 0) blend(frame, share);
  encoding_ = frame.encoding;
  split_ = frame.split;
  grids_ = frame.grids;
  volumes_ = frame.volumes;
}

bool CellHistory::comparable(const Frame& frame) const {
  if (!shown_ || encoding_ != frame.encoding || split_ != frame.split ||
      grids_.size() != frame.grids.size())
    return false;
  for (size_t v = 0; v < grids_.size(); ++v)
    if (grids_[v].cell != frame.grids[v].cell || grids_[v].voxels != frame.grids[v].voxels) return false;
  return true;
}

void CellHistory::blend(const Frame& frame, float share) {
  if (frame.active == 0) return;
  gl::PassScope scope(timer_, "radiance_cache_blend");
  // Corners of grids lie on a lattice, so that they are whole cells apart.
  std::array<glm::ivec4, MOST_CASCADES> moved{}, before{};
  for (size_t v = 0; v < grids_.size(); ++v) {
    const glm::dvec3 cells = glm::round((frame.grids[v].low - grids_[v].low) / grids_[v].cell);
    const glm::dvec3 none(grids_[v].cells);  // farther than that all cells are new
    moved[v] = {glm::ivec3(glm::clamp(cells, -2.0 * none, none)), volumes_.volumes[v].first.z};
    before[v] = {grids_[v].cells, 0};
  }
  programs_.get(blend_program(frame.encoding, frame.split)).use();
  frame.texels.bind(0);
  previous_texels_.bind(1);
  glBindBufferBase(GL_UNIFORM_BUFFER, kCellsBlock, frame.block.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, frame.list.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, shown_.id());
  glUniform1ui(0, frame.active);
  glUniform1f(1, share);
  glUniform4iv(2, MOST_CASCADES, &moved[0][0]);
  glUniform4iv(2 + MOST_CASCADES, MOST_CASCADES, &before[0][0]);
  gl::dispatch(frame.active, GL_TEXTURE_FETCH_BARRIER_BIT);
}

}  // namespace panoptes::radiance_cache
