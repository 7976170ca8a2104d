// The command line of the benchmark.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace panoptes::test {

enum class BenchReport {
  kSpeed, kTable61, kTable62, kFigure611, kFigure612, kTable71, kTable72, kTable73, kFigure78, kFigure710, kFigure711,
  kDeform, kHardCases
};

struct BenchOptions {
  BenchReport report = BenchReport::kSpeed;
  uint32_t rays = 1'000'000;         // a set
  uint32_t judged = 200;             // differences of a set that are looked into
  std::vector<std::string> scenes;   // names of generated scenes, or paths of snapshots
  std::vector<std::string> tracers;  // empty: all but the slow ones
  std::vector<std::string> sets;     // empty: all
  bool json = false;
  bool help = false;
};

extern const char* const kBenchUsage;

// Throws Error with a sentence for a command line that cannot work.
BenchOptions parse_bench_options(const std::vector<std::string>& words);

}  // namespace panoptes::test
