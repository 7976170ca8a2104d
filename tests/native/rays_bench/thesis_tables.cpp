#include "primitive_tracer/cube_tracer.h"
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

void table_7_3(TracingDevice& device, const BenchOptions& options, const Emit& emit) {
  // Bytes, from the thesis' table and the text below it.
  constexpr double kNode = 8, kBounds = 8, kHead = 4, kHit = 4 + 32;
  primitive_tracer::CubeSettings settings;
  settings.linked_lists = true;
  for (const std::string& name : options.scenes) {
    const RayScene scene = load_scene(name);
    device.assign(scene.triangles);
    primitive_tracer::CubeTracer tracer(settings);
    device.build(tracer);
    const auto parts = tracer.bytes_of_parts();
    const double tiles = 6.0 * tracer.tiles() * tracer.tiles(), ids = tracer.counts().ids;
    Table table{
        fmt::format("Table 7.3, {}: the cube with linked lists, 6 x {} x {} tiles, {} buckets; "
                    "c n_p = {:.3g} a tile",
                    scene.name, tracer.tiles(), tracer.tiles(), settings.buckets, ids / tiles),
        {"memory", "formula", "MB by formula", "MB allocated"},
        {}};
    table.add({"depth bounds, mipmapped", "8 x 1.33 a tile", kMega * tiles * kBounds * 4 / 3,
               kMega * double(parts.depth_bounds)});
    table.add({"id buffer: buckets", "4 B a tile", kMega * tiles * kHead * settings.buckets,
               kMega * double(parts.buckets)});
    table.add(
        {"id buffer: lists", "8 c n_p a tile", kMega * ids * kNode, kMega * double(parts.ids)});
    table.add({"hit buffer", "4 + 32 a ray", kMega * options.rays * kHit,
               kMega * options.rays * double(sizeof(TracedHit))});
    table.add({"rays", "none", 0.0, kMega * options.rays * double(sizeof(TracedRay))});
    emit(table);
  }
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
