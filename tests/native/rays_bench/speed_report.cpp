#include "rays/comparison.h"
#include "rays_bench/reports.h"

#include <fmt/format.h>

#include <algorithm>

namespace panoptes::test {

namespace {

constexpr int kBuilds = 5;

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

// What one tracer did with one set.
struct SetRun {
  std::string name;
  double rate = 0;  // Mrays/s
  std::vector<TracedHit> hits;
  std::vector<Cell> work{{}, {}, {}};  // steps and tests a ray, dispatches
};

struct SceneBench {
  TracingDevice& device;
  const BenchOptions& options;
  const RayScene& scene;
  std::vector<std::unique_ptr<EmbreeScene>> embrees;
  std::vector<BuiltTracer> tracers;

  Table builds();
  SetRun run(size_t embree, const RaySet& set);
  SetRun run(const BuiltTracer& built, const RaySet& set);
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
    const Milliseconds time =
        median_time(kBuilds, [&] { EmbreeScene(scene.triangles, kind.robust, kind.quality); });
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

SetRun SceneBench::run(size_t embree, const RaySet& set) {
  SetRun run;
  run.name = kEmbrees[embree].name;
  const Milliseconds time =
      least_time([&] { run.hits = embrees[embree]->trace(set.rays, set.any_hit); });
  run.rate = double(set.rays.size()) * 1e-3 / fair(time, device.device());
  return run;
}

SetRun SceneBench::run(const BuiltTracer& built, const RaySet& set) {
  Speed speed = trace_speed(device, *built.tracer, set.rays, set.any_hit);
  const Traced counted =
      device.trace(*built.tracer, set.rays, {.any_hit = set.any_hit, .count_work = true});
  double steps = 0, tests = 0;
  for (const TracedWork& work : counted.work) {
    steps += work.steps;
    tests += work.tests;
  }
  const double rays = double(set.rays.size());
  return {built.name,
          rays * 1e-3 / fair(speed.time, device.device()),
          std::move(speed.hits),
          {steps / rays, tests / rays, double(counted.dispatches)}};
}

Table SceneBench::trace(const RaySet& set) {
  std::vector<SetRun> runs;
  for (size_t i = 0; i < embrees.size(); ++i) runs.push_back(run(i, set));
  for (const BuiltTracer& built : tracers) runs.push_back(run(built, set));
  const SetRun &embree = runs.front(), &robust = runs[embrees.size() - 1];
  const auto yardstick = std::find_if(runs.begin(), runs.end(),
                                      [](const SetRun& run) { return run.name == kYardstick; });

  Table table{fmt::format("{}, {}: {} rays{}", scene.name, set.name, set.rays.size(),
                          set.any_hit ? ", any hit" : ""),
              {"tracer", "Mrays/s", "of Embree", "of BVH2", "steps", "tests", "dispatches",
               "unlike BVH2", "differ", "judged", "structural"},
              {}};
  for (int d = 0; d < kDifferenceCount; ++d) table.columns.push_back(name_of(Difference(d)));
  for (size_t i = 0; i < runs.size(); ++i) {
    const SetRun& run = runs[i];
    const bool ours = i >= embrees.size();
    const Comparison found = compare_with_embree(device, scene.triangles, set, run.hits,
                                                 robust.hits, ours ? options.judged : 0);
    std::vector<Cell> row{run.name, run.rate, run.rate / embree.rate, {}};
    if (yardstick != runs.end()) row.back() = run.rate / yardstick->rate;
    row.insert(row.end(), run.work.begin(), run.work.end());
    row.push_back({});
    if (ours && yardstick != runs.end())
      row.back() = double(count_unlike(run.hits, yardstick->hits, set.any_hit));
    row.push_back(double(found.mismatches));
    if (ours) {
      row.insert(row.end(), {double(found.judged), double(found.structural)});
      for (uint32_t count : found.differences) row.push_back(double(count));
    }
    row.resize(table.columns.size());
    table.add(std::move(row));
    for (const std::string& example : found.examples)
      fmt::print(stderr, "{}: {}: {}\n", scene.name, run.name, example);
  }
  return table;
}

}  // namespace

void speed_report(TracingDevice& device, const BenchOptions& options, const Emit& emit) {
  for (const std::string& name : options.scenes) {
    const RayScene scene = load_scene(name);
    device.assign(scene.triangles);
    SceneBench bench{device, options, scene, {}, {}};
    emit(bench.builds());
    for (const RaySet& set : all_rays(scene, *bench.embrees.back(), options.rays)) {
      const auto& wanted = options.sets;
      if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), set.name) == wanted.end())
        continue;
      if (!set.rays.empty()) emit(bench.trace(set));
    }
  }
}

}  // namespace panoptes::test
