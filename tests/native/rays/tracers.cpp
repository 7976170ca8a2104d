#include "rays/tracers.h"

#include "base/error.h"
#include "bvh_tracer/bvh_tracer.h"
#include "primitive_tracer/cube_tracer.h"
#include "primitive_tracer/orthographic_tracer.h"
#include "rays/brute_force.h"

#include <fmt/ranges.h>

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
      {"cube", make<primitive_tracer::CubeTracer>},
      {"cube, linked lists",
       [](const gl::DeviceInfo&) {
         return std::make_unique<primitive_tracer::CubeTracer>(
             primitive_tracer::CubeSettings{.linked_lists = true});
       }},
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
  const auto add_cube = [&](const primitive_tracer::CubeSettings& settings, double buckets) {
    variants.push_back(
        {settings.linked_lists ? "cube, linked lists" : "cube", settings.tiles, buckets,
         [settings] { return std::make_unique<primitive_tracer::CubeTracer>(settings); }});
  };
  for (int tiles : {64, 128, 256}) {
    for (int buckets : {8, 16, 32})
      add_cube({.tiles = tiles, .linked_lists = true, .buckets = buckets}, buckets);
    for (float buckets : {0.5f, 1.0f, 2.0f})
      add_cube({.tiles = tiles, .buckets_per_triangle = buckets}, double(buckets));
  }
  return variants;
}

}  // namespace panoptes::test
