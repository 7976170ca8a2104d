// The tables and figures of chapters 6 and 7 about fragments: what they cost in memory and time, and what they lose.
#include "base/error.h"
#include "fragment_tracer/fragment_tracer.h"
#include "primitive_tracer/cube_tracer.h"
#include "rays/brute_force.h"
#include "rays/comparison.h"
#include "rays/hard_cases.h"
#include "rays_bench/reports.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace panoptes::test {

namespace {

using fragment_tracer::Bounds;
using fragment_tracer::CameraView;
using fragment_tracer::FragmentTracer;
using fragment_tracer::Settings;
using fragment_tracer::Storage;
using fragment_tracer::Views;
using fragment_tracer::Walk;

constexpr double kMega = 1e-6;
constexpr int kBuilds = 3;
// Pixels a side of the cube's faces, and across the camera's view where nothing else is said.
constexpr int kSide = 256;

struct Eye {
  glm::vec3 position;
  CameraView view;
};

// The scene's camera, so many pixels across its wider side.
Eye eye_of(const RayScene& scene, int across) {
  const glm::dmat4 to_scene = glm::inverse(scene.camera_from_scene);
  const glm::dvec2 half(1 / scene.projection[0][0], 1 / scene.projection[1][1]);
  Eye eye{glm::vec3(glm::dvec3(to_scene[3])), {}};
  eye.view.right = glm::normalize(glm::vec3(glm::dvec3(to_scene[0])));
  eye.view.up = glm::normalize(glm::vec3(glm::dvec3(to_scene[1])));
  eye.view.forward = -glm::normalize(glm::vec3(glm::dvec3(to_scene[2])));
  eye.view.half_extent = glm::vec2(half);
  eye.view.size = glm::max(glm::ivec2(glm::round(double(across) * half / std::max(half.x, half.y))), glm::ivec2(1));
  return eye;
}

FragmentTracer fragments_of(const RayScene& scene, const Settings& settings) {
  const Eye eye = eye_of(scene, settings.side);
  return FragmentTracer(settings, eye.position, eye.view);
}

std::vector<TracedRay> diffuse_rays(const RayScene& scene, uint32_t count) {
  for (RaySet& set : secondary_rays(scene, EmbreeScene(scene.triangles), count))
    if (set.name == "diffuse") return std::move(set.rays);
  return {};
}

double build_ms(TracingDevice& device, tracing::Tracer& tracer) {
  device.build(tracer);  // compiles, and finds how much room it needs
  return fair(median_time(kBuilds, [&] { device.build(tracer); }), device.device());
}

double trace_ms(TracingDevice& device, const tracing::Tracer& tracer, const std::vector<TracedRay>& rays) {
  return fair(trace_speed(device, tracer, rays, false).time, device.device());
}

double total_bytes(const FragmentTracer::Bytes& parts) { return double(parts.pixels + parts.fragments + parts.data); }

// Means over rays of what they looked into.
struct Work {
  double cells = 0, tests = 0;
};
Work work_of(TracingDevice& device, const tracing::Tracer& tracer, const std::vector<TracedRay>& rays) {
  Work sum;
  for (const shared::TracedWork& one : device.trace(tracer, rays, {.count_work = true}).work) {
    sum.cells += one.steps;
    sum.tests += one.tests;
  }
  const double count = std::max<double>(1, double(rays.size()));
  return {sum.cells / count, sum.tests / count};
}

}  // namespace

