#include "engine/request.h"

#include "base/error.h"
#include "film/display.h"

#include <fmt/ranges.h>

#include <cmath>

namespace panoptes::engine {

namespace {

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (static_cast<unsigned char>(c) < 0x20)
      result += fmt::format("\\u{:04x}", int(c));
    else
      result += c;
  }
  return result + '"';
}

// JSON has no word for what is not finite.
std::string number(double value, const char* format = "{:.3f}") {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "null";
}

template <class List, class Write>
std::string array(const List& list, Write write) {
  std::string result = "[";
  for (const auto& item : list) result += (result.size() > 1 ? ", " : "") + write(item);
  return result + "]";
}

}  // namespace

void TakeOver::check(const gpu_scene::Camera& camera) const {
  const size_t size = size_t(camera.width) * size_t(camera.height) * 4;
  for (const auto* picture : {&smooth, &before})
    if (!picture->empty() && picture->size() != size)
      fail("a picture that paths take over has another size than the one that is asked for: please report it");
  if (before.empty() != (before_samples == 0)) fail("samples that were made before are missing: please report it");
}

void RenderRequest::check() const {
  if (last_sample <= first_sample)
    fail("samples {} to {} are an empty range: ask for at least one sample", first_sample,
         last_sample);
  if (shadow_resolution < 16 || shadow_resolution > 8192)
    fail("a shadow resolution of {} is out of range: choose 16 to 8192", shadow_resolution);
  if (!(filter_width >= 0 && filter_width <= 10))
    fail("a pixel filter of {} pixels is out of range: choose 0 to 10", filter_width);
  if (!std::isfinite(exposure)) fail("the film's exposure is not finite: set it to 1");
  if (!(time_budget >= 0) || !(noise_threshold >= 0))
    fail("time budget and noise threshold must not be negative: set them to 0 to switch them off");
  if (pieces && noise_threshold > 0)
    fail("pictures with a noise threshold cannot be merged, since their pixels have different samples: "
         "set the noise threshold to 0");
  if (shown_pass != film::Pass::kCombined) {
    if (!film::can_show(shown_pass)) fail("there is no picture of the pass that is to be shown: choose another");
    if (!passes[size_t(shown_pass)])
      fail("pass '{}' is to be shown, but not rendered: please report it", film::info(shown_pass).name);
    if (debug_picture != ray_picture::Kind::kNone || occlusion.picture != ambient_occlusion::Picture::kNone ||
        cache.picture != radiance_cache::Picture::kNone)
      fail("a debug picture takes the place of all passes: show Combined with it");
  }
  if (!ray_picture::known(debug_picture))
    fail("there is no debug picture number {}: choose one of {}", int(debug_picture),
         fmt::join(ray_picture::kKindNames, ", "));
  denoise.check();
  if (pieces && denoise.denoiser != denoise::Denoiser::kOff)
    fail("pictures that are to be merged cannot be denoised, since the rest of their samples is not known: switch the "
         "denoiser off");
  structure.check();
  paths.check();
  occlusion.check();
  cache.check();
  specular_rays.check();
}

std::string RenderStats::to_json() const {
  const auto effect = [](const EffectReport& e) {
    return fmt::format("{{\"name\": {}, \"runs\": {}, \"reason\": {}, \"ms\": {}}}",
                       quoted(e.name), e.runs, quoted(e.reason), number(e.ms));
  };
  const auto pass = [](const std::pair<std::string, double>& p) {
    return fmt::format("{{\"name\": {}, \"ms\": {}}}", quoted(p.first), number(p.second));
  };
  return fmt::format(
      "{{\"device\": {}, \"size\": [{}, {}], \"samples\": {}, \"effects\": {}, \"passes\": {}, "
      "\"build_ms\": {}, \"trace_ms\": {}, \"total_ms\": {}, \"rays\": {}, "
      "\"cache\": {{\"cells\": {}, \"fewer\": {}, \"lattice\": {}}}, "
      "\"memory_bytes\": {}, \"estimated_error\": {}, \"warnings\": {}}}",
      quoted(device), width, height, samples, array(effects, effect), array(passes, pass),
      number(build_ms), number(trace_ms), number(total_ms), rays, cache.cells, cache.fewer, cache.lattice, memory_bytes,
      estimated_error ? number(*estimated_error, "{:.6g}") : "null", array(warnings, quoted));
}

}  // namespace panoptes::engine
