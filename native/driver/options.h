// What options of the form KEY=VALUE have in common.
#pragma once

#include "base/choices.h"

#include <cstdlib>
#include <functional>
#include <map>
#include <string>

namespace panoptes::driver {

using Options = std::map<std::string, std::function<void(const std::string& value)>>;

template <class E, size_t N>
E named(const std::array<std::string_view, N>& names, const std::string& value) {
  const E found = find_choice<E>(names, value);
  if (!known_choice(names, found))
    fail("'{}' is none of {}: see --help", value, fmt::join(names, ", "));
  return found;
}

inline float number(const std::string& value) {
  char* end = nullptr;
  const float result = std::strtof(value.c_str(), &end);
  if (end == value.c_str() || *end) fail("'{}' is no number: see --help", value);
  return result;
}

// Sets the key of `option`, given to the driver as `name`. Throws Error if there is no such key.
inline void set_option(const Options& keys, const std::string& option, const char* name) {
  const size_t at = option.find('=');
  const auto key = keys.find(option.substr(0, at));
  if (at == std::string::npos || key == keys.end())
    fail("{} takes KEY=VALUE, not '{}': see --help", name, option);
  key->second(option.substr(at + 1));
}

}  // namespace panoptes::driver
