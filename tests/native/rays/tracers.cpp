#include "rays/tracers.h"

#include "base/error.h"
#include "bvh_tracer/bvh_tracer.h"
#include "primitive_tracer/orthographic_tracer.h"
#include "rays/brute_force.h"

namespace panoptes::test {

namespace {

template <class T>
std::unique_ptr<tracing::Tracer> make(const gl::DeviceInfo&) {
  return std::make_unique<T>();
}

}  // namespace

const std::vector<TracerEntry>& tracers() {
  static const std::vector<TracerEntry> list = {
      {"brute force", make<BruteForceTracer>, true},
      {"orthographic", make<primitive_tracer::OrthographicTracer>},
      {"bvh",
       [](const gl::DeviceInfo& device) {
         return std::make_unique<bvh_tracer::BvhTracer>(device);
       }},
  };
  return list;
}

const TracerEntry& tracer_named(const std::string& name) {
  std::vector<std::string> names;
  for (const TracerEntry& entry : tracers()) {
    if (entry.name == name) return entry;
    names.push_back(entry.name);
  }
  fail("there is no ray tracer '{}': choose one of {}", name, fmt::join(names, ", "));
}

}  // namespace panoptes::test
