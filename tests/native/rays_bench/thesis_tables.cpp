#include "rays/ray_sets.h"
#include "rays_bench/reports.h"

#include <fmt/format.h>

#include <algorithm>

namespace panoptes::test {

namespace {

constexpr int kBuilds = 3;
constexpr double kMega = 1e-6;

// Mrays/s; nothing for an empty set.
Cell mrays(TracingDevice& device, const tracing::Tracer& tracer, const RaySet& set) {
  if (set.rays.empty()) return {};
  const Speed speed = trace_speed(device, tracer, set.rays, set.any_hit);
  return double(set.rays.size()) * 1e-3 / fair(speed.time, device.device());
}

}  // namespace

void table_7_1(TracingDevice& device, const BenchOptions& options, const Emit& emit) {
  const std::vector<std::string> kinds{"visibility", "specular", "glossy", "diffuse"};
  Table table{"Table 7.1: Mrays/s by kind of ray", {"scene", "primitives", "tracer"}, {}};
  table.columns.insert(table.columns.end(), kinds.begin(), kinds.end());
  for (const std::string& name : options.scenes) {
    const RayScene scene = load_scene(name);
    const EmbreeScene embree(scene.triangles);
    const std::vector<RaySet> sets = secondary_rays(scene, embree, options.rays);
    device.assign(scene.triangles);
    for (const TracerEntry& entry : chosen_tracers(options)) {
      const auto tracer = entry.make(device.device());
      device.build(*tracer);
      std::vector<Cell> row{scene.name, double(scene.triangles.size()), entry.name};
      for (const std::string& kind : kinds)
        for (const RaySet& set : sets)
          if (set.name == kind) row.push_back(mrays(device, *tracer, set));
      table.add(std::move(row));
    }
  }
  emit(table);
}

void figure_7_10(TracingDevice& device, const BenchOptions& options, const Emit& emit) {
  for (const std::string& name : options.scenes) {
    const RayScene scene = load_scene(name);
    const EmbreeScene embree(scene.triangles);
    device.assign(scene.triangles);
    const RaySet primary = primary_rays(scene, options.rays);
    const std::vector<RaySet> secondary = secondary_rays(scene, embree, options.rays);
    Table table{fmt::format("Figure 7.10, {}: {} triangles", scene.name, scene.triangles.size()),
                {"tracer", "tiles", "buckets", "MB", "build ms", "primary Mrays/s"},
                {}};
    for (const RaySet& set : secondary) table.columns.push_back(set.name);
    for (const TracerVariant& variant : tracer_variants()) {
      const auto& wanted = options.tracers;
      if (!wanted.empty() &&
          std::find(wanted.begin(), wanted.end(), variant.tracer) == wanted.end())
        continue;
      const auto tracer = variant.make();
      device.build(*tracer);
      const double build =
          fair(median_time(kBuilds, [&] { device.build(*tracer); }), device.device());
      std::vector<Cell> row{variant.tracer,  double(variant.tiles),
                            variant.buckets, double(tracer->bytes()) * kMega,
                            build,           mrays(device, *tracer, primary)};
      for (const RaySet& set : secondary) row.push_back(mrays(device, *tracer, set));
      table.add(std::move(row));
    }
    emit(table);
  }
}

}  // namespace panoptes::test
