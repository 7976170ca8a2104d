// A binary hierarchy of bounding boxes over triangles, built on the host by the surface-area
// heuristic (Goldsmith and Salmon 1987) over bins of centroids (Wald 2007).
#pragma once

#include "bvh_tracer/bvh_shared.h"
#include "scene/scene.h"
#include "tracing/rays_shared.h"

#include <cstdint>
#include <span>
#include <vector>

namespace panoptes::bvh_tracer {

struct Bvh {
  struct Node {
    int32_t children[2];      // as BVH_COUNT_BITS explains, of `order`
    scene::Bounds bounds[2];  // of the children
  };
  // A node before all that is below child 0, and that before all that is below child 1; the first is
  // the root. Without triangles it has two empty leaves.
  std::vector<Node> nodes;
  // Primitives, leaf after leaf.
  std::vector<uint32_t> order;
};

// Products of larger coordinates overflow in the test of a triangle with a ray.
inline constexpr float kFarthest = 1e18f;

// Builds over the triangles that somebody sees (TRIANGLE_SEEN_BY) and that rays can meet: those with
// a coordinate that is no number or beyond kFarthest stay out. Any others do: however many lie in
// one place, no leaf is deeper than BVH_DEPTH. The result does not depend on `threads`.
Bvh build_bvh(std::span<const shared::TracedTriangle> triangles, unsigned threads = 2);

// Boxes rounded outwards to each node's grid, with room for what the tests of rays round.
std::vector<shared::BvhNode> pack(const Bvh& bvh);

}  // namespace panoptes::bvh_tracer
