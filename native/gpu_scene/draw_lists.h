// What is drawn, as indirect commands in lists that a view draws with one call each: opaque
// surfaces together, those of each material that may discard fragments by themselves, and each of
// these by who sees them. Records keep their places while lists change around them.
#pragma once

#include "gpu_scene/mirrored_buffer.h"
#include "gpu_scene/view_shared.h"

#include <array>
#include <map>
#include <vector>

namespace panoptes::gpu_scene {

// Whose view is drawn: instances may be hidden from the camera or from lamps.
enum class ViewKind { kCamera, kShadow };

// One material of one instance, as it is handed in.
struct Draw {
  uint32_t instance = 0;        // place in the buffer of instances
  uint32_t material = 0;        // dense index
  uint32_t first_triangle = 0;  // in the mesh's own triangles
  uint32_t index_count = 0;
  uint32_t first_index = 0;
  uint32_t base_vertex = 0;
};

class DrawLists {
 public:
  static constexpr uint32_t kOpaque = 0xffffffffu;

  // Draws of one list by who sees them: the camera alone, both, lamps alone.
  using Audience = std::array<std::vector<Draw>, 3>;

  // Replaces all lists, by the dense index of their material or kOpaque.
  void update(const std::map<uint32_t, Audience>& lists);
  void flush();

  const gl::Buffer& records() const { return records_.buffer(); }
  bool empty() const { return lists_.empty(); }

  // Binds the commands and the records (vertex buffer 1) to `array`.
  void bind(const gl::VertexArray& array) const;
  // Calls `before(material or kOpaque)`, then draws, for each list that such a view sees some of.
  template <class Before>
  void draw(ViewKind kind, Before before) const {
    const size_t own = kind == ViewKind::kCamera ? 0 : 2;
    for (auto list = lists_.rbegin(); list != lists_.rend(); ++list) {
      const auto& [material, parts] = *list;
      if (parts[own].draws.empty() && parts[1].draws.empty()) continue;
      before(material);
      for (size_t part : {size_t(1), own}) draw_part(parts[part]);
    }
  }

 private:
  struct Part {
    Range range;  // has room to spare
    std::vector<Draw> draws;
  };
  void update_part(Part& part, const std::vector<Draw>& draws);
  void draw_part(const Part& part) const;

  std::map<uint32_t, std::array<Part, 3>> lists_;  // kOpaque is the last, and drawn first
  RangeAllocator ranges_;                          // of records and commands alike
  MirroredBuffer records_{"objects"}, commands_{"objects"};
};

}  // namespace panoptes::gpu_scene
