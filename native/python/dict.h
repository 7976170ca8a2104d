// Values out of Python's dictionaries, by name.
#pragma once

#include "base/choices.h"
#include "base/error.h"
#include "python/convert.h"

#include <set>
#include <string>

namespace panoptes::python {

// The value of a key; `otherwise` where there is none. Throws Error when it is of another type.
template <class T>
T get(const py::dict& dict, const char* key, const T& otherwise) {
  if (!dict.contains(key) || dict[key].is_none()) return otherwise;
  try {
    return dict[key].cast<T>();
  } catch (const py::cast_error&) {
    fail("'{}' has a value of the wrong type: please report it", key);
  }
}

// The same, and throws Error where there is none.
template <class T>
T need(const py::dict& dict, const char* key) {
  if (!dict.contains(key)) fail("'{}' is missing: please report it", key);
  return get<T>(dict, key, T{});
}

// A 4x4 matrix, which must be there.
glm::dmat4 wide_matrix(const py::dict& dict, const char* key);

// Members of a struct out of a dictionary that has their names: what is missing keeps its value.
class Members {
 public:
  // `owner` is what an artist calls the whole, for messages.
  Members(const py::dict& dict, std::string owner) : dict_(dict), owner_(std::move(owner)) {}

  template <class T>
  void read(const char* key, T& member) {
    known_.insert(key);
    member = get(dict_, key, member);
  }

  // A choice by one of `names`, which are those of the enumerators in their order.
  template <class E, size_t N>
  void read(const char* key, E& member, const std::array<std::string_view, N>& names) {
    std::string name(names[size_t(member)]);
    read(key, name);
    member = find_choice<E>(names, name);
    if (!known_choice(names, member))
      fail("'{}' of {} cannot be '{}': choose one of {}", key, owner_, name, fmt::join(names, ", "));
  }

  void read(const char* key, glm::dmat4& member) {
    known_.insert(key);
    member = wide_matrix(dict_, key);
  }

  // Calls `put(index, dictionary)` for each item of a list of `most` at most; returns how many there are.
  template <class Put>
  int read_list(const char* key, int most, const char* things, Put put) {
    py::list list;
    read(key, list);
    if (list.size() > size_t(most))
      fail("{} {} are more than can be used: choose {} at most", list.size(), things, most);
    int count = 0;
    for (const auto& item : list) put(count++, item.cast<py::dict>());
    return count;
  }

  // Throws Error when the dictionary holds what nobody has read.
  void check_all_known() const {
    for (const auto& item : dict_)
      if (const auto key = item.first.cast<std::string>(); !known_.count(key))
        fail("{} has no setting '{}': please report it", owner_, key);
  }

 private:
  py::dict dict_;
  std::string owner_;
  std::set<std::string> known_;
};

}  // namespace panoptes::python
