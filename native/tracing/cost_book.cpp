#include "tracing/cost_book.h"

namespace panoptes::tracing {

namespace {

constexpr int64_t kLeastCount = 1000;

// Where nothing else is known, costs relate as in `./panoptes bench rays --scene atrium` on two
// cores: builds of 38 and 46 ms for 206 372 triangles, diffuse rays at 1.3 and 3 millions a second.
constexpr double kBuild = 190, kTrace = 770;  // of the orthographic structure, ns
constexpr double kHierarchyBuild = 1.2, kHierarchyTrace = 0.43;

double guess_build(const std::string& tracer) {
  return tracer == "bvh" ? kBuild * kHierarchyBuild : kBuild;
}
double guess_trace(const std::string& tracer) {
  return tracer == "bvh" ? kTrace * kHierarchyTrace : kTrace;
}

}  // namespace

void CostBook::learn(double& known, double measured) {
  known = known > 0 ? 0.5 * (known + measured) : measured;
}

void CostBook::add_build(const std::string& tracer, uint32_t triangles, double ms) {
  if (triangles >= kLeastCount) learn(costs_[tracer].build, ms * 1e6 / triangles);
}

void CostBook::add_trace(const std::string& tracer, int64_t rays, double ms) {
  if (rays >= kLeastCount) learn(costs_[tracer].trace, ms * 1e6 / double(rays));
}

std::string CostBook::choose(std::span<const std::string> candidates, const std::string& built,
                             uint32_t triangles, int64_t rays) const {
  // What one tracer has shown says how fast the device is, and so what the others may cost.
  double build_pace = 0, trace_pace = 0;
  int builds = 0, traces = 0;
  for (const auto& [name, cost] : costs_) {
    if (cost.build > 0) build_pace += cost.build / guess_build(name), ++builds;
    if (cost.trace > 0) trace_pace += cost.trace / guess_trace(name), ++traces;
  }
  build_pace = builds ? build_pace / builds : 1;
  trace_pace = traces ? trace_pace / traces : 1;

  const std::string* best = nullptr;
  double least = 0;
  for (const std::string& tracer : candidates) {
    const auto known = costs_.find(tracer);
    const Cost cost = known == costs_.end() ? Cost{} : known->second;
    const double build = cost.build > 0 ? cost.build : guess_build(tracer) * build_pace;
    const double trace = cost.trace > 0 ? cost.trace : guess_trace(tracer) * trace_pace;
    const double total = (tracer == built ? 0 : build * triangles) + trace * double(rays);
    if (!best || total < least) {
      best = &tracer;
      least = total;
    }
  }
  return *best;
}

}  // namespace panoptes::tracing
