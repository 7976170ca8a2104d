#include "path_tracer/light_tree.h"

#include "base/error.h"
#include "scene/packing.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

namespace panoptes::path_tracer {

namespace {

constexpr int kBins = 12;  // along each axis where a split is looked for
constexpr float kPi = 3.14159265f;

// Below what separates two axes that are packed in 32 bits.
constexpr float kPackedAngle = 1e-4f;

float angle_of(float cosine) { return std::acos(std::clamp(cosine, -1.0f, 1.0f)); }

struct Cone {
  glm::vec3 axis;
  float angle;
};

// The least cone about two (Conty Estevez and Kulla 2018, algorithm 1).
Cone merge(const Cone& a, const Cone& b) {
  if (b.angle > a.angle) return merge(b, a);
  const float between = angle_of(glm::dot(a.axis, b.axis));
  if (std::min(between + b.angle, kPi) <= a.angle) return a;
  const float angle = 0.5f * (a.angle + between + b.angle);
  const glm::vec3 across = glm::cross(a.axis, b.axis);
  const float length = glm::length(across);
  if (angle >= kPi || !(length > 0)) return {a.axis, kPi};
  // The axis of `a` turned towards that of `b`.
  const glm::vec3 towards = glm::cross(across / length, a.axis);
  const float turn = angle - a.angle;
  return {glm::normalize(std::cos(turn) * a.axis + std::sin(turn) * towards), angle};
}

// The surface of a box; that of lights in one line is not nothing.
double box_measure(const scene::Bounds& box) {
  const glm::dvec3 d = glm::dvec3(box.high) - glm::dvec3(box.low);
  return d.x * d.y + d.y * d.z + d.z * d.x + 0.01 * glm::dot(d, d);
}

// The solid angle that the cone reaches, weighted by cosine beyond its normals.
double orientation_measure(const LightBounds& b) {
  const double o = angle_of(b.cosine_o), e = angle_of(b.cosine_e);
  const double w = std::min(o + e, double(kPi));
  return 2 * kPi * (1 - std::cos(o)) +
         0.5 * kPi * (2 * w * std::sin(o) - std::cos(o - 2 * w) - 2 * o * std::sin(o) + std::cos(o));
}

// What it costs to have these under one node; the third factor prefers short nodes.
double cost(const LightBounds& b, double stretch) {
  const double area = b.infinite ? 1.0 : box_measure(b.box);
  return b.intensity * orientation_measure(b) * area * stretch;
}

glm::vec3 center(const LightBounds& b) { return 0.5f * b.box.low + 0.5f * b.box.high; }

class Builder {
 public:
  Builder(std::span<const LightBounds> lights, uint32_t first_node)
      : lights_(lights), first_(first_node), order_(lights.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    tree_.trails.resize(lights.size());
    if (!lights.empty()) tree_.nodes.reserve(2 * lights.size() - 1);
  }

  LightTree build() {
    const auto sun = [&](uint32_t light) { return lights_[light].infinite; };
    const auto middle = std::stable_partition(order_.begin(), order_.end(),
                                              [&](uint32_t light) { return !sun(light); });
    const size_t local = size_t(middle - order_.begin());
    if (local > 0 && local < order_.size()) {
      tree_.nodes.emplace_back();
      const LightBounds a = add(0, local, 1, 0);
      const uint32_t second = next();
      const LightBounds b = add(local, order_.size(), 1, 1);
      // Nobody asks for the bounds of this one.
      LightBounds all = a;
      all.intensity += b.intensity;
      write(0, all, second);
    } else if (!order_.empty()) {
      add(0, order_.size(), 0, 0);
    }
    return std::move(tree_);
  }

 private:
  uint32_t next() const { return first_ + uint32_t(tree_.nodes.size()); }

  void write(size_t node, const LightBounds& b, uint32_t child) {
    const auto down = [](float x) { return std::nextafter(x, -std::numeric_limits<float>::max()); };
    const auto up = [](float x) { return std::nextafter(x, std::numeric_limits<float>::max()); };
    const float o = b.cosine_o < 1 ? std::min(angle_of(b.cosine_o) + kPackedAngle, kPi) : kPackedAngle;
    child |= (b.two_sided ? shared::NODE_TWO_SIDED : 0) | (b.infinite ? shared::NODE_INFINITE : 0);
    tree_.nodes[node] = {down(b.box.low.x),  down(b.box.low.y),  down(b.box.low.z), b.intensity,
                         up(b.box.high.x),   up(b.box.high.y),   up(b.box.high.z),  child,
                         scene::pack_unit(b.axis), std::cos(o), b.cosine_e, next()};
  }

