// What a frame is asked for, and what it reports.
#include "base/error.h"
#include "json.h"
#include "support.h"

#include <limits>

namespace panoptes::test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

engine::RenderRequest good() { return request(perspective({0, 0, 0}, {1, 0, 0}, 1, 8, 8), {}); }

TEST(RequestCheck, AcceptsTheLimits) {
  EXPECT_NO_THROW(good().check());
  engine::RenderRequest r = good();
  r.shadow_resolution = 16;
  r.filter_width = 0;
  r.exposure = 0;
  EXPECT_NO_THROW(r.check());
  r.shadow_resolution = 8192;
  r.filter_width = 10;
  r.exposure = -1;
  r.first_sample = 0xfffffffe;
  r.last_sample = 0xffffffff;
  EXPECT_NO_THROW(r.check());
}

template <class F>
void expect_refused(F change, const std::string& part) {
  engine::RenderRequest r = good();
  change(r);
  expect_error([&] { r.check(); }, part);
}

TEST(RequestCheck, RefusesWhatMakesNoSense) {
  expect_refused([](auto& r) { r.debug_picture = ray_picture::Kind(17); }, "debug picture number 17");
  expect_refused([](auto& r) { r.structure.structure = engine::Structure(9); }, "structure number 9");
  expect_refused([](auto& r) { r.structure.tiles = 2000; }, "2000 tiles");
  expect_refused([](auto& r) { r.structure.buckets = -1; }, "-1 buckets");
  expect_refused([](auto& r) { r.last_sample = 0; }, "at least one sample");
  expect_refused([](auto& r) { r.first_sample = r.last_sample = 5; }, "at least one sample");
  expect_refused([](auto& r) { r.first_sample = 7; }, "at least one sample");
  for (int resolution : {0, -5, 15, 8193, std::numeric_limits<int>::max()})
    expect_refused([&](auto& r) { r.shadow_resolution = resolution; }, "shadow resolution");
  for (double width : {-0.1, 10.1, kNaN, kInf})
    expect_refused([&](auto& r) { r.filter_width = float(width); }, "pixel filter");
  for (double exposure : {kNaN, kInf, -kInf})
    expect_refused([&](auto& r) { r.exposure = float(exposure); }, "exposure");
  for (double budget : {-1.0, kNaN}) {
    expect_refused([&](auto& r) { r.time_budget = budget; }, "budget");
    expect_refused([&](auto& r) { r.noise_threshold = budget; }, "threshold");
  }
  expect_refused([](auto& r) { r.shown_pass = film::Pass::kCount; }, "no picture of the pass");
  expect_refused([](auto& r) { r.shown_pass = film::Pass::kDepth; }, "no picture of the pass");
  expect_refused([](auto& r) { r.shown_pass = film::Pass::kNormal; }, "'Normal' is to be shown, but not rendered");
  expect_refused(
      [](auto& r) {
        r.shown_pass = film::Pass::kNormal;
        r.passes.set(size_t(r.shown_pass));
        r.debug_picture = ray_picture::Kind::kSteps;
      },
      "debug picture");
  expect_refused([](auto& r) { r.pieces = true, r.noise_threshold = 0.1; }, "cannot be merged");
}

engine::RenderStats stats() {
  engine::RenderStats s;
  s.device = "llvmpipe (LLVM 15, 256 bits)";
  s.width = 3;
  s.height = 2;
  s.samples = 7;
  s.effects.push_back({{"sun_shadows", true, "2 sun lamps cast shadows"}, 1.25});
  s.effects.push_back({{"glossy", false, "no material reflects"}, 0});
  s.passes = {{"compose", 0.5}, {"surfaces", 12}};
  s.build_ms = 1.5;
  s.trace_ms = 2.5;
  s.total_ms = 4.25;
  s.cache = {.cells = 5, .lattice = 64};
  s.memory_bytes = 1LL << 40;
  s.estimated_error = 0.0625;
  s.warnings = {"a", "b"};
  return s;
}

TEST(StatsJson, HoldsTheStatistics) {
  const Json j = parse_json(stats().to_json());
  EXPECT_EQ(j.at("device").text, "llvmpipe (LLVM 15, 256 bits)");
  EXPECT_EQ(j.at("size").list.at(0).number, 3);
  EXPECT_EQ(j.at("size").list.at(1).number, 2);
  EXPECT_EQ(j.at("samples").number, 7);
  EXPECT_EQ(j.at("build_ms").number, 1.5);
  EXPECT_EQ(j.at("trace_ms").number, 2.5);
  EXPECT_EQ(j.at("total_ms").number, 4.25);
  EXPECT_EQ(j.at("rays").number, 0);
  EXPECT_EQ(j.at("cache").at("cells").number, 5);
  EXPECT_EQ(j.at("cache").at("lattice").number, 64);
  EXPECT_EQ(j.at("memory_bytes").number, double(1LL << 40));
  EXPECT_EQ(j.at("estimated_error").number, 0.0625);
  ASSERT_EQ(j.at("effects").list.size(), 2u);
  const Json& effect = j.at("effects").list[0];
  EXPECT_EQ(effect.at("name").text, "sun_shadows");
  EXPECT_EQ(effect.at("runs").text, "true");
  EXPECT_EQ(effect.at("reason").text, "2 sun lamps cast shadows");
  EXPECT_EQ(effect.at("ms").number, 1.25);
  EXPECT_EQ(j.at("effects").list[1].at("runs").text, "false");
  EXPECT_EQ(j.at("passes").list.at(1).at("name").text, "surfaces");
  EXPECT_EQ(j.at("passes").list.at(1).at("ms").number, 12);
  EXPECT_EQ(j.at("warnings").list.at(1).text, "b");
}

TEST(StatsJson, KnowsNoErrorWithoutMoments) {
  engine::RenderStats s = stats();
  s.estimated_error.reset();
  EXPECT_EQ(parse_json(s.to_json()).at("estimated_error").text, "null");
  EXPECT_NO_THROW(parse_json(engine::RenderStats().to_json()));
}

TEST(StatsJson, EscapesWhatJsonMustNotHold) {
  engine::RenderStats s = stats();
  const std::string nasty = "quote \" backslash \\ newline \n tab \t bell \x07 unit \x1f Käse";
  s.warnings = {nasty};
  s.device = "\"";
  const Json j = parse_json(s.to_json());
  EXPECT_EQ(j.at("warnings").list.at(0).text, nasty);
  EXPECT_EQ(j.at("device").text, "\"");
}

TEST(StatsJson, HasNoNumbersThatJsonDoesNotKnow) {
  for (double value : {kInf, -kInf, kNaN}) {
    engine::RenderStats s = stats();
    s.estimated_error = value;
    EXPECT_NO_THROW(parse_json(s.to_json())) << s.to_json();
  }
}

}  // namespace
}  // namespace panoptes::test
