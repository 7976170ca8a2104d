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
// The one that others are measured against, beside Embree.
constexpr const char* kYardstick = "BVH2";
// Throws Error, naming all, when there is none of that name.
const TracerEntry& tracer_named(const std::string& name);

// One setting of a structure that is made by rasterisation, to see what tiles and buckets cost.
struct TracerVariant {
  std::string tracer;
  int tiles;       // along a side
  double buckets;  // over depth: of a tile (linked lists), or for each triangle of one
  std::function<std::unique_ptr<tracing::Tracer>()> make;
};
std::vector<TracerVariant> tracer_variants();

}  // namespace panoptes::test
