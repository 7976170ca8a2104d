// The hierarchy of boxes as the host builds and packs it; without a GPU.
#include "bvh_tracer/bvh.h"
#include "rays/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <numeric>

namespace panoptes::test {
namespace {

using bvh_tracer::build_bvh;
using bvh_tracer::Bvh;
using scene::Bounds;

struct Leaf {
  uint32_t first, count;
  explicit Leaf(int32_t child)
      : first(uint32_t(~child) >> shared::BVH_COUNT_BITS),
        count(uint32_t(~child) & ((1u << shared::BVH_COUNT_BITS) - 1)) {}
};

// Calls leaf(leaf, bounds, depth) for all leaves, in their order; depth: nodes from the root to it.
void for_each_leaf(const Bvh& bvh, const std::function<void(Leaf, const Bounds&, uint32_t)>& leaf,
                   uint32_t node = 0, uint32_t depth = 1) {
  ASSERT_LT(node, bvh.nodes.size());
  for (int k = 0; k < 2; ++k) {
    const int32_t child = bvh.nodes[node].children[k];
    if (child < 0)
      leaf(Leaf(child), bvh.nodes[node].bounds[k], depth);
    else
      for_each_leaf(bvh, leaf, uint32_t(child), depth + 1);
  }
}

uint32_t depth_of(const Bvh& bvh) {
  uint32_t deepest = 0;
  for_each_leaf(bvh, [&](Leaf, const Bounds&, uint32_t depth) { deepest = std::max(deepest, depth); });
  return deepest;
}

Bounds box_of(const TracedTriangle& triangle) {
  Bounds bounds;
  for (int k = 0; k < 3; ++k) bounds.add(corner(triangle, k));
  return bounds;
}

bool contains(const Bounds& outer, const Bounds& inner) {
  return glm::all(glm::lessThanEqual(outer.low, inner.low)) &&
         glm::all(glm::greaterThanEqual(outer.high, inner.high));
}

// Each of `seen` in one leaf of few, in a box that holds it; boxes lie in their parents'.
void expect_sound(const Bvh& bvh, const Triangles& triangles, const std::vector<uint32_t>& seen) {
  std::vector<uint32_t> found = bvh.order;
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, seen);
  uint32_t next = 0, outside = 0;
  for_each_leaf(bvh, [&](Leaf leaf, const Bounds& bounds, uint32_t) {
    EXPECT_EQ(leaf.first, next);
    next += leaf.count;
    for (uint32_t i = leaf.first; i < std::min(next, uint32_t(bvh.order.size())); ++i)
      outside += !contains(bounds, box_of(triangles[bvh.order[i]]));
  });
  EXPECT_EQ(next, bvh.order.size());
  for (const Bvh::Node& node : bvh.nodes)
    for (int k = 0; k < 2; ++k) {
      if (node.children[k] < 0) continue;
      for (const Bounds& inner : bvh.nodes[size_t(node.children[k])].bounds)
        outside += !contains(node.bounds[k], inner);
    }
  EXPECT_EQ(outside, 0u);
  EXPECT_LE(depth_of(bvh), shared::BVH_DEPTH);
}

std::vector<uint32_t> all_of(const Triangles& triangles) {
  std::vector<uint32_t> numbers(triangles.size());
  std::iota(numbers.begin(), numbers.end(), 0u);
  return numbers;
}

double half_surface(const Bounds& b) {
  const glm::dvec3 d = glm::dvec3(b.high) - glm::dvec3(b.low);
  return d.x * d.y + d.y * d.z + d.z * d.x;
}

// Nodes visited and triangles tested by a ray that meets the root, on average (MacDonald and Booth
// 1990).
double cost_of(const Bvh& bvh) {
  Bounds all;
  double sum = 0;
  for (const Bounds& b : bvh.nodes[0].bounds) all.add(b.low), all.add(b.high);
  for (const Bvh::Node& node : bvh.nodes)
    for (int k = 0; k < 2; ++k)
      sum += half_surface(node.bounds[k]) *
             (node.children[k] < 0 ? Leaf(node.children[k]).count : 1);
  return 1 + sum / half_surface(all);
}

// The same of a hierarchy that halves the triangles along the longest side of their bounds.
double cost_of_halving(const Triangles& triangles, std::vector<uint32_t>& order, size_t begin,
                       size_t end, Bounds& bounds) {
  for (size_t i = begin; i < end; ++i) {
    const Bounds b = box_of(triangles[order[i]]);
    bounds.add(b.low), bounds.add(b.high);
  }
  if (end - begin <= 4) return double(end - begin) * half_surface(bounds);
  const glm::vec3 size = bounds.high - bounds.low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const size_t middle = (begin + end) / 2;
  const auto at = [&](uint32_t i) {
    const Bounds b = box_of(triangles[i]);
    return b.low[axis] + b.high[axis];
  };
  std::nth_element(order.begin() + long(begin), order.begin() + long(middle),
                   order.begin() + long(end), [&](uint32_t a, uint32_t b) { return at(a) < at(b); });
  Bounds below, above;
  return half_surface(bounds) + cost_of_halving(triangles, order, begin, middle, below) +
         cost_of_halving(triangles, order, middle, end, above);
}

TEST(Bvh, HoldsEachTriangleOnceInBoxesThatContainIt) {
  for (const RayScene& scene : {box_room(), soup(), grass()}) {
    SCOPED_TRACE(scene.name);
    expect_sound(build_bvh(scene.triangles), scene.triangles, all_of(scene.triangles));
  }
}

TEST(Bvh, LeavesOutWhatNoRayCanMeet) {
  Triangles triangles = box_room().triangles;
  std::vector<uint32_t> seen;
  for (uint32_t i = 0; i < triangles.size(); ++i) {
    if (i % 3 == 0)
      triangles[i].flags = shared::TRIANGLE_HAS_ALPHA;  // seen by nobody
    else if (i % 7 == 0)
      triangles[i].y1 = std::numeric_limits<float>::quiet_NaN();
    else if (i % 8 == 0)
      triangles[i].z2 = -std::numeric_limits<float>::infinity();
    else if (i % 11 == 0)
      triangles[i].x0 = 1e30f;
    else
      seen.push_back(i);
  }
  expect_sound(build_bvh(triangles), triangles, seen);
}

TEST(Bvh, FewTrianglesOrNoneHaveARootToo) {
  const Triangles room = box_room().triangles;
  for (size_t count : {0, 1, 2, 3}) {
    const Triangles few(room.begin(), room.begin() + long(count));
    const Bvh bvh = build_bvh(few);
    EXPECT_GE(bvh.nodes.size(), 1u);
    expect_sound(bvh, few, all_of(few));
    EXPECT_EQ(pack(bvh).size(), bvh.nodes.size());
  }
}

// What no plane parts is halved, and the depth stays bounded whatever the planes do.
TEST(Bvh, DepthIsBounded) {
  constexpr uint32_t kMany = 100'000;
  const uint32_t halvings = uint32_t(std::ceil(std::log2(kMany)));
  const TracedTriangle one = make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const Triangles identical(kMany, one), points(kMany, make_triangle({1, 2, 3}, {1, 2, 3}, {1, 2, 3}));
  for (const Triangles* triangles : {&identical, &points}) {
    const Bvh bvh = build_bvh(*triangles);
    expect_sound(bvh, *triangles, all_of(*triangles));
    EXPECT_LE(depth_of(bvh), halvings);
  }

  Triangles coplanar;
  add_surface(coplanar, 224, 224, [](float u, float v) { return glm::vec3(u, v, 0); });
  ASSERT_GT(coplanar.size(), kMany);
  expect_sound(build_bvh(coplanar), coplanar, all_of(coplanar));

  // Heaps so near to each other, as seen from the one before, that each plane parts but one of them.
  Triangles heaps;
  float at = 1e17f;
  for (int heap = 0; heap < 42; ++heap, at /= 17)
    for (int i = 0; i < 1000; ++i) heaps.push_back(make_triangle({at, 0, 0}, {at, at, 0}, {at, 0, at}));
  const Bvh bvh = build_bvh(heaps);
  expect_sound(bvh, heaps, all_of(heaps));
  EXPECT_GT(depth_of(bvh), 40u);
}

TEST(Bvh, IsTheSameWhateverTheThreads) {
  const Triangles triangles = soup().triangles;
  const Bvh one = build_bvh(triangles, 1);
  const std::vector<shared::BvhNode> packed = pack(one);
  for (unsigned threads : {0u, 2u, 3u}) {
    const Bvh other = build_bvh(triangles, threads);
    EXPECT_EQ(other.order, one.order);
    const std::vector<shared::BvhNode> nodes = pack(other);
    ASSERT_EQ(nodes.size(), packed.size());
    EXPECT_EQ(std::memcmp(nodes.data(), packed.data(), packed.size() * sizeof(shared::BvhNode)), 0);
  }
}

// Halving ignores how large boxes become; the surface-area heuristic is there to do better.
TEST(Bvh, CostsRaysLessThanHalving) {
  for (const RayScene& scene : {atrium(), soup(), grass()}) {
    SCOPED_TRACE(scene.name);
    std::vector<uint32_t> order = all_of(scene.triangles);
    Bounds bounds;
    const double sum = cost_of_halving(scene.triangles, order, 0, order.size(), bounds);
    EXPECT_LT(cost_of(build_bvh(scene.triangles)), 0.9 * sum / half_surface(bounds));
  }
}

// What traverse.glsl reads from a packed node, in its arithmetic.
Bounds unpack(const shared::BvhNode& node, int child) {
  const uint32_t planes[3] = {node.planes_x, node.planes_y, node.planes_z};
  const float origin[3] = {node.x, node.y, node.z};
  Bounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    const float spacing = std::ldexp(1.0f, int((node.grid >> (8 * axis)) & 255) - 127);
    bounds.low[axis] = origin[axis] + spacing * float((planes[axis] >> (16 * child)) & 255);
    bounds.high[axis] = origin[axis] + spacing * float((planes[axis] >> (16 * child + 8)) & 255);
  }
  return bounds;
}

