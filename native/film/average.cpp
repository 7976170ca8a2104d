#include "film/average.h"

#include <algorithm>

namespace panoptes::film {

Layout::Layout(size_t pixels, const PassSet& passes) : pixels_(pixels), passes_(passes) {
  for (int i = 0; i < kPassCount; ++i) {
    if (!holds(Pass(i))) continue;
    begins_[size_t(i)] = total_;
    total_ += size(Pass(i));
  }
}

std::vector<float> average(Pass pass, std::vector<float> sums, std::span<const float> divisor,
                           const SampleCounts& counts, float exposure) {
  const PassInfo& p = info(pass);
  const size_t channels = size_t(p.channels);
  const float light = p.light ? exposure : 1.0f;
  for (size_t begin = 0; begin < sums.size(); begin += channels) {
    const float count = float(std::max(counts.of(begin / channels), 1u));
    for (size_t c = 0; c < channels; ++c) {
      float& value = sums[begin + c];
      if (!divisor.empty()) {
        const float d = divisor[begin + c];
        value = d > 0 ? value / d * light : 0.0f;
      } else {
        // Coverage (the fourth channel) is no light.
        value *= (c == 3 ? 1.0f : light) / count;
      }
    }
  }
  return sums;
}

std::vector<float> sample_shares(const SampleCounts& counts, size_t pixels) {
  std::vector<float> result(pixels);
  const float most = float(std::max(counts.all, 1u));
  for (size_t i = 0; i < pixels; ++i) result[i] = float(counts.of(i)) / most;
  return result;
}

}  // namespace panoptes::film
