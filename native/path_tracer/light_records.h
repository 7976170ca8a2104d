// What the GPU knows of each light, and its bounds in the tree: of lamps, and of triangles that glow.
// No GL.
#pragma once

#include "path_tracer/light_tree.h"
#include "scene/light.h"

#include <array>
#include <optional>

namespace panoptes::path_tracer {

struct DescribedLight {
  shared::LightRecord record;
  LightBounds bounds;
  bool seen = false;  // a lamp that scattered rays can meet: it has an extent

  uint32_t flags() const;
  uint32_t kind() const { return flags() & shared::KIND_MASK; }
};

// A lamp as seen from `origin`, world space; none where it gives no light, or no finite one.
std::optional<DescribedLight> describe(const scene::Light& lamp, const glm::dvec3& origin);

// Of one triangle that may glow.
struct GlowingTriangle {
  std::array<glm::dvec3, 3> corners;  // relative to the triangles' origin, metres
  bool mirrored = false;              // the front is where its corners run clockwise
  uint32_t primitive = 0;
  uint32_t seen_by = 0;               // SEEN_BY_... bits
  glm::vec3 front{0}, back{0};        // radiance W/(m2 sr); a mean where it varies
  bool varies = false;
};

// None where it is dark, has no area, or is not finite.
std::optional<DescribedLight> describe(const GlowingTriangle& triangle);

}  // namespace panoptes::path_tracer
