#include "rays_bench/options.h"

#include "base/error.h"
#include "rays/scenes.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace panoptes::test {

const char* const kBenchUsage =
    "usage: ./panoptes bench rays [options]\n"
    "Builds and traces with each ray tracer beside Embree and compares what they find.\n"
    "\n"
    "  --scene NAME|FILE     a generated scene (atrium, box_room, soup, blob, grass), a .blend\n"
    "                        or a snapshot; may be repeated. Default: all that are generated\n"
    "  --tracer NAME         one tracer; may be repeated. Default: all\n"
    "  --set NAME            one set of rays; may be repeated. Default: all\n"
    "  --rays N              rays a set (default 1000000)\n"
    "  --judge N             differences from Embree that are looked into, a set (default 200)\n"
    "  --table 7.1 | 7.3     the thesis' tables with our figures: rays of all kinds; memory\n"
    "  --figure 7.8 | 7.10   its figures: frames of growing size; buckets and tiles\n"
    "  --table 6.1 | 6.2 | 7.2    fragments: what they cost; bytes of storages; beside primitives\n"
    "  --figure 6.11 | 6.12 | 7.11  beside spatial structures; storages; memory by resolution\n"
    "  --hard-cases          what fragments lose and make up in the catalogue of hard cases\n"
    "  --deform              frames of a deforming scene, each built anew: give them in order\n"
    "                        by --scene, or one .blend with --frames FIRST:LAST\n"
    "  --json                print JSON\n";

namespace {

constexpr std::pair<const char*, BenchReport> kThesisReports[] = {
    {"table 6.1", BenchReport::kTable61},    {"table 6.2", BenchReport::kTable62},
    {"table 7.1", BenchReport::kTable71},    {"table 7.2", BenchReport::kTable72},
    {"table 7.3", BenchReport::kTable73},    {"figure 6.11", BenchReport::kFigure611},
    {"figure 6.12", BenchReport::kFigure612}, {"figure 7.8", BenchReport::kFigure78},
    {"figure 7.10", BenchReport::kFigure710}, {"figure 7.11", BenchReport::kFigure711}};

uint32_t whole(const std::string& option, const std::string& text) {
  size_t used = 0;
  unsigned long value = 0;
  try {
    value = std::stoul(text, &used);
  } catch (const std::exception&) {
  }
  if (used != text.size() || value < 1 || value > 2'000'000)
    fail("{} takes a whole number from 1 to 2000000, not '{}': see --help", option, text);
  return uint32_t(value);
}

}  // namespace

BenchOptions parse_bench_options(const std::vector<std::string>& words) {
  BenchOptions o;
  for (size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    const auto value = [&]() -> const std::string& {
      if (i + 1 >= words.size()) fail("{} needs a value: see --help", word);
      return words[++i];
    };
    if (word == "--scene")
      o.scenes.push_back(value());
    else if (word == "--tracer")
      o.tracers.push_back(value());
    else if (word == "--set")
      o.sets.push_back(value());
    else if (word == "--rays")
      o.rays = whole(word, value());
    else if (word == "--judge")
      o.judged = whole(word, value());
    else if (word == "--deform")
      o.report = BenchReport::kDeform;
    else if (word == "--hard-cases")
      o.report = BenchReport::kHardCases;
    else if (word == "--json")
      o.json = true;
    else if (word == "-h" || word == "--help")
      o.help = true;
    else if (word == "--table" || word == "--figure") {
      const std::string which = word.substr(2) + " " + value();
      const auto* found = std::find_if(std::begin(kThesisReports), std::end(kThesisReports),
                                       [&](const auto& one) { return which == one.first; });
      if (found == std::end(kThesisReports))
        fail("there is no report for {}: choose --table 6.1, 6.2, 7.1, 7.2, 7.3 or --figure 6.11, 6.12, 7.8, 7.10, 7.11",
             which);
      o.report = found->second;
    } else
      fail("bench rays does not know '{}': see --help", word);
  }
  if (o.scenes.empty() && o.report != BenchReport::kDeform) o.scenes = generated_scene_names();
  return o;
}

}  // namespace panoptes::test