  // Makes the node of order_[begin .. end) at `level`, whose trail is `trail`, and all below it.
  LightBounds add(size_t begin, size_t end, int level, uint32_t trail) {
    const size_t node = tree_.nodes.size();
    tree_.nodes.emplace_back();
    if (end - begin == 1) {
      const uint32_t light = order_[begin];
      tree_.trails[light] = trail;
      write(node, lights_[light], shared::NODE_LEAF | light);
      return lights_[light];
    }
    const size_t middle = split(begin, end, level);
    const LightBounds a = add(begin, middle, level + 1, trail);
    const uint32_t second = next();
    const LightBounds b = add(middle, end, level + 1, trail | 1u << level);
    const LightBounds all = merge(a, b);
    write(node, all, second);
    return all;
  }

  struct Split {
    int axis = -1, bin = 0;  // -1: none is worth it
    double cost = 0;
  };

  size_t split(size_t begin, size_t end, int level) {
    scene::Bounds centers;
    for (size_t i = begin; i < end; ++i) centers.add(center(lights_[order_[i]]));
    // As many levels as even halving takes must remain.
    const int needed = std::bit_width(end - begin - 1);
    Split best;
    if (level + needed < shared::MOST_LEVELS) best = find(begin, end, centers);
    if (best.axis >= 0) {
      const auto middle =
          std::partition(order_.begin() + ptrdiff_t(begin), order_.begin() + ptrdiff_t(end),
                         [&](uint32_t light) { return bin_of(light, best.axis, centers) <= best.bin; });
      const size_t at = size_t(middle - order_.begin());
      if (at > begin && at < end) return at;
    }
    // In the middle of the longest axis.
    const glm::vec3 extent = centers.high - centers.low;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const size_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + ptrdiff_t(begin), order_.begin() + ptrdiff_t(middle),
                     order_.begin() + ptrdiff_t(end), [&](uint32_t a, uint32_t b) {
                       const float x = center(lights_[a])[axis], y = center(lights_[b])[axis];
                       return x != y ? x < y : a < b;
                     });
    return middle;
  }

  int bin_of(uint32_t light, int axis, const scene::Bounds& centers) const {
    const float place = (center(lights_[light])[axis] - centers.low[axis]) /
                        (centers.high[axis] - centers.low[axis]);
    return std::clamp(int(place * kBins), 0, kBins - 1);
  }

  Split find(size_t begin, size_t end, const scene::Bounds& centers) const {
    Split best;
    const glm::vec3 extent = centers.high - centers.low;
    const float longest = std::max(extent.x, std::max(extent.y, extent.z));
    for (int axis = 0; axis < 3; ++axis) {
      if (!(extent[axis] > 0)) continue;
      std::array<LightBounds, kBins> bins;
      std::array<bool, kBins> used{};
      const auto gather = [](LightBounds& sum, bool& any, const LightBounds& more) {
        sum = any ? merge(sum, more) : more;
        any = true;
      };
      for (size_t i = begin; i < end; ++i) {
        const size_t bin = size_t(bin_of(order_[i], axis, centers));
        gather(bins[bin], used[bin], lights_[order_[i]]);
      }
      // Costs of all that lies behind each place, then with all before it.
      std::array<double, kBins> behind{};
      LightBounds sum;
      bool any = false;
      const double stretch = longest / extent[axis];
      for (size_t bin = kBins; bin-- > 1;) {
        if (used[bin]) gather(sum, any, bins[bin]);
        behind[bin] = any ? cost(sum, stretch) : -1;
      }
      any = false;
      for (size_t bin = 0; bin + 1 < kBins; ++bin) {
        if (used[bin]) gather(sum, any, bins[bin]);
        if (!any || behind[bin + 1] < 0) continue;
        const double total = cost(sum, stretch) + behind[bin + 1];
        if (best.axis < 0 || total < best.cost) best = {axis, int(bin), total};
      }
    }
    return best;
  }

  std::span<const LightBounds> lights_;
  uint32_t first_;
  std::vector<uint32_t> order_;
  LightTree tree_;
};

}  // namespace

LightBounds merge(const LightBounds& a, const LightBounds& b) {
  LightBounds all = a;
  all.box.add(b.box.low);
  all.box.add(b.box.high);
  all.two_sided = a.two_sided || b.two_sided;
  const glm::vec3 other = all.two_sided && glm::dot(a.axis, b.axis) < 0 ? -b.axis : b.axis;
  const Cone cone = merge(Cone{a.axis, angle_of(a.cosine_o)}, Cone{other, angle_of(b.cosine_o)});
  all.axis = cone.axis;
  all.cosine_o = std::cos(cone.angle);
  all.cosine_e = std::min(a.cosine_e, b.cosine_e);
  all.intensity = a.intensity + b.intensity;
  return all;
}

LightTree build_light_tree(std::span<const LightBounds> lights, uint32_t first_node) {
  // Two nodes a light, by numbers of 29 bits.
  const size_t most = (shared::NODE_INDEX - first_node) / 2;
  if (lights.size() > most)
    fail("the scene has {} lamps and glowing triangles, and paths can choose among {}: make fewer "
         "surfaces glow",
         lights.size(), most);
  return Builder(lights, first_node).build();
}

}  // namespace panoptes::path_tracer
