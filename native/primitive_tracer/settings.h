// Choices of the primitive-based structure (thesis, chapter 7), with the reasons of their defaults.
#pragma once

namespace panoptes::primitive_tracer {

struct OrthographicSettings {
  // Tiles along the longer side of the view, rounded up to a power of two, 1 .. 1024; 0 follows the
  // number of triangles: about one tile for each eight of them was fastest (128 for 206 k triangles).
  int tiles = 0;
  // Most times that a crowded tile is halved, 0 .. 3. Twice (4x4 parts) trades the fewest tests for
  // the fewest steps of diffuse rays; three times costs more to build than it gains.
  int divisions = 2;
  // Triangles that a part of a divided tile should hold at most.
  int triangles_a_part = 8;
  // Buckets over depth for each triangle of a node, up to 256. Four instead of two save a seventh of
  // the tests for a third more memory and no time to speak of.
  int buckets_per_triangle = 4;
};

}  // namespace panoptes::primitive_tracer