TEST(Bvh, PackedBoxesAreLargerButNotMuch) {
  RayScene flat;
  flat.name = "flat";
  add_surface(flat.triangles, 9, 9, [](float u, float v) { return glm::vec3(u, v, 0); });
  for (const RayScene& scene : {atrium(), soup(), grass(), flat}) {
    SCOPED_TRACE(scene.name);
    const Bvh bvh = build_bvh(scene.triangles);
    const std::vector<shared::BvhNode> packed = pack(bvh);
    ASSERT_EQ(packed.size(), bvh.nodes.size());
    size_t smaller = 0, too_large = 0;
    for (size_t i = 0; i < packed.size(); ++i) {
      const Bvh::Node& node = bvh.nodes[i];
      const glm::vec3 low = glm::min(node.bounds[0].low, node.bounds[1].low),
                      high = glm::max(node.bounds[0].high, node.bounds[1].high);
      // A plane of the grid more, and what float32 rounds of a coordinate.
      const glm::vec3 more =
          (high - low) / 100.0f + 2e-6f * glm::max(glm::abs(low), glm::abs(high)) + 1e-30f;
      for (int k = 0; k < 2; ++k) {
        const Bounds due = node.bounds[k], is = unpack(packed[i], k);
        smaller += !contains(is, due);
        too_large += !contains({due.low - more, due.high + more}, is);
      }
    }
    EXPECT_EQ(smaller, 0u);
    EXPECT_EQ(too_large, 0u);
  }
}

// A node need not say all of its children's numbers: the rest follows from their order.
TEST(Bvh, PackedChildrenFollowFromTheOrder) {
  const Bvh bvh = build_bvh(soup().triangles);
  const std::vector<shared::BvhNode> packed = pack(bvh);
  size_t wrong = 0;
  for (uint32_t i = 0; i < packed.size(); ++i) {
    const int32_t* children = bvh.nodes[i].children;
    const uint32_t code[2] = {(packed[i].grid >> 24) & 15, packed[i].grid >> 28};
    for (int k = 0; k < 2; ++k)
      wrong += code[k] != (children[k] < 0 ? 1 + Leaf(children[k]).count : 0);
    const uint32_t other = packed[i].other;
    if (children[0] >= 0) {
      wrong += uint32_t(children[0]) != i + 1;
      wrong += other != (children[1] < 0 ? Leaf(children[1]).first : uint32_t(children[1]));
    } else {
      const Leaf first(children[0]);
      wrong += other != first.first;
      wrong += children[1] < 0 ? Leaf(children[1]).first != first.first + first.count
                               : uint32_t(children[1]) != i + 1;
    }
  }
  EXPECT_EQ(wrong, 0u);
}

}  // namespace
}  // namespace panoptes::test
