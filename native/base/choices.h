// Choices by name: enumerators in the order of a list of names.
#pragma once

#include "base/error.h"

#include <fmt/ranges.h>

#include <array>
#include <string_view>

namespace panoptes {

// The place of `name` in a list of names as an enumerator; E(-1) when it is not there.
template <class E, size_t N>
constexpr E find_choice(const std::array<std::string_view, N>& names, std::string_view name) {
  for (size_t i = 0; i < N; ++i)
    if (names[i] == name) return E(i);
  return E(-1);
}

template <class E, size_t N>
constexpr bool known_choice(const std::array<std::string_view, N>&, E value) {
  return int(value) >= 0 && size_t(value) < N;
}

// Throws Error with the names when `value` is none of them.
template <class E, size_t N>
void check_choice(const std::array<std::string_view, N>& names, E value, std::string_view what) {
  if (!known_choice(names, value))
    fail("there is no {} number {}: choose one of {}", what, int(value), fmt::join(names, ", "));
}

}  // namespace panoptes
