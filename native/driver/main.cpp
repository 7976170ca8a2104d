// Renders a scene snapshot without Blender: benchmarks, and checks on machines that have a GPU but
// no Blender. Writes a PFM picture (linear, Combined or another pass) and the statistics.
#include "base/error.h"
#include "driver/cache_options.h"
#include "driver/occlusion_options.h"
#include "driver/options.h"
#include "engine/engine.h"
#include "engine/snapshot.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <optional>
#include <vector>

namespace {

using panoptes::fail;

constexpr const char* kUsage =
    "usage: panoptes_driver SCENE.scene [-o OUT.pfm] [--size WxH] [--samples N] [--stats OUT.json]\n"
    "                       [--repeat N] [--software] [--debug steps|tests|lists|tiles]\n"
    "                       [--method realtime|fragment|primitive] [--bounces N] [--shadow-maps]\n"
    "                       [--raster-primary] [--pass NAME] [--occlusion KEY=VALUE]...\n"
    "                       [--cache KEY=VALUE]... [--specular-rays auto|off|on]\n"
    "                       [--denoise off|auto|edge_avoiding|oidn]\n"
    "                       [--structure auto|orthographic|cube|lists|bvh|view|fragments] [--tiles N] [--buckets N]\n";

struct Arguments {
  std::string scene, output, stats;
  int width = 0, height = 0, samples = 0, repeat = 1;
  bool software = false;
  std::optional<panoptes::ray_picture::Kind> debug;
  std::optional<panoptes::engine::Method> method;
  int bounces = -1;
  bool shadow_maps = false, raster_primary = false;
  panoptes::film::Pass pass = panoptes::film::Pass::kCombined;
  std::vector<std::string> occlusion, cache;
  std::optional<panoptes::specular_rays::Mode> specular_rays;
  std::optional<panoptes::denoise::Denoiser> denoiser;
  panoptes::engine::StructureSettings structure;
};

int whole(const std::string& option, const std::string& text, int least = 1) {
  size_t used = 0;
  int value = 0;
  try {
    value = std::stoi(text, &used);
  } catch (const std::exception&) {
  }
  if (used != text.size() || value < least)
    fail("{} takes a whole number from {}, not '{}': see --help", option, least, text);
  return value;
}

Arguments parse(const std::vector<std::string>& words) {
  Arguments a;
  for (size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    const auto value = [&]() -> const std::string& {
      if (i + 1 >= words.size()) fail("{} needs a value: see --help", word);
      return words[++i];
    };
    if (word == "-o") a.output = value();
    else if (word == "--stats") a.stats = value();
    else if (word == "--samples") a.samples = whole(word, value());
    else if (word == "--repeat") a.repeat = whole(word, value());
    else if (word == "--shadow-maps") a.shadow_maps = true;
    else if (word == "--raster-primary") a.raster_primary = true;
    else if (word == "--pass") {
      a.pass = panoptes::film::find_pass(value());
      if (a.pass == panoptes::film::Pass::kCount || panoptes::film::info(a.pass).channels < 3)
        fail("'{}' is no pass of three channels: see the README for those that there are", words[i]);
    } else if (word == "--occlusion") a.occlusion.push_back(value());
    else if (word == "--cache") a.cache.push_back(value());
    else if (word == "--specular-rays")
      a.specular_rays = panoptes::driver::named<panoptes::specular_rays::Mode>(
          panoptes::specular_rays::kModeNames, value());
    else if (word == "--denoise")
      a.denoiser = panoptes::driver::named<panoptes::denoise::Denoiser>(panoptes::denoise::kDenoiserNames, value());
    else if (word == "--bounces") a.bounces = whole(word, value(), 0);
    else if (word == "--method") {
      const std::string& name = value();
      a.method = panoptes::driver::named<panoptes::engine::Method>(panoptes::engine::kMethodNames, name);
    } else if (word == "--software") a.software = true;
    else if (word == "--debug") {
      a.debug = panoptes::ray_picture::find_kind(value());
      if (!panoptes::ray_picture::known(*a.debug))
        fail("--debug takes one of {}, not '{}': see --help",
             fmt::join(panoptes::ray_picture::kKindNames, ", "), words[i]);
    } else if (word == "--structure") {
      a.structure.structure = panoptes::engine::find_structure(value());
      if (int(a.structure.structure) < 0)
        fail("--structure takes one of {}, not '{}': see --help",
             fmt::join(panoptes::engine::kStructureNames, ", "), words[i]);
    } else if (word == "--tiles") a.structure.tiles = whole(word, value());
    else if (word == "--buckets") a.structure.buckets = whole(word, value());
    else if (word == "--size") {
      const std::string& size = value();
      const size_t x = size.find('x');
      if (x == std::string::npos) fail("--size takes WxH, not '{}': see --help", size);
      a.width = whole(word, size.substr(0, x));
      a.height = whole(word, size.substr(x + 1));
    } else if (!word.empty() && word[0] == '-') fail("unknown option '{}': see --help", word);
    else if (a.scene.empty()) a.scene = word;
    else fail("more than one scene was given: name one snapshot");
  }
  if (a.scene.empty()) fail("no scene was given: name a snapshot, see --help");
  return a;
}

void write_pfm(const std::string& path, int width, int height, const std::vector<float>& pixels) {
  std::ofstream file(path, std::ios::binary);
  file << "PF\n" << width << ' ' << height << "\n-1.0\n";
  const size_t channels = pixels.size() / (size_t(width) * size_t(height));
  for (size_t i = 0; i < pixels.size(); i += channels)
    file.write(reinterpret_cast<const char*>(&pixels[i]), 12);
  file.close();
  if (!file) fail("picture '{}' cannot be written: check the folder and the free space", path);
}

void run(const Arguments& arguments) {
  panoptes::engine::Engine engine({.prefer_software = arguments.software});
  panoptes::engine::RenderRequest request = engine.edit([&](panoptes::scene::Scene& scene) {
    return panoptes::engine::read_snapshot(arguments.scene, scene);
  });
  if (arguments.samples) {
    request.first_sample = 0;
    request.last_sample = uint32_t(arguments.samples);
  }
  if (arguments.width) {
    // The snapshot's camera keeps its height of view.
    request.camera.projection[0][0] *= double(request.camera.width) / request.camera.height *
                                       arguments.height / arguments.width;
    request.camera.width = arguments.width;
    request.camera.height = arguments.height;
  }
  request.passes.set(size_t(panoptes::film::Pass::kCombined));
  request.passes.set(size_t(arguments.pass));
  for (const std::string& option : arguments.occlusion)
    panoptes::driver::set_occlusion(request.occlusion, option);
  for (const std::string& option : arguments.cache)
    panoptes::driver::set_cache(request.cache, option);
  request.specular_rays.mode = arguments.specular_rays.value_or(request.specular_rays.mode);
  // One distance for both methods, as Blender's users have it.
  if (!arguments.occlusion.empty()) request.paths.ao_distance = request.occlusion.distance;
  request.denoise.denoiser = arguments.denoiser.value_or(request.denoise.denoiser);
  request.method = arguments.method.value_or(request.method);
  request.paths.shadow_maps |= arguments.shadow_maps;
  request.paths.raster_primary |= arguments.raster_primary;
  if (arguments.bounces >= 0) {
    request.paths.bounces.total = arguments.bounces;
    request.cache.bounces = std::min(arguments.bounces, panoptes::radiance_cache::kMostBounces);
  }
  request.debug_picture = arguments.debug.value_or(request.debug_picture);
  if (arguments.structure != panoptes::engine::StructureSettings{})
    request.structure = arguments.structure;
  for (int i = 0; i < arguments.repeat; ++i) {
    const auto job = engine.render(request);
    while (!job->wait(0.1)) {
    }
    job->check();
    const panoptes::engine::RenderStats stats = job->stats();
    fmt::print(stderr, "{}: {} samples, build {:.1f} ms, trace {:.1f} ms\n", stats.device,
               stats.samples, stats.build_ms, stats.trace_ms);
    if (i + 1 < arguments.repeat) continue;
    if (!arguments.stats.empty()) {
      std::ofstream file(arguments.stats);
      file << stats.to_json() << '\n';
      if (!file) fail("statistics '{}' cannot be written: check the folder", arguments.stats);
    }
    if (!arguments.output.empty())
      write_pfm(arguments.output, stats.width, stats.height,
                job->read(arguments.pass));
  }
}

}  // namespace

int main(int count, char** words) {
  const std::vector<std::string> list(words + 1, words + count);
  for (const std::string& word : list)
    if (word == "-h" || word == "--help") {
      std::cout << kUsage;
      return 0;
    }
  try {
    run(parse(list));
  } catch (const std::exception& error) {
    std::cerr << "panoptes_driver: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
