// What a picture of rays at work shows.
#pragma once

#include <array>
#include <string_view>

namespace panoptes::ray_picture {

enum class Kind {
  kNone,   // the scene itself: no such picture
  kSteps,  // nodes or cells that a pixel's ray visited
  kTests,  // triangles that it was tested with
  kLists,  // triangles in the longest list that it went through
  kTiles,  // which cell or leaf the last of its lists lay in, by a colour of its own
};

constexpr std::array<std::string_view, 5> kKindNames{"none", "steps", "tests", "lists", "tiles"};

constexpr bool known(Kind kind) {
  return int(kind) >= 0 && size_t(kind) < kKindNames.size();
}

constexpr std::string_view name(Kind kind) { return kKindNames[size_t(kind)]; }

// The kind of that name; Kind(-1) when there is none.
constexpr Kind find_kind(std::string_view name) {
  for (size_t i = 0; i < kKindNames.size(); ++i)
    if (kKindNames[i] == name) return Kind(i);
  return Kind(-1);
}

}  // namespace panoptes::ray_picture
