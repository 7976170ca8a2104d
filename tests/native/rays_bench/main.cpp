// Measures ray tracers beside Embree, by `./panoptes bench rays`.
#include "base/error.h"
#include "rays_bench/reports.h"

#include <cstdio>
#include <exception>
#include <utility>

namespace panoptes::test {
namespace {

void report(TracingDevice& device, const BenchOptions& options, const Emit& emit) {
  switch (options.report) {
    case BenchReport::kSpeed: return speed_report(device, options, emit);
    case BenchReport::kTable61: return table_6_1(device, options, emit);
    case BenchReport::kTable62: return table_6_2(device, options, emit);
    case BenchReport::kFigure611: return figure_6_11(device, options, emit);
    case BenchReport::kFigure612: return figure_6_12(device, options, emit);
    case BenchReport::kTable72: return table_7_2(device, options, emit);
    case BenchReport::kFigure711: return figure_7_11(device, options, emit);
    case BenchReport::kHardCases: return hard_cases_report(device, options, emit);
    case BenchReport::kTable71: return table_7_1(device, options, emit);
    case BenchReport::kTable73: return table_7_3(device, options, emit);
    case BenchReport::kFigure78: return figure_7_8(device, options, emit);
    case BenchReport::kFigure710: return figure_7_10(device, options, emit);
    case BenchReport::kDeform: return deform_report(device, options, emit);
  }
}

void run(const BenchOptions& options) {
  TracingDevice device;
  std::string name = device.device().renderer;
  if (!options.json) {
    report(device, options, [&name](const Table& table) {
      if (!name.empty()) fmt::print("{}\n", std::exchange(name, {}));  // above the first one
      fmt::print("\n{}", as_text(table));
      std::fflush(stdout);
    });
    return;
  }
  std::vector<Table> tables;
  report(device, options, [&tables](const Table& table) { tables.push_back(table); });
  std::fputs(as_json(name, tables).c_str(), stdout);
}

}  // namespace
}  // namespace panoptes::test

int main(int count, char** words) {
  using namespace panoptes::test;
  try {
    const BenchOptions options = parse_bench_options({words + 1, words + count});
    if (options.help)
      std::fputs(kBenchUsage, stdout);
    else
      run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "panoptes: {}\n", error.what());
    return 1;
  }
  return 0;
}
