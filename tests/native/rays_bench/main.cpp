// Measures ray tracers beside Embree, by `./panoptes bench rays`.
#include "base/error.h"
#include "rays_bench/reports.h"

#include <cstdio>
#include <exception>

namespace panoptes::test {
namespace {

std::vector<Table> report(TracingDevice& device, const BenchOptions& options) {
  switch (options.report) {
    case BenchReport::kSpeed: return speed_report(device, options);
    case BenchReport::kTable71: return table_7_1(device, options);
    case BenchReport::kFigure78: return figure_7_8(device, options);
    case BenchReport::kFigure710: return figure_7_10(device, options);
    case BenchReport::kDeform: return deform_report(device, options);
  }
  return {};
}

void run(const BenchOptions& options) {
  TracingDevice device;
  const std::string name = device.device().renderer;
  const std::vector<Table> tables = report(device, options);
  if (options.json) {
    std::fputs(as_json(name, tables).c_str(), stdout);
    return;
  }
  fmt::print("{}\n", name);
  for (const Table& table : tables) fmt::print("\n{}", as_text(table));
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
