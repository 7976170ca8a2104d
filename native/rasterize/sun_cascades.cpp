#include "rasterize/sun_cascades.h"

#include "rasterize/visible_bounds_shared.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace panoptes::rasterize {

namespace {

// Texels of the whole scene's map may be so many times wider than the pixels that see them: about
// what the shift of the grid from sample to sample smooths.
constexpr double kCoarsest = 8;
// Share of the pixels, the nearest ones, that may go without detail: a twig before the lens must not
// cost the scene another map.
constexpr double kNeglected = 0.02;
// A cascade is worth its map if it is so many times smaller than the next.
constexpr double kWorthwhile = 1.5;

double extent(const scene::Bounds& b) {
  return b.empty() ? 0 : glm::length(glm::dvec3(b.high) - glm::dvec3(b.low));
}

scene::Bounds joined(scene::Bounds a, const scene::Bounds& b) {
  if (b.empty()) return a;
  a.add(b.low);
  a.add(b.high);
  return a;
}

float from_ordered_bits(uint32_t bits) {
  return std::bit_cast<float>(bits & 0x80000000u ? bits & 0x7fffffffu : ~bits);
}

}  // namespace

double median_distance(const std::vector<Slab>& slabs) {
  uint64_t pixels = 0, seen = 0;
  for (const Slab& slab : slabs) pixels += slab.pixels;
  for (const Slab& slab : slabs) {
    if (2 * (seen + slab.pixels) >= pixels) {
      // As if the octave's pixels were spread over it evenly.
      const double share = (0.5 * double(pixels) - double(seen)) / double(slab.pixels);
      return slab.nearest * std::exp2(share);
    }
    seen += slab.pixels;
  }
  return 0;
}

std::vector<scene::Bounds> choose_cascades(const std::vector<Slab>& slabs,
                                           const scene::Bounds& scene, double pixel,
                                           bool perspective, int resolution) {
  if (slabs.empty()) return {};
  uint64_t pixels = 0, seen = 0;
  for (const Slab& slab : slabs) pixels += slab.pixels;
  size_t first = 0;
  while (first + 1 < slabs.size() &&
         double(seen += slabs[first].pixels) < kNeglected * double(pixels))
    ++first;
  const auto footprint = [&](const Slab& slab) {
    return perspective ? pixel * slab.nearest : pixel;
  };
  if (extent(scene) / resolution <= kCoarsest * footprint(slabs[first])) return {};

  // Ranges of equal ratio between the nearest that counts and the farthest.
  const size_t count = slabs.size() - first;
  const size_t each = (count + kMostCascades - 1) / kMostCascades;
  std::vector<scene::Bounds> cascades;
  for (size_t i = first; i < slabs.size(); i += each) {
    scene::Bounds range;
    for (size_t k = i == first ? 0 : i; k < std::min(i + each, slabs.size()); ++k) {
      // Other samples of the film look past the edge of this one's pixels.
      scene::Bounds padded = slabs[k].bounds;
      const float pad = float(8 * footprint(slabs[k]));
      padded.low -= pad;
      padded.high += pad;
      range = joined(range, padded);
    }
    if (!cascades.empty() && extent(cascades.back()) * kWorthwhile > extent(range))
      cascades.back() = joined(cascades.back(), range);
    else
      cascades.push_back(range);
  }
  return cascades;
}

gl::ProgramSource visible_bounds_program() {
  gl::ProgramSource source;
  source.name = "visible bounds";
  source.stages = {{GL_COMPUTE_SHADER, "rasterize/visible_bounds.comp"}};
  source.defines = {"GLOSSY 0"};
  return source;
}

std::vector<Slab> visible_slabs(const GBuffer& g_buffer, const scene::Bounds& scene,
                                const glm::dvec3& camera_origin, gl::ProgramCache& programs) {
  double farthest = 1e-30;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 corner(i & 1 ? scene.high.x : scene.low.x, i & 2 ? scene.high.y : scene.low.y,
                            i & 4 ? scene.high.z : scene.low.z);
    farthest = std::max(farthest, glm::length(corner - camera_origin));
  }
  gl::Buffer buffer(sizeof(std::array<shared::VisibleSlab, shared::VISIBLE_SLABS>));
  buffer.clear();
  programs.get(visible_bounds_program()).use();
  g_buffer.bind_bins();
  g_buffer.bind_surfaces();
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, buffer.id());
  glUniform1f(2, float(farthest));
  g_buffer.dispatch_surfaces();
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  std::array<shared::VisibleSlab, shared::VISIBLE_SLABS> found;
  buffer.read(0, sizeof found, found.data());

  std::vector<Slab> slabs;
  for (size_t i = found.size(); i-- > 0;) {
    if (found[i].pixels == 0) continue;
    Slab slab;
    slab.nearest = std::ldexp(farthest, -int(i) - 1);
    slab.pixels = found[i].pixels;
    glm::dvec3 low, high;
    for (int axis = 0; axis < 3; ++axis) {
      high[axis] = from_ordered_bits(found[i].high[axis]);
      low[axis] = -from_ordered_bits(found[i].minus_low[axis]);
    }
    slab.bounds.add(glm::vec3(low + camera_origin));
    slab.bounds.add(glm::vec3(high + camera_origin));
    slabs.push_back(slab);
  }
  return slabs;
}

}  // namespace panoptes::rasterize
