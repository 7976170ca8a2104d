#include "ray_picture/decide.h"

#include <fmt/format.h>

namespace panoptes::ray_picture {

plan::Effects decide(const scene::Facts& facts, Kind kind) {
  return {{"triangles", true,
           fmt::format("{} triangles in {} objects for rays to meet", facts.triangles,
                       facts.instances)},
          {"structure", true, "rays find the triangles on their way by it"},
          {"rays", true, fmt::format("a picture of their {} was asked for", name(kind))}};
}

}  // namespace panoptes::ray_picture
