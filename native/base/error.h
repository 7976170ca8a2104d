// The one exception type of the native code. Its message is written for artists: a single
// sentence that names the cause and the remedy, fit to be shown in Blender's status bar.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace panoptes {

class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The graphics driver is out of memory, has failed or restarted. Nothing that it holds counts any more.
class DriverError : public Error {
 public:
  using Error::Error;
};

// Throws Error with a formatted message, e.g. fail("image '{}' cannot be read: {}", name, why).
template <class... Args>
[[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) {
  throw Error(fmt::format(format, std::forward<Args>(args)...));
}

template <class... Args>
[[noreturn]] void fail_driver(fmt::format_string<Args...> format, Args&&... args) {
  throw DriverError(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace panoptes
