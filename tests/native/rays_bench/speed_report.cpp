#include "rays/comparison.h"
#include "rays_bench/reports.h"

#include <fmt/format.h>

#include <algorithm>

namespace panoptes::test {

namespace {

constexpr int kBuilds = 5;

// Columns of the tables of rays that code refers to.
enum { kName, kRate, kOfEmbree, kOfBvh, kDiffer = 7 };

// Embree in the ways that it is compared in: the first is the yardstick.
struct EmbreeKind {
  const char* name;
  bool robust;
  RTCBuildQuality quality;
};
constexpr EmbreeKind kEmbrees[] = {{"Embree medium", false, RTC_BUILD_QUALITY_MEDIUM},
                                   {"Embree low", false, RTC_BUILD_QUALITY_LOW},
                                   {"Embree robust", true, RTC_BUILD_QUALITY_MEDIUM}};

struct BuiltTracer {
  std::string name;
  std::unique_ptr<tracing::Tracer> tracer;
};

struct SceneBench {
  TracingDevice& device;
  const BenchOptions& options;
  const RayScene& scene;
  std::vector<std::unique_ptr<EmbreeScene>> embrees;
  std::vector<BuiltTracer> tracers;

  Table builds();
  Table trace(const RaySet& set);
};

Table SceneBench::builds() {
  Table table{fmt::format("{}: {} triangles", scene.name, scene.triangles.size()),
              {"build", "wall ms", "cpu ms", "MB"},
              {}};
  for (const EmbreeKind& kind : kEmbrees) {
    const int64_t before = EmbreeScene::bytes();
    embrees.push_back(std::make_unique<EmbreeScene>(scene.triangles, kind.robust, kind.quality));
    const double megabytes = double(EmbreeScene::bytes() - before) * 1e-6;
    const Milliseconds time = median_time(
        kBuilds, [&] { EmbreeScene(scene.triangles, kind.robust, kind.quality); });
    table.add({kind.name, time.wall, time.cpu, megabytes});
  }
  for (const TracerEntry& entry : chosen_tracers(options)) {
    BuiltTracer built{entry.name, entry.make(device.device())};
    device.build(*built.tracer);  // compiles
    const Milliseconds time = median_time(kBuilds, [&] { device.build(*built.tracer); });
    table.add({entry.name, time.wall, time.cpu, double(built.tracer->bytes()) * 1e-6});
    tracers.push_back(std::move(built));
  }
  return table;
}

Table SceneBench::trace(const RaySet& set) {
  Table table{fmt::format("{}, {}: {} rays{}", scene.name, set.name, set.rays.size(),
                          set.any_hit ? ", any hit" : ""),
              {"tracer", "Mrays/s", "of Embree", "of bvh", "steps", "tests", "dispatches", "differ",
               "judged", "structural"},
              {}};
  for (int d = 0; d < kDifferenceCount; ++d) table.columns.push_back(name_of(Difference(d)));
  const std::vector<TracedHit> reference = embrees.back()->trace(set.rays, set.any_hit);
  const auto rate = [&](const Milliseconds& time) {
    return double(set.rays.size()) * 1e-3 / fair(time, device.device());
  };
  for (size_t i = 0; i < embrees.size(); ++i) {
    std::vector<TracedHit> hits;
    const Milliseconds time =
        median_time(3, [&] { hits = embrees[i]->trace(set.rays, set.any_hit); });
    std::vector<Cell> row(table.columns.size());
    row[kName] = kEmbrees[i].name;
    row[kRate] = rate(time);
    row[kDiffer] = double(compare_with_embree(device, scene.triangles, set, hits, reference, 0).mismatches);
    table.add(std::move(row));
  }
  for (const BuiltTracer& built : tracers) {
    const Speed speed = trace_speed(device, *built.tracer, set.rays, set.any_hit);
    const Traced counted =
        device.trace(*built.tracer, set.rays, {.any_hit = set.any_hit, .count_work = true});
    double steps = 0, tests = 0;
    for (const TracedWork& work : counted.work) {
      steps += work.steps;
      tests += work.tests;
    }
    const double rays = double(set.rays.size());
    const Comparison found = compare_with_embree(device, scene.triangles, set, speed.hits,
                                                 reference, options.judged);
    std::vector<Cell> row{built.name, rate(speed.time), {}, {}, steps / rays, tests / rays,
                          double(counted.dispatches), double(found.mismatches),
                          double(found.judged), double(found.structural)};
    for (uint32_t count : found.differences) row.push_back(double(count));
    table.add(std::move(row));
    for (const std::string& example : found.examples)
      fmt::print(stderr, "{}: {}: {}\n", scene.name, built.name, example);
  }
  const auto rate_of = [&](const std::string& name) -> Cell {
    for (const auto& row : table.rows)
      if (std::get<std::string>(row[kName]) == name) return row[kRate];
    return {};
  };
  const Cell embree = rate_of(kEmbrees[0].name), bvh = rate_of(kYardstick);
  for (auto& row : table.rows) {
    const auto ratio = [&](const Cell& of) -> Cell {
      if (std::holds_alternative<double>(of)) return std::get<double>(row[kRate]) / std::get<double>(of);
      return {};
    };
    row[kOfEmbree] = ratio(embree);
    row[kOfBvh] = ratio(bvh);
  }
  return table;
}

}  // namespace

std::vector<Table> speed_report(TracingDevice& device, const BenchOptions& options) {
  std::vector<Table> tables;
  for (const std::string& name : options.scenes) {
    const RayScene scene = load_scene(name);
    device.assign(scene.triangles);
    SceneBench bench{device, options, scene, {}, {}};
    tables.push_back(bench.builds());
    for (const RaySet& set : all_rays(scene, *bench.embrees.back(), options.rays)) {
      const auto& wanted = options.sets;
      if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), set.name) == wanted.end())
        continue;
      if (!set.rays.empty()) tables.push_back(bench.trace(set));
    }
  }
  return tables;
}

}  // namespace panoptes::test
