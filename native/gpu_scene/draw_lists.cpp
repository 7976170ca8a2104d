#include "gpu_scene/draw_lists.h"

#include "gpu_scene/placement.h"

#include <algorithm>

namespace panoptes::gpu_scene {

namespace {

// As glMultiDrawElementsIndirect reads it.
struct DrawCommand {
  uint32_t count, instance_count, first_index, base_vertex, base_instance;
};

}  // namespace

void DrawLists::update(const std::map<uint32_t, Audience>& lists) {
  // Room is given back before others ask for it.
  std::erase_if(lists_, [&](const auto& item) {
    if (lists.count(item.first)) return false;
    for (const Part& part : item.second) ranges_.release(part.range);
    return true;
  });
  for (const auto& [material, audience] : lists) {
    std::array<Part, 3>& parts = lists_[material];
    for (size_t i = 0; i < parts.size(); ++i) update_part(parts[i], audience[i]);
  }
}

void DrawLists::update_part(Part& part, const std::vector<Draw>& draws) {
  const uint32_t count = uint32_t(draws.size());
  if (count > part.range.count) {
    // Room for a quarter more, so that a list that grows does not move each time.
    ranges_.release(part.range);
    part.range = ranges_.allocate_or_grow(count + count / 4 + 8);
  }
  place(draws, part.draws);
  for (uint32_t i = 0; i < count; ++i) {
    const Draw& draw = part.draws[i];
    const uint32_t at = part.range.first + i;
    records_.write(at, shared::DrawRecord{draw.instance, draw.material, draw.first_triangle, at});
    commands_.write(at, DrawCommand{draw.index_count, 1, draw.first_index, draw.base_vertex, at});
  }
}

void DrawLists::flush() {
  records_.flush();
  commands_.flush();
}

void DrawLists::bind(const gl::VertexArray& array) const {
  glVertexArrayVertexBuffer(array.id(), 1, records_.buffer().id(), 0, sizeof(shared::DrawRecord));
  glVertexArrayBindingDivisor(array.id(), 1, 1);
  glVertexArrayAttribIFormat(array.id(), 1, 4, GL_UNSIGNED_INT, 0);
  glVertexArrayAttribBinding(array.id(), 1, 1);
  glEnableVertexArrayAttrib(array.id(), 1);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands_.buffer().id());
}

void DrawLists::draw_part(const Part& part) const {
  if (part.draws.empty()) return;
  glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT,
                              reinterpret_cast<const void*>(size_t(part.range.first) *
                                                            sizeof(DrawCommand)),
                              GLsizei(part.draws.size()), 0);
}

}  // namespace panoptes::gpu_scene