void table_6_1(TracingDevice& device, const BenchOptions& options, const Emit& emit) {
  Table table{fmt::format("Table 6.1: DLLB in the camera's view and six of {0} x {0}, {1} diffuse rays", kSide, options.rays),
              {"scene", "triangles", "fragments", "average layers", "most layers", "MB", "build ms", "exact bounds ms",
               "boxes ms", "cells a ray", "fragments a ray", "spared by skipping", "trace ms", "without skipping ms"},
              {}};
  for (const std::string& name : options.scenes) {
    const RayScene scene = load_scene(name);
    device.assign(scene.triangles);
    const std::vector<TracedRay> rays = diffuse_rays(scene, options.rays);
    Settings settings;
    settings.side = kSide;
    // Layers are those of whole pixels.
    settings.storage = Storage::kDoubleList;
    FragmentTracer whole = fragments_of(scene, settings);
    device.build(whole);
    settings.storage = Storage::kDoubleBucketList;
    // As in the thesis; the hierarchy skips by itself.
    settings.walk = Walk::kEveryPixel;
    FragmentTracer tracer = fragments_of(scene, settings);
    const double build = build_ms(device, tracer);
    const auto bounds_ms = [&](FragmentTracer& built) {
      device.pass_times();
      device.build(built);
      for (const gl::PassTime& pass : device.pass_times())
        if (pass.name == "structure_bounds") return pass.ms;
      return 0.0;
    };
    const double exact = bounds_ms(tracer);
    settings.bounds = Bounds::kBoxes;
    FragmentTracer boxes = fragments_of(scene, settings);
    device.build(boxes);
    const double by_boxes = bounds_ms(boxes);
    settings.bounds = Bounds::kExact;
    settings.skipping = false;
    FragmentTracer through_all = fragments_of(scene, settings);
    device.build(through_all);
    const Work work = work_of(device, tracer, rays), all = work_of(device, through_all, rays);
    table.add({scene.name, double(scene.triangles.size()), double(tracer.fragments()),
               double(whole.fragments()) / std::max(1u, whole.used_lists()), double(whole.longest_list()),
               kMega * total_bytes(tracer.bytes_of_parts()), build, exact, by_boxes, work.cells, work.tests,
               all.tests > 0 ? 1 - work.tests / all.tests : 0.0, trace_ms(device, tracer, rays),
               trace_ms(device, through_all, rays)});
  }
  emit(table);
}

void table_6_2(TracingDevice& device, const BenchOptions& options, const Emit& emit) {
  for (const std::string& name : options.scenes) {
    const RayScene scene = load_scene(name);
    device.assign(scene.triangles);
    Table table{fmt::format("Table 6.2, {}: bytes with 8 buckets and decoupled data of {} bytes", scene.name,
                            fragment_tracer::kDataBytes),
                {"storage", "a pixel", "thesis", "a fragment", "of the thesis", "MB of lists", "MB with data"},
                {}};
    // m_p and m_f of the thesis for eight buckets; its LLB adds the data to m_f, and it alone.
    struct Row {
      Storage storage;
      double pixel, fragment;
    };
    for (const auto& [storage, pixel, fragment] :
         {Row{Storage::kArray, 8, 8}, Row{Storage::kList, 4, 8}, Row{Storage::kDoubleList, 8, 12},
          Row{Storage::kBucketList, 40, 8.0 + fragment_tracer::kDataBytes}, Row{Storage::kDoubleBucketList, 72, 12}}) {
      Settings settings;
      settings.side = kSide;
      settings.storage = storage;
      FragmentTracer tracer = fragments_of(scene, settings);
      device.build(tracer);
      const auto parts = tracer.bytes_of_parts();
      table.add({std::string(fragment_tracer::kStorageNames[size_t(storage)]), double(pixel_bytes(settings)), pixel,
                 double(fragment_bytes(settings)), fragment, kMega * double(parts.pixels + parts.fragments),
                 kMega * total_bytes(parts)});
    }
    emit(table);
  }
}

void figure_6_11(TracingDevice& device, const BenchOptions& options, const Emit& emit) {
  for (const std::string& name : options.scenes) {
    const RayScene scene = load_scene(name);
    device.assign(scene.triangles);
    const std::vector<TracedRay> rays = diffuse_rays(scene, options.rays);
    Table table{fmt::format("Figure 6.11, {}: {} triangles, {} diffuse rays", scene.name, scene.triangles.size(), rays.size()),
                {"tracer", "build ms", "trace ms", "frame ms"},
                {}};
    const auto add = [&](const std::string& what, double build, double trace) {
      table.add({what, build, trace, build + trace});
    };
    Settings settings;
    settings.side = kSide;
    FragmentTracer fragments = fragments_of(scene, settings);
    const double build = build_ms(device, fragments);
    add("fragments", build, trace_ms(device, fragments, rays));
    for (const char* tracer_name : {"orthographic", kYardstick}) {
      const auto tracer = tracer_named(tracer_name).make(device.device());
      const double built = build_ms(device, *tracer);
      add(tracer_name, built, trace_ms(device, *tracer, rays));
    }
    for (const auto& [what, quality] : {std::pair{"Embree low", RTC_BUILD_QUALITY_LOW}, {"Embree high", RTC_BUILD_QUALITY_HIGH}}) {
      const double built =
          fair(median_time(kBuilds, [&] { EmbreeScene(scene.triangles, false, quality); }), device.device());
      const EmbreeScene embree(scene.triangles, false, quality);
      add(what, built, fair(least_time([&] { embree.trace(rays, false); }), device.device()));
    }
    emit(table);
  }
}

