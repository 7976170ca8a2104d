// Choices of the primitive-based structure (thesis, chapter 7), with the reasons of their defaults.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>

namespace panoptes::primitive_tracer {

struct OrthographicSettings {
  // Tiles along the longer side of the view, rounded up to a power of two, 1 .. 1024; 0 follows the
  // number of triangles: less than one tile for each two dozen of them, since most tiles of a scene
  // are empty and crowded ones are divided; but 32 where the ground around a small thing would leave
  // it a tile or two.
  int tiles = 0;
  // Most times that a crowded tile is halved, 0 .. 4. Thrice (8x8 parts) on few tiles builds and
  // traces faster than twice on four times as many; once more is for crowds in a corner.
  int divisions = 4;
  // Triangles that a part of a divided tile should hold at most, from 1; 0 follows the number of
  // triangles: 40 for 200 000, where fewer would cost more to build than they save a frame's rays,
  // and less where there is little to build.
  int triangles_a_part = 0;
  // Buckets over depth for each triangle of a node, up to 256. More save few tests and cost memory.
  int buckets_per_triangle = 2;
};

// One camera's frustum in place of the cube's six faces; positions relative to the list's origin.
struct SingleView {
  glm::vec3 eye{0};
  glm::vec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};  // unit
  glm::vec2 half_extent{1};  // tangents of half the angles, along right and up
};

struct CubeSettings {
  // Tiles along a side of a view, rounded up to a power of two, 1 .. 1024; 0 follows the number of
  // triangles.
  int tiles = 0;
  // The thesis' storage: linked lists in a fixed number of uniform depth intervals. Else lists are
  // runs in one array, in as many intervals as a tile's triangles deserve, which is faster to trace
  // and smaller.
  bool linked_lists = false;
  // Depth intervals of a tile with linked lists, 1 .. 255. The thesis calls 8 the minimum for decent
  // speed (section 7.4.5); twice that costs 4 more bytes for each interval of each tile.
  int buckets = 16;
  // With linked lists: Algorithm 2 to the letter, which loses hits (its lines 14 and 18). For
  // measurements of how many.
  bool thesis_rejection = false;
  // Without linked lists: intervals for each triangle of a tile, rounded up to a power of two for
  // the tile, at most 256, and fewer where triangles stand so steep that each would lie in many.
  float buckets_per_triangle = 1;
  // Rasterise by the graphics pipeline, as the thesis does, in place of compute: conservatively
  // where GL_NV_conservative_raster exists, else in the rectangle around a triangle.
  bool hardware_raster = false;
  // The views' centre, relative to the list's origin. Not given: near the middle of the scene's
  // box, not in it, since modelled scenes have surfaces right there, and a triangle through the
  // centre lies in all tiles.
  std::optional<glm::vec3> centre = std::nullopt;
  // Given: rays meet only what this camera sees, also behind its frustum's end (section 7.4.4,
  // "Single-view Ray Tracing"). Its eye is the centre.
  std::optional<SingleView> single_view = std::nullopt;
  // Entries of triangles in tiles beyond which a structure is refused, or where tiles are chosen
  // gets larger ones; 16 byte each while it is built. 0: what a texture of the device can hold.
  uint32_t most_entries = 0;
};

}  // namespace panoptes::primitive_tracer
