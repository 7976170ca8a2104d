// All ray tracers by name: the tests and the benchmark try each of them.
#pragma once

#include "gl/context.h"
#include "tracing/tracer.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace panoptes::test {

struct TracerEntry {
  std::string name;
  std::function<std::unique_ptr<tracing::Tracer>(const gl::DeviceInfo&)> make;
  bool slow = false;  // only for scenes of few triangles
};

const std::vector<TracerEntry>& tracers();
// Throws Error, naming all, when there is none of that name.
const TracerEntry& tracer_named(const std::string& name);

}  // namespace panoptes::test