void figure_6_12(TracingDevice& device, const BenchOptions& options, const Emit& emit) {
  for (const std::string& name : options.scenes) {
    const RayScene scene = load_scene(name);
    device.assign(scene.triangles);
    const std::vector<TracedRay> rays = diffuse_rays(scene, options.rays);
    Settings settings;
    settings.views = Views::kCamera;
    settings.side = 2 * kSide;
    settings.walk = Walk::kEveryPixel;
    settings.by_plane = false;  // the thesis' test
    settings.storage = Storage::kDoubleList;
    FragmentTracer whole = fragments_of(scene, settings);
    device.build(whole);
    Table table{fmt::format("Figure 6.12, {}: the camera's view, {} fragments, {:.1f} layers on average, {} at most, {} "
                            "diffuse rays, ms",
                            scene.name, whole.fragments(), double(whole.fragments()) / std::max(1u, whole.used_lists()),
                            whole.longest_list(), rays.size()),
                {"storage", "together", "decoupled", "and skipping", "gain by decoupling", "by skipping"},
                {}};
    const auto add = [&](const std::string& what, Storage storage, bool binary) {
      settings.storage = storage;
      settings.binary_search = binary;
      std::array<double, 3> ms{};
      for (int i = 0; i < 3; ++i) {
        settings.decoupled = i > 0;
        settings.skipping = i > 1;
        FragmentTracer tracer = fragments_of(scene, settings);
        device.build(tracer);
        ms[size_t(i)] = trace_ms(device, tracer, rays);
      }
      table.add({what, ms[0], ms[1], ms[2], ms[0] / ms[1], ms[1] / ms[2]});
    };
    add("SB, linear", Storage::kArray, false);
    add("SB, binary", Storage::kArray, true);
    add("LL", Storage::kList, false);
    add("DLL", Storage::kDoubleList, false);
    add("LLB", Storage::kBucketList, false);
    add("DLLB", Storage::kDoubleBucketList, false);
    emit(table);
  }
}

namespace {

primitive_tracer::CubeTracer dirt(const RayScene& scene, int tiles, int buckets) {
  primitive_tracer::CubeSettings settings;
  settings.linked_lists = true;
  settings.tiles = tiles;
  settings.buckets = buckets;
  settings.centre = eye_of(scene, tiles).position;
  return primitive_tracer::CubeTracer(settings);
}

}  // namespace

void table_7_2(TracingDevice& device, const BenchOptions& options, const Emit& emit) {
  Table table{fmt::format("Table 7.2: fragments (DLLB) / primitives (cube, linked lists), 6 x {0} x {0} pixels or tiles, 8 "
                          "buckets, {1} diffuse rays",
                          kSide, options.rays),
              {"scene", "fragments", "entries", "MB", "MB", "build ms", "build ms", "trace ms", "trace ms", "rays lost"},
              {}};
  for (const std::string& name : options.scenes) {
    const RayScene scene = load_scene(name);
    device.assign(scene.triangles);
    const std::vector<TracedRay> rays = diffuse_rays(scene, options.rays);
    Settings settings;
    settings.views = Views::kCube;
    settings.side = kSide;
    FragmentTracer fragments = fragments_of(scene, settings);
    primitive_tracer::CubeTracer primitives = dirt(scene, kSide, settings.buckets);
    const double build = build_ms(device, fragments), due_build = build_ms(device, primitives);
    const auto parts = primitives.bytes_of_parts();
    const Speed ours = trace_speed(device, fragments, rays, false), due = trace_speed(device, primitives, rays, false);
    double lost = 0;
    for (size_t i = 0; i < rays.size(); ++i)
      lost += due.hits[i].primitive != shared::NO_PRIMITIVE && ours.hits[i].primitive == shared::NO_PRIMITIVE;
    table.add({scene.name, double(fragments.fragments()), double(primitives.counts().ids), kMega * double(fragments.bytes()),
               kMega * double(parts.depth_bounds + parts.buckets + parts.ids), build, due_build,
               fair(ours.time, device.device()), fair(due.time, device.device()),
               rays.empty() ? 0.0 : lost / double(rays.size())});
  }
  emit(table);
}

