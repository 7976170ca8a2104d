// How rays find the triangles that they meet, as an artist may choose it.
#pragma once

#include "fragment_tracer/settings.h"

#include <array>
#include <string_view>

namespace panoptes::engine {

enum class Structure {
  kAuto,          // what is expected to cost least, build and rays together (tracing/cost_book.h)
  kOrthographic,  // one orthographic view of two-level tiles
  kCube,          // six perspective views, lists as runs
  kLists,         // the same with the thesis' linked lists
  kBvh,           // a hierarchy of boxes, built on the host
  kView,          // the camera's perspective view alone: what it does not see, no ray meets
  kFragments,     // layers of pixels in views about the camera, in place of triangles: an approximation
};

constexpr std::array<std::string_view, 7> kStructureNames{"auto", "orthographic", "cube", "lists",
                                                          "bvh",  "view",         "fragments"};

// The structure of that name; Structure(-1) when there is none.
constexpr Structure find_structure(std::string_view name) {
  for (size_t i = 0; i < kStructureNames.size(); ++i)
    if (kStructureNames[i] == name) return Structure(i);
  return Structure(-1);
}

struct StructureSettings {
  Structure structure = Structure::kAuto;
  int tiles = 0;    // a side of a view, 1 .. 1024; 0: as many as the triangles deserve
  int buckets = 0;  // over depth: of a tile with kLists, else for each triangle of a tile, 1 .. 255;
                    // 0: the structure's own
  fragment_tracer::Settings fragments;  // of kFragments

  // Throws Error with a sentence when a value is out of range.
  void check() const;
  bool operator==(const StructureSettings&) const = default;
};

}  // namespace panoptes::engine
