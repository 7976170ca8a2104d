#include "bvh_tracer/bvh.h"

#include <algorithm>
#include <cmath>

namespace panoptes::bvh_tracer {

namespace {

using shared::BvhNode;

// The test of a triangle rounds the positions of its corners relative to the ray's origin: what it
// meets may lie beside the triangle by that much. A box that has any width also needs to be wider
// than that for rays in the plane of one of its sides.
scene::Bounds with_room(const scene::Bounds& bounds) {
  const glm::vec3 room = 0x1p-21f * glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
  return {bounds.low - room, bounds.high + room};
}

// Of a plane's distance from the next: what traverse.glsl rounds, many times over.
constexpr double kMargin = 0x1p-10;

struct Grid {
  double origin, planes_per_metre;
  uint32_t exponent;  // biased

  Grid(float low, float high) : origin(low) {
    // The least power of two by which the extent, and a margin, is 255 steps at most.
    int power;
    std::frexp(std::max(high - origin, 0x1p-126) / (255 - 2 * kMargin), &power);
    power = std::clamp(power, -126, 127);
    exponent = uint32_t(power + 127);
    planes_per_metre = std::ldexp(1.0, -power);
  }
  uint32_t below(float x) const {
    return uint32_t(std::max((x - origin) * planes_per_metre - kMargin, 0.0));
  }
  uint32_t above(float x) const {
    return uint32_t((x - origin) * planes_per_metre + kMargin) + 1;
  }
};

struct Child {
  bool leaf;
  uint32_t number, count;
  explicit Child(int32_t child)
      : leaf(child < 0),
        number(leaf ? uint32_t(~child) >> shared::BVH_COUNT_BITS : uint32_t(child)),
        count(leaf ? uint32_t(~child) & ((1u << shared::BVH_COUNT_BITS) - 1) : 0) {}
  uint32_t code() const { return leaf ? 1 + count : 0; }
};

BvhNode pack(const Bvh::Node& node) {
  const scene::Bounds box0 = with_room(node.bounds[0]), box1 = with_room(node.bounds[1]);
  const glm::vec3 low = glm::min(box0.low, box1.low), high = glm::max(box0.high, box1.high);
  const Child child0(node.children[0]), child1(node.children[1]);
  uint32_t planes[3], grid = child0.code() << 24 | child1.code() << 28;
  for (int axis = 0; axis < 3; ++axis) {
    const Grid along(low[axis], high[axis]);
    grid |= along.exponent << (8 * axis);
    planes[axis] = along.below(box0.low[axis]) | along.above(box0.high[axis]) << 8 |
                   along.below(box1.low[axis]) << 16 | along.above(box1.high[axis]) << 24;
  }
  const uint32_t other = child0.leaf ? child0.number : child1.number;
  return {low.x, low.y, low.z, grid, planes[0], planes[1], planes[2], other};
}

}  // namespace

std::vector<BvhNode> pack(const Bvh& bvh) {
  std::vector<BvhNode> packed;
  packed.reserve(bvh.nodes.size());
  for (const Bvh::Node& node : bvh.nodes) packed.push_back(pack(node));
  return packed;
}

}  // namespace panoptes::bvh_tracer