void figure_7_11(TracingDevice& device, const BenchOptions& options, const Emit& emit) {
  // Bytes of a ray's hit and shading data, which primitives are without (Table 7.3).
  constexpr double kHit = double(sizeof(TracedHit));
  for (const std::string& name : options.scenes) {
    const RayScene scene = load_scene(name);
    device.assign(scene.triangles);
    Table table{fmt::format("Figure 7.11, {}: MB by resolution, one bucket", scene.name),
                {"side", "fragments", "MB", "entries", "MB of primitives", "and of a hit for each pixel"},
                {}};
    for (int side = 64; side <= 4 * kSide; side *= 2) {
      Settings settings;
      settings.views = Views::kCube;
      settings.side = side;
      settings.buckets = 1;
      FragmentTracer fragments = fragments_of(scene, settings);
      primitive_tracer::CubeTracer primitives = dirt(scene, side, 1);
      device.build(fragments);
      device.build(primitives);
      const auto parts = primitives.bytes_of_parts();
      const double mb = kMega * double(parts.depth_bounds + parts.buckets + parts.ids);
      table.add({double(side), double(fragments.fragments()), kMega * double(fragments.bytes()),
                 double(primitives.counts().ids), mb, mb + kMega * kHit * side * side});
    }
    emit(table);
  }
}

namespace {

// What fragments make of the rays of a row, as shares of them.
struct Loss {
  double lost = 0, made_up = 0, another = 0, near = 0;
};
Loss loss_of(const std::vector<TracedHit>& hits, const std::vector<TracedHit>& due) {
  Loss loss;
  const double share = 1.0 / std::max<double>(1, double(due.size()));
  for (size_t i = 0; i < due.size(); ++i) {
    const bool meets = hits[i].primitive != shared::NO_PRIMITIVE, should = due[i].primitive != shared::NO_PRIMITIVE;
    if (should && !meets) loss.lost += share;
    if (meets && !should) loss.made_up += share;
    if (meets && should && hits[i].primitive != due[i].primitive) loss.another += share;
    if (meets == should && std::abs(hits[i].t - due[i].t) <= 0.01f * due[i].t) loss.near += share;
  }
  return loss;
}

// Near the middle, not in it, where modelled scenes have surfaces.
glm::vec3 eye_for(const Triangles& triangles) {
  const scene::Bounds bounds = bounds_of(triangles);
  if (bounds.empty()) return glm::vec3(0);
  return glm::vec3(bounds.low) + glm::vec3(bounds.high - bounds.low) * glm::vec3(0.513f, 0.483f, 0.507f);
}

}  // namespace

void hard_cases_report(TracingDevice& device, const BenchOptions&, const Emit& emit) {
  constexpr int kSmall = 64;  // crowded rows have thousands of fragments a pixel
  Table table{fmt::format("The catalogue of hard cases by fragments: a cube of {} pixels a side about the middle, shares of "
                          "rays; or what could not be held",
                          kSmall),
              {"case", "rays", "lost", "made up", "another surface", "within 1 %", "by depth: lost", "made up",
               "another surface", "within 1 %"},
              {}};
  for (const HardCaseMaker& maker : hard_cases()) {
    const HardCase row = maker.make();
    device.assign(row.triangles);
    BruteForceTracer all;
    device.build(all);
    const std::vector<TracedHit> due = device.trace(all, row.rays).hits;
    std::vector<Cell> cells{std::string(maker.name), double(row.rays.size())};
    for (bool by_plane : {true, false}) {
      Settings settings;
      settings.views = Views::kCube;
      settings.side = kSmall;
      settings.by_plane = by_plane;
      FragmentTracer tracer(settings, eye_for(row.triangles), {});
      try {
        device.build(tracer);
        const Loss loss = loss_of(device.trace(tracer, row.rays).hits, due);
        cells.insert(cells.end(), {loss.lost, loss.made_up, loss.another, loss.near});
      } catch (const Error&) {
        cells.insert(cells.end(), {std::string("refused"), {}, {}, {}});
      }
    }
    table.add(std::move(cells));
  }
  emit(table);
}

}  // namespace panoptes::test
