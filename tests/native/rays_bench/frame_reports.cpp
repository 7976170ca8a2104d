// What a frame costs where geometry changes in each: the structure is built anew, then every
// pixel's rays are traced.
#include "rays/ray_sets.h"
#include "rays_bench/reports.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace panoptes::test {

namespace {

// Of one way to trace, in milliseconds.
struct FrameCost {
  double build = 0;
  std::map<std::string, double> trace;  // by set
};
using FrameCosts = std::vector<std::pair<std::string, FrameCost>>;

constexpr const char* kSets[] = {"primary", "shadow", "diffuse"};
constexpr int kBuilds = 3;

FrameCost embree_cost(TracingDevice& device, const RayScene& scene, const std::vector<RaySet>& sets,
                      RTCBuildQuality quality) {
  FrameCost cost;
  cost.build = fair(median_time(kBuilds, [&] { EmbreeScene(scene.triangles, false, quality); }),
                    device.device());
  const EmbreeScene embree(scene.triangles, false, quality);
  for (const RaySet& set : sets)
    cost.trace[set.name] =
        fair(median_time(kBuilds, [&] { embree.trace(set.rays, set.any_hit); }), device.device());
  return cost;
}

// Of all chosen tracers, of Embree, and of tracing with our hierarchy what Embree would build: the
// fastest builder of such trees there is.
FrameCosts frame_costs(TracingDevice& device, const BenchOptions& options, const RayScene& scene,
                       uint32_t rays) {
  const EmbreeScene reference(scene.triangles);
  std::vector<RaySet> sets;
  for (RaySet& set : all_rays(scene, reference, rays))
    for (const char* name : kSets)
      if (set.name == name) sets.push_back(std::move(set));
  device.assign(scene.triangles);
  FrameCosts costs;
  for (const TracerEntry& entry : chosen_tracers(options)) {
    const auto tracer = entry.make(device.device());
    device.build(*tracer);  // compiles
    FrameCost cost;
    cost.build = fair(median_time(kBuilds, [&] { device.build(*tracer); }), device.device());
    for (const RaySet& set : sets)
      cost.trace[set.name] =
          fair(trace_speed(device, *tracer, set.rays, set.any_hit).time, device.device());
    costs.emplace_back(entry.name, cost);
  }
  const FrameCost low = embree_cost(device, scene, sets, RTC_BUILD_QUALITY_LOW);
  for (size_t i = 0; i < costs.size(); ++i)
    if (costs[i].first == kYardstick) {
      costs.push_back({"Embree low builds, BVH2 traces", costs[i].second});
      costs.back().second.build = low.build;
      break;
    }
  costs.emplace_back("Embree low", low);
  costs.emplace_back("Embree medium", embree_cost(device, scene, sets, RTC_BUILD_QUALITY_MEDIUM));
  return costs;
}

}  // namespace

void figure_7_8(TracingDevice& device, const BenchOptions& options, const Emit& emit) {
  for (const std::string& name : options.scenes) {
    const RayScene scene = load_scene(name);
    Table table{fmt::format("Figure 7.8, {}: {} triangles, ms a frame", scene.name,
                            scene.triangles.size()),
                {"tracer", "side", "build", "primary + shadow", "frame", "primary + diffuse",
                 "frame", "and 2 shadow", "frame"},
                {}};
    const uint32_t most = uint32_t(std::sqrt(double(options.rays)));
    for (uint32_t side = std::max(most / 8, 8u); side <= most; side *= 2)
      for (const auto& [tracer, cost] : frame_costs(device, options, scene, side * side)) {
        const auto ms = [&cost](const char* set) {
          const auto found = cost.trace.find(set);
          return found == cost.trace.end() ? 0.0 : found->second;
        };
        const double direct = ms("primary") + ms("shadow"), paths = ms("primary") + ms("diffuse");
        const double both = paths + 2 * ms("shadow");
        table.add({tracer, double(side), cost.build, direct, cost.build + direct, paths,
                   cost.build + paths, both, cost.build + both});
      }
    emit(table);
  }
}

void deform_report(TracingDevice& device, const BenchOptions& options, const Emit& emit) {
  std::vector<RayScene> frames;
  for (const std::string& name : options.scenes) frames.push_back(load_scene(name));
  if (frames.empty())
    for (int frame = 0; frame < 4; ++frame) frames.push_back(blob(0.3f * float(frame)));

  FrameCosts sums;
  for (const RayScene& frame : frames) {
    const FrameCosts costs = frame_costs(device, options, frame, options.rays);
    if (sums.empty())
      for (const auto& [tracer, cost] : costs) sums.push_back({tracer, {}});
    for (size_t i = 0; i < costs.size(); ++i) {
      sums[i].second.build += costs[i].second.build / double(frames.size());
      for (const auto& [set, ms] : costs[i].second.trace)
        sums[i].second.trace[set] += ms / double(frames.size());
    }
  }
  Table
      table{fmt::format("{} deforming, mean of {} frames: {} triangles, {} rays a set, ms a frame",
                        frames.front().name, frames.size(), frames.front().triangles.size(),
                        options.rays),
            {"tracer", "build", "primary", "shadow", "diffuse", "frame"},
            {}};
  for (auto& [tracer, cost] : sums) {
    const double primary = cost.trace["primary"], shadow = cost.trace["shadow"],
                 diffuse = cost.trace["diffuse"];
    table.add(
        {tracer, cost.build, primary, shadow, diffuse, cost.build + primary + shadow + diffuse});
  }
  emit(table);
}

}  // namespace panoptes::test
