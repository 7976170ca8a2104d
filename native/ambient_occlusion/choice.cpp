#include "ambient_occlusion/choice.h"

#include <algorithm>
#include <cmath>

namespace panoptes::ambient_occlusion {

namespace {

// A view that is about as reliable as the camera has at least that share of its weight.
constexpr float kAsReliable = 0.75f;

bool tells(const Estimate& e) {
  return std::isfinite(e.occlusion) && std::isfinite(e.weight) && e.weight > 0;
}

// The sums of (4.1) over the views that have been chosen for one probe.
struct Combined {
  double occlusion = 0, weight = 0;
  double alone;  // the camera's estimate, which stands where all weights vanish

  void add(const Estimate& e) {
    if (!tells(e)) return;
    occlusion += double(e.occlusion) * e.weight;
    weight += e.weight;
  }
  double value() const { return weight > 0 ? occlusion / weight : alone; }
  double change(const Estimate& e) const {
    Combined with = *this;
    with.add(e);
    return std::abs(with.value() - value());
  }
};

// The estimates of each probe that counts.
std::vector<std::span<const Estimate>> probes_of(std::span<const Estimate> estimates, int views) {
  std::vector<std::span<const Estimate>> probes;
  for (; views > 0 && estimates.size() >= size_t(views);
       estimates = estimates.subspan(size_t(views)))
    if (std::isfinite(estimates[0].occlusion) && std::isfinite(estimates[0].weight))
      probes.push_back(estimates.first(size_t(views)));
  return probes;
}

}  // namespace

std::vector<int> choose_views(std::span<const Estimate> estimates, int views, int most,
                              float least) {
  const auto probes = probes_of(estimates, views);
  std::vector<Combined> combined;
  for (const auto& probe : probes) {
    combined.push_back({.alone = probe[0].occlusion});
    combined.back().add(probe[0]);
  }
  std::vector<int> chosen;
  while (int(chosen.size()) < most) {
    int best = 0;
    double largest = 0;
    for (int view = 1; view < views; ++view) {
      if (std::find(chosen.begin(), chosen.end(), view) != chosen.end()) continue;
      double change = 0;
      for (size_t p = 0; p < probes.size(); ++p)
        change += combined[p].change(probes[p][size_t(view)]);
      if (change > largest) {
        best = view;
        largest = change;
      }
    }
    if (best == 0 || largest < double(least) * double(probes.size())) break;
    for (size_t p = 0; p < probes.size(); ++p) combined[p].add(probes[p][size_t(best)]);
    chosen.push_back(best);
  }
  return chosen;
}

float coverage(std::span<const Estimate> estimates, int views, const std::vector<int>& chosen) {
  const auto probes = probes_of(estimates, views);
  if (probes.empty()) return 1;
  const auto covered = [&](std::span<const Estimate> probe) {
    return std::any_of(chosen.begin(), chosen.end(), [&](int view) {
      const Estimate& e = probe[size_t(view)];
      return tells(e) && e.weight >= kAsReliable * probe[0].weight;
    });
  };
  return float(std::count_if(probes.begin(), probes.end(), covered)) / float(probes.size());
}

}  // namespace panoptes::ambient_occlusion
