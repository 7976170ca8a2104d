// The tree by which one of many lights is chosen (Conty Estevez and Kulla 2018), and the plain tree of
// bounds in which a ray finds the lamps that it passes. No GL.
#pragma once

#include "path_tracer/lights_shared.h"
#include "scene/scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace panoptes::path_tracer {

// Where a light is, how strong it is and where it shines.
struct LightBounds {
  scene::Bounds box;       // relative to the triangles' origin, metres; suns: their direction
  glm::vec3 axis{0, 0, 1};  // unit
  float cosine_o = 1;      // of the cone about the axis that holds all normals
  float cosine_e = 0;      // of the angle to its normal within which a point shines
  float intensity = 0;     // most that goes in any direction, W/sr; suns W/m2; positive
  bool two_sided = false;  // shines along the opposite axis as well
  bool infinite = false;   // a sun
};

// Bounds of what both hold. Never of something infinite and something that is not.
LightBounds merge(const LightBounds& a, const LightBounds& b);

struct LightTree {
  std::vector<shared::LightNode> nodes;  // depth first; the root is the first
  std::vector<uint32_t> trails;          // a light, the way to its leaf; see lights_shared.h
};

// A tree with one leaf a light, at most MOST_LEVELS deep; leaves name lights by their numbers in
// `lights`. What is infinite lies below one child of the root, the second, where there is both.
// `first_node` is added to the numbers of nodes. Throws Error when there are too many lights.
LightTree build_light_tree(std::span<const LightBounds> lights, uint32_t first_node = 0);

}  // namespace panoptes::path_tracer
