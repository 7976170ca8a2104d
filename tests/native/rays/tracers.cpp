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
      {"BVH2",
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

std::vector<TracerVariant> tracer_variants() {
  std::vector<TracerVariant> variants;
  for (int tiles : {64, 128, 256})
    for (int buckets : {1, 2, 4, 8}) {
      primitive_tracer::OrthographicSettings settings;
      settings.tiles = tiles;
      settings.buckets_per_triangle = buckets;
      variants.push_back({"orthographic", tiles, double(buckets), [settings] {
                            return std::make_unique<primitive_tracer::OrthographicTracer>(settings);
                          }});
    }
  return variants;
}

}  // namespace panoptes::test
