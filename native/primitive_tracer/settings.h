// Choices of the primitive-based structure (thesis, chapter 7), with the reasons of their defaults.
#pragma once

namespace panoptes::primitive_tracer {

struct OrthographicSettings {
  // Tiles along the longer side of the view, rounded up to a power of two, 1 .. 1024; 0 follows the
  // number of triangles: about one tile for each eight of them was fastest (128 for 206 k triangles).
  int tiles = 0;
  // Most times that a crowded tile is halved, 0 .. 4. Twice (4x4 parts) is what most scenes want; a
  // small object of many triangles in a large scene wants more.
  int divisions = 4;
  // Triangles that a part of a divided tile should hold at most. Fewer cost more to build than they
  // save rays.
  int triangles_a_part = 16;
  // Buckets over depth for each triangle of a node, up to 256. More save few tests and cost memory.
  int buckets_per_triangle = 2;
};

}  // namespace panoptes::primitive_tracer
