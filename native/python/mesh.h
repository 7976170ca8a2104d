// Meshes in Python: made from plain arrays or read from Blender's memory, then handed to an engine.
#pragma once

#include "python/convert.h"

namespace panoptes::python {

// Adds the type Mesh, what makes one, and Engine.set_mesh().
void bind_meshes(py::module_& m, py::class_<engine::Engine>& engine);

}  // namespace panoptes::python
