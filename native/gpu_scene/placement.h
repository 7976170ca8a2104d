// Puts a list's items into an array whose order does not matter, so that an edited list moves as
// few of them as can be: who is deleted leaves a hole for the last or for who comes next.
#pragma once

#include <cstdint>
#include <cstring>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace panoptes::gpu_scene {

// Makes `placed` hold just `items`, densely. Those that it held already, bit by bit, keep their
// places where these are still within. Returns the place of each item; equal items are told apart
// by their order. T has no padding.
template <class T>
std::vector<uint32_t> place(const std::vector<T>& items, std::vector<T>& placed) {
  static_assert(std::has_unique_object_representations_v<T>);
  const auto bits = [](const T& item) {
    return std::string_view(reinterpret_cast<const char*>(&item), sizeof item);
  };
  constexpr uint32_t kNone = 0xffffffffu;
  std::vector<uint32_t> places(items.size(), kNone);
  std::vector<T> before = std::move(placed);
  placed.assign(items.size(), T{});
  std::vector<bool> taken(items.size(), false);

  // Most lists differ little: the items of equal bits, chained by their place, last one first.
  std::unordered_map<std::string_view, uint32_t> last;
  std::vector<uint32_t> previous(before.size(), kNone);
  const size_t kept = std::min(before.size(), items.size());
  last.reserve(kept);
  for (uint32_t i = uint32_t(kept); i-- > 0;) {
    auto [it, fresh] = last.try_emplace(bits(before[i]), i);
    if (!fresh) previous[i] = std::exchange(it->second, i);
  }
  const auto put = [&](size_t item, uint32_t at) {
    places[item] = at;
    placed[at] = items[item];
    taken[at] = true;
  };
  for (size_t item = 0; item < items.size(); ++item) {
    const auto found = last.find(bits(items[item]));
    if (found == last.end() || found->second == kNone) continue;
    const uint32_t at = found->second;
    found->second = previous[at];
    put(item, at);
  }
  // The others take what is free, in order.
  uint32_t free = 0;
  for (size_t item = 0; item < items.size(); ++item) {
    if (places[item] != kNone) continue;
    while (taken[free]) ++free;
    put(item, free);
  }
  return places;
}

}  // namespace panoptes::gpu_scene
