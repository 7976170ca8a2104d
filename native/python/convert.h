// From Python's values to the engine's structs. Every conversion copies and throws panoptes::Error
// with the name of what was wrong.
#pragma once

#include "engine/engine.h"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

namespace panoptes::python {

namespace py = pybind11;

template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

// A C-contiguous array of T as a span of V, each `columns` values. Checks the shape (rows, columns).
template <class V, class T>
std::span<const V> rows(const Array<T>& array, const char* name, int columns);

scene::TextureUse texture_use(const py::tuple& tuple);
std::vector<scene::TextureUse> texture_uses(const py::list& list);
scene::Light light(const py::dict& dict);
glm::mat4 matrix(const Array<float>& row_major, const char* name);
std::vector<glm::vec4> params(const Array<float>& array);
scene::AlphaMode alpha_mode(const std::string& name);
engine::RenderRequest request(const py::dict& dict);
engine::TakeOver take_over(const py::dict& dict);

}  // namespace panoptes::python

#include "base/error.h"

namespace panoptes::python {

template <class V, class T>
std::span<const V> rows(const Array<T>& array, const char* name, int columns) {
  static_assert(sizeof(V) % sizeof(T) == 0);
  const py::ssize_t total = array.size();
  const bool shaped = columns == 1 ? array.ndim() == 1
                                   : array.ndim() == 2 && array.shape(1) == columns;
  if (!shaped && total != 0)
    fail("array '{}' must have shape (N{}): please report it", name,
         columns == 1 ? "" : fmt::format(", {}", columns));
  return {reinterpret_cast<const V*>(array.data()), size_t(total) * sizeof(T) / sizeof(V)};
}

}  // namespace panoptes::python
